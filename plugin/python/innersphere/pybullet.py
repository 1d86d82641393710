"""Packings as shapes of bodies in a running PyBullet.

    import pybullet as p
    import innersphere.pybullet

    p.connect(p.GUI)
    sim = innersphere.pybullet.attach()
    ring = sim.create_body(innersphere.read("ring.cbor"), mass=0.2, position=[0, 0, 1])
    p.stepSimulation()

Needs PyBullet (pip install pybullet) and an innersphere that was built where Bullet is (libbullet-dev). Everything else
of PyBullet is used as before: only the contacts of bodies with a packing are innersphere's.
"""

from __future__ import annotations

import hashlib
import importlib.metadata
import inspect
import math
import os
import warnings
from collections.abc import Sequence
from typing import Any, Literal

import numpy as np
import pybullet as p
from numpy.typing import NDArray

from . import _core
from ._errors import Error
from ._pack import pack

__all__ = ["PyBulletError", "Simulation", "attach", "contact_dtype"]

contact_dtype = np.dtype(
    [(name, np.int32) for name in ("body_a", "link_a", "body_b", "link_b")]
    + [("volume", np.float64), ("depth", np.float64)]
    + [(name, np.float64, 3) for name in ("centroid", "area", "force", "torque")]
)
"""The type of what Simulation.overlaps() returns."""

# Vertices and indices of surfaces that were drawn. createVisualShape() never lets go of its lists: for the same surface it
# gets the same ones, so that a program that makes bodies over and over does not grow.
_lists: dict[bytes, tuple[list[list[float]], list[int]]] = {}

_AT_ORIGIN = ((0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0))


class PyBulletError(Error, RuntimeError):
    """PyBullet is not what innersphere understands, its client is closed, or something asked for is not there."""

    code = "pybullet"


def _versions() -> str:
    try:
        version = importlib.metadata.version("pybullet")
    except importlib.metadata.PackageNotFoundError:
        version = "of an unknown version"
    return f"PyBullet {version} (API {p.getAPIVersion()}), innersphere {_core.__version__}"


def _pose(position: Any, orientation: Any, what: str) -> tuple[tuple[float, ...], tuple[float, ...]]:
    """Makes a pose of two sequences of numbers. Raises TypeError and ValueError, which say what is wrong."""
    parts = []
    for name, values, count in (("position", position, 3), ("orientation", orientation, 4)):
        array = np.asarray(values, dtype=np.float64)
        if array.shape != (count,):
            raise ValueError(f"{name} of {what} has the shape {array.shape}; it must be ({count},)")
        if not np.isfinite(array).all():
            raise ValueError(f"{name} of {what} is {array.tolist()}; it must be finite")
        parts.append(array)
    length = float(np.linalg.norm(parts[1]))
    if abs(length - 1) > 1e-3:
        raise ValueError(
            f"orientation of {what} has the length {length:g}; it must be a quaternion x y z w of length 1"
        )
    return tuple(parts[0].tolist()), tuple((parts[1] / length).tolist())


def attach(
    client: int = 0,
    *,
    response: Literal["compliant", "rigid", "penalty"] = "compliant",
    backend: Literal["auto", "cpu", "cuda"] = "auto",
    accuracy: float = 0.0,
    stiffness: float = 0.0,
    damping: float = 1.0,
    two_friction_directions: bool = True,
    solver: Literal["bullet", "substep"] = "bullet",
) -> Simulation:
    """Makes packings collide in a client of PyBullet, and returns what gives bodies packings there.

    client: what p.connect() returned, of p.DIRECT or p.GUI. Servers in other processes cannot be attached to.
    response: "compliant" (contacts are stiff, damped springs), "rigid" (Bullet's own contacts) or "penalty" (forces are
        explicit; links of multibodies get compliant contacts).
    backend: where overlaps are computed: "auto", "cpu" or "cuda".
    accuracy: largest gap to the surfaces that a pair may leave, by using fewer spheres [m]; 0 uses all.
    stiffness: pressure that a metre of overlap causes [N/m^3]; 0 is as stiff as the time step resolves.
    damping: fraction of critical damping; 0 is bouncy.
    two_friction_directions: sets SOLVER_USE_2_FRICTION_DIRECTIONS for the whole world. Without it grippers drop what
        they hold. Unlike PyBullet's, this is the default.
    solver: "bullet" is PyBullet's own; "substep" divides steps for bodies in maximal coordinates (btRigidBody) and the
        constraints between them, with or without packings: they stand, hang and bear loads at 60 steps/s
        (SubstepSolver of the C++ library). Bodies that touch or are joined to a movable body in reduced coordinates
        (btMultiBody, what loadURDF() makes by default), also by way of others, have PyBullet's solver in that step.
        It sets minimumSolverIslandSize to -1, which has to stay so.

    The options hold after resetSimulation(), too, from the next call of what attach() returned on. Attaching again
    replaces them; detach() of either object then ends both.

    Raises PyBulletError, which names the versions, where this PyBullet is not understood: its API version, classes
    or values differ from what is known; and for solver="substep" in a world of deformable bodies. TypeError and
    InvalidArgumentError for options out of range; NoDeviceError.
    """
    if not hasattr(_core, "pybullet"):
        raise PyBulletError("this innersphere was built without Bullet; install libbullet-dev and build it again")
    if p.getAPIVersion() != _core.pybullet.api_version:
        raise PyBulletError(f"the API version must be {_core.pybullet.api_version}: {_versions()}")
    _check_connected(client)
    plugin = p.loadPlugin(_core.__file__, "_innersphere", physicsClientId=client)
    if plugin < 0:
        raise PyBulletError(f"PyBullet did not load innersphere's plug-in: {_versions()}")
    sim = Simulation(client, plugin, maximal_coordinates=solver == "substep")
    sim._check()
    sim._run(
        _core.pybullet.set_options, response, backend, accuracy, stiffness, damping, two_friction_directions, solver
    )
    return sim


def _check_connected(client: int) -> None:
    if not isinstance(client, int) or isinstance(client, bool):
        raise TypeError(f"client is {client!r}; it must be what p.connect() returned")
    if not p.isConnected(client):
        raise PyBulletError(f"client {client} of PyBullet is not connected")


class Simulation:
    """A client of PyBullet in which packings collide. Made by attach()."""

    client: int
    """The number of the client in PyBullet."""

    def __init__(self, client: int, plugin: int, maximal_coordinates: bool) -> None:
        self.client = client
        self._plugin: int | None = plugin
        self._maximal_coordinates = maximal_coordinates
        self._visuals: dict[bytes, int] = {}  # of surfaces
        self._visuals_of = 0  # the number of the world that they are in

    def _run(self, prepare: Any, *arguments: Any) -> Any:
        """Has PyBullet's server do a job in its own thread, and returns what came of it."""
        _check_connected(self.client)
        if self._plugin is None:
            raise PyBulletError(f"innersphere is detached from client {self.client}")
        job = prepare(*arguments)
        try:
            found = self._result(job)
        except RuntimeError as error:  # by Plugin::world()
            if isinstance(error, Error):
                raise
            raise PyBulletError(f"this PyBullet is not understood: {error}. {_versions()}") from None
        except ValueError as error:
            if isinstance(error, Error):
                raise
            raise PyBulletError(f"{error}, in client {self.client}") from None
        if found is None:
            raise PyBulletError(
                f"client {self.client} did not run innersphere's command: its server is in another process, was "
                f"connected anew, or has unloaded the plug-in"
            )
        return found

    def _result(self, job: Any) -> Any:
        """Returns what came of a job, or None if the server did not run it."""
        p.executePluginCommand(self._plugin, "", [job.number, os.getpid()], [], physicsClientId=self.client)
        return job.result()

    def _check(self) -> None:
        """Compares what the world holds with what PyBullet says. Raises PyBulletError where they differ."""
        seen = self._run(_core.pybullet.look)
        said = p.getPhysicsEngineParameters(physicsClientId=self.client)
        gravity = [said["gravityAcceleration" + axis] for axis in "XYZ"]
        if seen.iterations != said["numSolverIterations"] or not np.array_equal(seen.gravity, gravity):
            raise PyBulletError(f"iterations and gravity are not where they were expected: {_versions()}")
        for body, pose in seen.bases:
            self._compare(body, pose)

    def _compare(self, body: int, pose: Any) -> None:
        position, orientation = p.getBasePositionAndOrientation(body, physicsClientId=self.client)
        same = np.allclose(pose[0], position, rtol=1e-9, atol=1e-9)
        turn = abs(float(np.dot(pose[1], orientation)))
        if not same or abs(turn - 1) > 1e-6:
            raise PyBulletError(
                f"body {body} is at {pose[0]} in the world, but PyBullet says {position}: {_versions()}"
            )

    def _check_link(self, body: int, link: int) -> None:
        for name, value in (("body", body), ("link", link)):
            if not isinstance(value, (int, np.integer)) or isinstance(value, bool):
                raise TypeError(f"{name} is {value!r}; it must be an integer")
        _check_connected(self.client)
        try:
            p.getBodyInfo(body, physicsClientId=self.client)
        except (p.error, OverflowError):
            bodies = [
                p.getBodyUniqueId(i, physicsClientId=self.client)
                for i in range(p.getNumBodies(physicsClientId=self.client))
            ]
            raise PyBulletError(f"there is no body {body} in client {self.client}; there are {bodies}") from None
        links = p.getNumJoints(body, physicsClientId=self.client)
        if not -1 <= link < links:
            raise PyBulletError(f"body {body} has no link {link}; its links are -1 (the base) to {links - 1}")

    def create_body(
        self,
        packing: _core.Packing,
        mass: float = 0.0,
        position: Sequence[float] = _AT_ORIGIN[0],
        orientation: Sequence[float] = _AT_ORIGIN[1],
        *,
        maximal_coordinates: bool | None = None,
        visual: int | None = None,
    ) -> int:
        """Makes a body with a packing, and returns its number in PyBullet.

        packing: its shape, and by its mass properties the inertia. packing[:n] collides with n spheres only.
        mass: [kg]; 0 is a body that never moves.
        position, orientation: where the packing's mesh is in the world [m]: its origin, and a quaternion x y z w.
            PyBullet tells the place of the centre of mass; mesh_pose() that of the mesh.
        maximal_coordinates: makes a btRigidBody, where PyBullet makes a btMultiBody without. None: as the solver wants
            it, which is True for "substep".
        visual: a visual shape of PyBullet's, in the frame of the mesh; None draws the packing's surface.

        Raises TypeError, ValueError and PyBulletError.
        """
        if not isinstance(packing, _core.Packing):
            raise TypeError(f"packing is a {type(packing).__name__}; it must be an innersphere.Packing")
        if not (math.isfinite(mass) and mass >= 0):
            raise ValueError(f"mass is {mass}; it must be 0 or more")
        position, orientation = _pose(position, orientation, "the body")
        _check_connected(self.client)
        if maximal_coordinates is None:
            maximal_coordinates = self._maximal_coordinates
        frame, moments = _core.pybullet.principal_frame(packing)
        if visual is None:
            visual = self._surface(packing)
        # PyBullet wants a shape of its own at first.
        shape = p.createCollisionShape(p.GEOM_SPHERE, radius=1e-3, physicsClientId=self.client)
        body = p.createMultiBody(
            mass,
            shape,
            visual,
            position,
            orientation,
            frame[0],
            frame[1],
            useMaximalCoordinates=maximal_coordinates,
            physicsClientId=self.client,
        )
        try:
            if mass > 0:
                inertia = [mass * moment for moment in moments]
                p.changeDynamics(body, -1, mass=mass, localInertiaDiagonal=inertia, physicsClientId=self.client)
            # After the inertia, because it is this that turns the inertia of a btRigidBody into the world.
            at = p.multiplyTransforms(position, orientation, frame[0], frame[1])
            p.resetBasePositionAndOrientation(body, at[0], at[1], physicsClientId=self.client)
            inverse = p.invertTransform(frame[0], frame[1])
            self._run(_core.pybullet.set_shape, body, -1, packing, inverse)
        except BaseException:
            p.removeBody(body, physicsClientId=self.client)
            raise
        return int(body)

    def _surface(self, packing: _core.Packing) -> int:
        """A visual shape of the packing's surface; -1, which draws nothing, if there is none or it is too large."""
        most_vertices = 100_000  # that PyBullet takes at once
        if len(packing.faces) == 0 or len(packing.vertices) > most_vertices or packing.faces.size > most_vertices:
            return -1
        vertices = packing.vertices + packing.origin
        surface = hashlib.blake2b(vertices.tobytes() + packing.faces.tobytes(), digest_size=16).digest()
        # A reset takes all shapes away.
        world = self._run(_core.pybullet.world_number)
        if self._visuals_of != world:
            self._visuals, self._visuals_of = {}, world
        if surface not in self._visuals:
            if surface not in _lists:
                _lists[surface] = vertices.tolist(), packing.faces.ravel().tolist()
            self._visuals[surface] = p.createVisualShape(
                p.GEOM_MESH, vertices=_lists[surface][0], indices=_lists[surface][1], physicsClientId=self.client
            )
        return self._visuals[surface]

    def set_shape(
        self,
        body: int,
        packing: _core.Packing,
        link: int = -1,
        position: Sequence[float] = _AT_ORIGIN[0],
        orientation: Sequence[float] = _AT_ORIGIN[1],
    ) -> None:
        """Gives a link of a body a packing, in place of all that it collided with.

        body, link: as PyBullet numbers them; -1 is the base. Mass, inertia, friction and the rest stay as they are.
        packing: packing[:n] collides with n spheres only.
        position, orientation: where the packing's mesh is in the frame of the link, as <origin> of <collision> says it
            in a URDF [m]: its origin, and a quaternion x y z w.

        Raises PyBulletError if there is no such body or link, it has no collision shape, or it is in reduced coordinates
        and can move, which solver="substep" does not do; TypeError; ValueError.
        """
        if not isinstance(packing, _core.Packing):
            raise TypeError(f"packing is a {type(packing).__name__}; it must be an innersphere.Packing")
        position, orientation = _pose(position, orientation, "the packing")
        self._check_link(body, link)
        if self._is_rigid(body):  # getDynamicsInfo() leaves out where its centre of mass is
            inertial = self._run(_core.pybullet.inertial_frame, body)
        else:
            inertial = p.getDynamicsInfo(body, link, physicsClientId=self.client)[3:5]
        mesh_to_body = p.multiplyTransforms(*p.invertTransform(*inertial), position, orientation)
        self._run(_core.pybullet.set_shape, body, link, packing, mesh_to_body)

    def _is_rigid(self, body: int) -> bool:
        """Whether a body is in maximal coordinates."""
        return bool(p.getDynamicsInfo(body, -1, physicsClientId=self.client)[10] == 1)  # btMultiBody: 2

    def pack_all(self, body: int, **options: Any) -> dict[int, _core.Packing]:
        """Gives every link of a body that collides with one mesh a packing of it, mirrored and stretched as the link has it.

        options: those of innersphere.pack(): spheres, cache, repair, progress. With cache, each mesh is packed only
            once for each of its scales.

        Returns the packings by link; links of other shapes stay as they are. A warning names the links with meshes that
        stay so, and why: they have several shapes, as where fixed joints were merged, have a packing already, or a mesh
        of which PyBullet keeps no file, as of createCollisionShape(); and it says if no link has a mesh at all. Raises
        what pack() and set_shape() raise, and PyBulletError for a body in maximal coordinates, of which PyBullet does
        not tell the shapes. It packs all meshes first: on an error nothing has changed.
        """
        unknown = sorted(set(options) - (set(inspect.signature(pack).parameters) - {"mesh", "scale"}))
        if unknown:
            raise TypeError(f"pack_all() has no option {unknown[0]!r}; options are those of innersphere.pack() but scale")
        self._check_link(body, -1)
        if self._is_rigid(body):
            raise PyBulletError(
                f"body {body} is in maximal coordinates, of which PyBullet tells no shapes: give it a packing by "
                "set_shape(), or load it without useMaximalCoordinates"
            )
        self._run(_core.pybullet.world_number)  # so that it is attached
        found: dict[int, tuple[_core.Packing, Any]] = {}
        left = []
        for link in range(-1, p.getNumJoints(body, physicsClientId=self.client)):
            shape, why = self._mesh_of(body, link)
            if why:
                left.append(f"link {link} ({self._name_of(body, link)}) {why}")
            if shape is None:
                continue
            _, _, _, scale, file, position, orientation = shape[:7]
            self._run(_core.pybullet.check_link, body, link)
            found[link] = pack(file.decode(), scale=scale, **options), (position, orientation)
        for link, (packing, frame) in found.items():
            self._run(_core.pybullet.set_shape, body, link, packing, frame)
        if left:
            warnings.warn(f"pack_all() leaves of body {body} as they are: {'; '.join(left)}", stacklevel=2)
        elif not found:
            warnings.warn(f"pack_all() changes nothing: no link of body {body} collides with a mesh", stacklevel=2)
        return {link: packing for link, (packing, _) in found.items()}

    def _mesh_of(self, body: int, link: int) -> tuple[Any, str]:
        """What a link collides with if that is one mesh of a file; else why it is not, or nothing if there is no mesh."""
        try:
            self._run(_core.pybullet.mesh_pose, body, link)
        except PyBulletError:
            pass
        else:
            return None, "has a packing already"
        shapes = p.getCollisionShapeData(body, link, physicsClientId=self.client)
        meshes = [shape for shape in shapes if shape[2] == p.GEOM_MESH]
        if not meshes:
            return None, ""
        if len(shapes) > 1:
            return None, f"has {len(shapes)} shapes, {len(meshes)} of them meshes: join them in one file"
        if meshes[0][4] == b"unknown_file":
            return None, "has a mesh without the name of its file: give it a packing by set_shape()"
        return meshes[0], ""

    def _name_of(self, body: int, link: int) -> str:
        if link < 0:
            return str(p.getBodyInfo(body, physicsClientId=self.client)[0].decode(errors="replace"))
        return str(p.getJointInfo(body, link, physicsClientId=self.client)[12].decode(errors="replace"))

    def mesh_pose(self, body: int, link: int = -1) -> tuple[tuple[float, ...], tuple[float, ...]]:
        """Returns where the mesh of a link's packing is: position [m] and quaternion x y z w.

        Raises PyBulletError if there is no such body or link, or it has no packing.
        """
        self._check_link(body, link)
        position, orientation = self._run(_core.pybullet.mesh_pose, body, link)
        return tuple(position), tuple(orientation)

    def overlaps(self) -> NDArray[Any]:
        """Returns all pairs with a packing that touch, as they were when the last step looked for them.

        A structured array of contact_dtype, with a row for each pair. Vectors have the axes of the world.

        body_a, link_a, body_b, link_b  as PyBullet numbers them; A has a packing
        volume      that both share, by the spheres [m^3]
        depth       of the deepest contact [m]; if negative, the width of the gap
        centroid    of that volume [m]
        area        of the contact, along the direction from A to B [m^2]
        force       of all contacts on B in the last step [N]
        torque      of that force on B about the centroid [N m]
        """
        rows = self._run(_core.pybullet.overlaps)
        return np.array([row.values for row in rows], dtype=contact_dtype)

    def detach(self) -> None:
        """Gives all bodies of the client the shapes back that they had before, and PyBullet its contacts.

        Bodies of create_body() had balls of 1 mm. Does nothing if that has been done, or the client is closed.
        """
        if self._plugin is not None and p.isConnected(self.client):
            # Not by p.unloadPlugin(): PyBullet crashes when it loads the same plug-in again.
            # A server that does not answer has no bodies of ours.
            self._result(_core.pybullet.release())
        self._plugin = None

    def __enter__(self) -> Simulation:
        return self

    def __exit__(self, *_: object) -> None:
        self.detach()
