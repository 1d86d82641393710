"""MuJoCo, with the signed distance fields that it makes of meshes, or with convex parts."""

import numpy as np

from ..scene import force_at, path_at
from .base import Engine, in_body_axes

_HEAVY = 1e4  # [kg] of a body that is told where to be: mocap bodies have no velocity, so that friction would not carry


def _numbers(values) -> str:
    return " ".join(f"{value:.12g}" for value in values)


def _quaternion(xyzw: list[float]) -> str:
    return _numbers([xyzw[3], *xyzw[:3]])


class _MuJoCo(Engine):
    fields: bool

    @classmethod
    def version(cls) -> str:
        import mujoco

        return "MuJoCo " + mujoco.__version__

    def __init__(self, scene: dict, dt: float) -> None:
        import mujoco

        self._mujoco, self._scene, self._dt = mujoco, scene, dt
        self._concave = any(len(body.get("hulls", [])) > 1 for body in scene["bodies"])
        self._model = mujoco.MjModel.from_xml_string(self._xml())
        self._data = mujoco.MjData(self._model)
        self._numbers = [self._model.body(f"b{i}").id for i in range(len(scene["bodies"]))]

    def _files(self, body: dict) -> list[str]:
        """Meshes of a body: one field, or convex parts. Fields meet fields best; where all is convex there is no need of them."""
        return [body["mesh"]] if self.fields and self._concave else body["hulls"]

    def _xml(self) -> str:
        scene = self._scene
        files = sorted({file for body in scene["bodies"] if "mesh" in body for file in self._files(body)})
        self._mesh = {file: f"m{i}" for i, file in enumerate(files)}
        contact = f'condim="3" friction="{scene["friction"]} 0 0"' if scene["friction"] else 'condim="1"'
        meshes = "".join(f'<mesh name="{name}" file="{file}" inertia="shell"/>' for file, name in self._mesh.items())
        ground = "" if scene["ground"] is None else f'<geom type="plane" size="50 50 1" pos="0 0 {scene["ground"]}"/>'
        bodies = "".join(self._body(i, body) for i, body in enumerate(scene["bodies"]))
        motors = "".join(self._motor(i, body["hinge"]) for i, body in enumerate(scene["bodies"])
                         if body.get("hinge", {}).get("torque"))
        return f"""<mujoco><compiler inertiafromgeom="false" autolimits="true"/><size memory="1G"/>
<option timestep="{self._dt!r}" gravity="0 0 -9.81" integrator="implicitfast" cone="elliptic" impratio="10" sdf_iterations="20"
 sdf_initpoints="40"/>
<default><geom {contact} solref="0.01 1" solimp=".95 .99 .0001"/></default>
<asset>{meshes}</asset><worldbody>{ground}{bodies}</worldbody><actuator>{motors}</actuator></mujoco>"""

    @staticmethod
    def _motor(i: int, hinge: dict) -> str:
        """Its gain reaches the torque's limit at standstill. A stronger one is cut off there, and rings."""
        torque, speed = hinge["torque"], abs(hinge["speed"])
        return f'<velocity joint="j{i}" kv="{torque / speed!r}" ctrlrange="{-speed} {speed}" forcerange="{-torque} {torque}"/>'

    def _body(self, i: int, body: dict) -> str:
        mass, inertia, joints, more = body["mass"], body["inertia"], "", ""
        if "path" in body:
            mass, inertia, more = _HEAVY, [_HEAVY] * 3, ' gravcomp="1"'
            joints = "".join(f'<joint name="j{i}{a}" type="slide" axis="{v}"/>'
                             for a, v in (("x", "1 0 0"), ("y", "0 1 0"), ("z", "0 0 1")))
        elif "hinge" in body:
            hinge = body["hinge"]
            joints = (f'<joint name="j{i}" type="hinge" axis="{_numbers(in_body_axes(body, hinge["axis"]))}" '
                      f'damping="{hinge.get("damping", 0)}"/>')
        elif mass > 0:
            joints = "<freejoint/>"
        inertial = f'<inertial pos="0 0 0" mass="{mass!r}" diaginertia="{_numbers(inertia)}"/>' if joints else ""
        return (f'<body name="b{i}" pos="{_numbers(body["position"])}" quat="{_quaternion(body["rotation"])}"{more}>'
                f"{joints}{inertial}{self._geoms(body)}</body>")

    def _geoms(self, body: dict) -> str:
        if "box" in body:
            return f'<geom type="box" size="{_numbers(edge / 2 for edge in body["box"])}"/>'
        files = self._files(body)
        kind = "sdf" if files == [body["mesh"]] else "mesh"
        return "".join(f'<geom type="{kind}" mesh="{self._mesh[file]}"/>' for file in files)

    def step(self, time: float) -> None:
        model, data = self._model, self._data
        for i, (body, number) in enumerate(zip(self._scene["bodies"], self._numbers)):
            if "path" in body:
                way, velocity = path_at(body["path"], time)
                data.qpos[[model.joint(f"j{i}{a}").qposadr[0] for a in "xyz"]] = way
                data.qvel[[model.joint(f"j{i}{a}").dofadr[0] for a in "xyz"]] = velocity
            if "force" in body:
                data.xfrc_applied[number, :3] = force_at(body["force"], time)
        data.ctrl[:] = [b["hinge"]["speed"] for b in self._scene["bodies"] if b.get("hinge", {}).get("torque")]
        self._mujoco.mj_step(model, data)

    def poses(self) -> np.ndarray:
        self._mujoco.mj_kinematics(self._model, self._data)
        place, turn = self._data.xpos[self._numbers], self._data.xquat[self._numbers]
        return np.hstack([place, turn[:, 1:], turn[:, :1]])


_CONTACT = "solref 0.01 1, solimp .95 .99 .0001 (its own examples), elliptic cones, impratio 10 (its chapter on slip), implicitfast"


class MuJoCoFields(_MuJoCo):
    name, fields = "mujoco-sdf", True
    settings = f"geoms of type sdf, its octree of the mesh, for all meshes of a scene that has concave ones, 20 iterations from 40 points (model/plugin/sdf/octree.xml); {_CONTACT}"


class MuJoCoHulls(_MuJoCo):
    name, fields = "mujoco-hulls", False
    settings = f"CoACD's hulls, threshold 0.02 (its manual's advice for concave meshes); {_CONTACT}"


ENGINES = [MuJoCoFields, MuJoCoHulls]
