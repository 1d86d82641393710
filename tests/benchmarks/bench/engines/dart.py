"""DART, the Dynamic Animation and Robotics Toolkit."""

import pathlib

import numpy as np
from scipy.spatial.transform import Rotation

from ..scene import force_at, path_at
from .base import Engine, in_body_axes


def _shape_of_mesh(dart, file: str):
    """Python has no way to DART's mesh reader but a robot's description."""
    urdf = (f'<robot name="r"><link name="l"><collision><geometry><mesh filename="file://{file}"/></geometry></collision>'
            f"</link></robot>")
    skeleton = dart.utils.DartLoader().parseSkeletonString(urdf, dart.common.Uri())
    return skeleton.getBodyNode(0).getShapeNode(0).getShape()


class _Dart(Engine):
    detector: str

    @classmethod
    def version(cls) -> str:
        import dartpy

        return "DART " + dartpy.__version__

    def __init__(self, scene: dict, dt: float) -> None:
        import dartpy as dart

        self._dart, self._scene, self._dt = dart, scene, dt
        self._world = dart.simulation.World()
        self._world.setTimeStep(dt)
        self._world.setGravity([0, 0, -9.81])
        self._world.getConstraintSolver().setCollisionDetector(getattr(dart.collision, self.detector)())
        self._world.setNumSimulationThreads(1)
        sleeping = self._world.getDeactivationOptions()
        sleeping.mEnabled = False
        self._world.setDeactivationOptions(sleeping)
        self._shapes: dict[str, object] = {}
        if scene["ground"] is not None:
            self._ground(scene["ground"])
        self._nodes = [self._add(body) for body in scene["bodies"]]

    def _ground(self, height: float) -> None:
        """A box: not all of its collision detectors know planes against meshes."""
        dart, skeleton = self._dart, self._dart.dynamics.Skeleton("ground")
        joint, node = skeleton.createWeldJointAndBodyNodePair()
        self._collide(node, dart.dynamics.BoxShape([100, 100, 2]))
        place = np.eye(4)
        place[2, 3] = height - 1
        joint.setTransformFromParentBodyNode(dart.math.Isometry3(place))
        self._world.addSkeleton(skeleton)

    def _collide(self, node, shape) -> None:
        shape_node = node.createShapeNode(shape)
        shape_node.createCollisionAspect()
        shape_node.createDynamicsAspect()
        shape_node.getDynamicsAspect().setFrictionCoeff(self._scene["friction"])
        shape_node.getDynamicsAspect().setRestitutionCoeff(0)

    def _shape(self, body: dict):
        if "box" in body:
            return self._dart.dynamics.BoxShape(body["box"])
        file = str(pathlib.Path(body["mesh"]))
        if file not in self._shapes:
            self._shapes[file] = _shape_of_mesh(self._dart, file)
        return self._shapes[file]

    def _add(self, body: dict):
        dart = self._dart
        skeleton = dart.dynamics.Skeleton(body["name"])
        place = np.eye(4)
        place[:3, :3], place[:3, 3] = Rotation.from_quat(body["rotation"]).as_matrix(), body["position"]
        at = dart.math.Isometry3(place)
        moves = body["mass"] > 0 or "path" in body
        if "hinge" in body:
            joint, node = skeleton.createRevoluteJointAndBodyNodePair()
            joint.setTransformFromParentBodyNode(at)
            self._hinge(body, joint)
        elif moves:
            joint, node = skeleton.createFreeJointAndBodyNodePair()
            joint.setTransform(at)
        else:
            joint, node = skeleton.createWeldJointAndBodyNodePair()
            joint.setTransformFromParentBodyNode(at)
        if "path" in body:
            joint.setActuatorType(dart.dynamics.ActuatorType.VELOCITY)
        elif moves:
            node.setInertia(dart.dynamics.Inertia(body["mass"], [0, 0, 0], np.diag(body["inertia"])))
        self._collide(node, self._shape(body))
        self._world.addSkeleton(skeleton)
        return node

    def _hinge(self, body: dict, joint) -> None:
        hinge = body["hinge"]
        joint.setAxis(in_body_axes(body, hinge["axis"]))
        joint.setDampingCoefficient(0, hinge.get("damping", 0))
        if hinge.get("torque"):  # a SERVO, which is limited by its torque, stops as teeth touch
            joint.setActuatorType(self._dart.dynamics.ActuatorType.VELOCITY)

    def step(self, time: float) -> None:
        for body, node in zip(self._scene["bodies"], self._nodes):
            if "path" in body:  # a free joint's commands are in the axes of the body
                velocity = path_at(body["path"], time)[1]
                node.getParentJoint().setCommands([0, 0, 0, *Rotation.from_quat(body["rotation"]).inv().apply(velocity)])
            if body.get("hinge", {}).get("torque"):
                node.getParentJoint().setCommand(0, body["hinge"]["speed"])
            if "force" in body:
                node.setExtForce(force_at(body["force"], time), [0, 0, 0], False, True)
        self._world.step()

    def poses(self) -> np.ndarray:
        found = []
        for node in self._nodes:
            place = node.getWorldTransform().matrix()
            found.append([*place[:3, 3], *Rotation.from_matrix(place[:3, :3]).as_quat()])
        return np.array(found)


_SOLVER = ("its default solver (boxed LCP by Dantzig, then PGS), no sleeping; motors are VELOCITY actuators, as gears stop with a SERVO "
           "of 10,000 N m; split impulses do better for a stack, worse for bricks, and are off as by default")


class DartFcl(_Dart):
    name, detector = "dart-fcl", "FCLCollisionDetector"
    settings = f"triangle meshes, its default detector; {_SOLVER}"


class DartBullet(_Dart):
    name, detector = "dart-bullet", "BulletCollisionDetector"
    settings = f"triangle meshes, its detector of Bullet, which is GImpact there; {_SOLVER}"


ENGINES = [DartFcl, DartBullet]
