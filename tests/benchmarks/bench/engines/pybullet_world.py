"""A scene in PyBullet; what bodies collide with is left to those who inherit."""

import importlib.metadata
import math

import numpy as np

from ..scene import force_at, path_at
from .base import Engine, in_body_axes

_HEAVY = 1e4  # [kg] of a body that is told where to be: PyBullet has no moving bodies without mass


class PyBulletWorld(Engine):
    @classmethod
    def version(cls) -> str:
        import pybullet  # noqa: F401

        return "PyBullet " + importlib.metadata.version("pybullet")

    def __init__(self, scene: dict, dt: float) -> None:
        import pybullet as p

        self._p, self._scene, self._dt = p, scene, dt
        self._client = p.connect(p.DIRECT)
        p.setGravity(0, 0, -9.81)
        p.setTimeStep(dt)
        self._attach()
        self._bodies = []
        if scene["ground"] is not None:
            plane = p.createMultiBody(0, p.createCollisionShape(p.GEOM_PLANE), basePosition=[0, 0, scene["ground"]])
            p.changeDynamics(plane, -1, lateralFriction=math.sqrt(scene["friction"]))
        for body in scene["bodies"]:
            self._bodies.append(self._add(body))

    def _attach(self) -> None:
        pass

    def _shape(self, body: dict) -> int:
        """A shape of PyBullet's own."""
        raise NotImplementedError

    def _finish(self, body: dict, number: int, link: int) -> None:
        """Called when a body is there."""

    def _box(self, body: dict) -> int:
        return self._p.createCollisionShape(self._p.GEOM_BOX, halfExtents=[edge / 2 for edge in body["box"]])

    def _add(self, body: dict) -> tuple[int, int]:
        p = self._p
        shape = self._box(body) if "box" in body else self._shape(body)
        place, turn = body["position"], body["rotation"]
        mass = _HEAVY if "path" in body else body["mass"]
        if "hinge" in body:
            number, link = self._hinged(body, shape), 0
        else:
            number, link = p.createMultiBody(mass, shape, -1, place, turn), -1
        p.changeDynamics(number, link, lateralFriction=math.sqrt(self._scene["friction"]), linearDamping=0, angularDamping=0,
                         activationState=p.ACTIVATION_STATE_DISABLE_SLEEPING)
        if mass > 0 and "path" not in body:
            p.changeDynamics(number, link, localInertiaDiagonal=body["inertia"])
        if "box" not in body:
            self._finish(body, number, link)
        return number, link

    def _hinged(self, body: dict, shape: int) -> int:
        p, hinge = self._p, body["hinge"]
        number = p.createMultiBody(
            0, -1, -1, body["position"], body["rotation"], linkMasses=[body["mass"]], linkCollisionShapeIndices=[shape],
            linkVisualShapeIndices=[-1], linkPositions=[[0, 0, 0]], linkOrientations=[[0, 0, 0, 1]],
            linkInertialFramePositions=[[0, 0, 0]], linkInertialFrameOrientations=[[0, 0, 0, 1]], linkParentIndices=[0],
            linkJointTypes=[p.JOINT_REVOLUTE], linkJointAxis=[in_body_axes(body, hinge["axis"]).tolist()])
        p.setJointMotorControl2(number, 0, p.VELOCITY_CONTROL, targetVelocity=hinge.get("speed", 0), force=hinge.get("torque", 0))
        p.changeDynamics(number, 0, jointDamping=hinge.get("damping", 0))
        return number

    def step(self, time: float) -> None:
        p = self._p
        for body, (number, link) in zip(self._scene["bodies"], self._bodies):
            if "path" in body:
                way, velocity = path_at(body["path"], time)
                p.resetBasePositionAndOrientation(number, np.add(body["position"], way).tolist(), body["rotation"])
                p.resetBaseVelocity(number, velocity.tolist(), [0, 0, 0])
                p.applyExternalForce(number, -1, [0, 0, 9.81 * _HEAVY], [0, 0, 0], p.LINK_FRAME)
            if "force" in body:
                place = p.getBasePositionAndOrientation(number)[0]
                p.applyExternalForce(number, link, force_at(body["force"], time).tolist(), place, p.WORLD_FRAME)
        p.stepSimulation()

    def poses(self) -> np.ndarray:
        p = self._p
        found = []
        for number, link in self._bodies:
            state = p.getBasePositionAndOrientation(number) if link < 0 else p.getLinkState(number, link, 0, 1)[:2]
            found.append([*state[0], *state[1]])
        return np.array(found)
