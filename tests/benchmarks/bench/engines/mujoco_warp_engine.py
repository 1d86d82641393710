"""MuJoCo Warp: MuJoCo's models on a CUDA device, of the same XML."""

import importlib.metadata

import numpy as np

from ..scene import force_at, path_at
from .base import Absent
from .mujoco_engine import MuJoCoFields, MuJoCoHulls

_CONTACTS, _ROWS = 4096, 16384  # room for: what is more it would drop, and says so


class _OnDevice:
    @classmethod
    def version(cls) -> str:
        import mujoco_warp  # noqa: F401
        import warp

        if not warp.get_cuda_device_count():
            raise Absent("no CUDA device")
        return f"MuJoCo Warp {importlib.metadata.version('mujoco-warp')}, {warp.get_cuda_device(0).name}"

    def __init__(self, scene: dict, dt: float) -> None:
        import mujoco_warp
        import warp

        super().__init__(scene, dt)
        self._mujoco.mj_forward(self._model, self._data)
        self._moved = mujoco_warp.put_model(self._model)
        self._state = mujoco_warp.put_data(self._model, self._data, nconmax=_CONTACTS, njmax=_ROWS)
        mujoco_warp.step(self._moved, self._state)  # compiles
        self._state = mujoco_warp.put_data(self._model, self._data, nconmax=_CONTACTS, njmax=_ROWS)
        with warp.ScopedCapture() as capture:
            mujoco_warp.step(self._moved, self._state)
        self._graph, self._warp = capture.graph, warp

    def step(self, time: float) -> None:
        state, bodies = self._state, self._scene["bodies"]
        if any("path" in body for body in bodies):
            places, speeds = state.qpos.numpy(), state.qvel.numpy()
            for i, body in enumerate(bodies):
                if "path" in body:
                    way, velocity = path_at(body["path"], time)
                    places[0, [self._model.joint(f"j{i}{a}").qposadr[0] for a in "xyz"]] = way
                    speeds[0, [self._model.joint(f"j{i}{a}").dofadr[0] for a in "xyz"]] = velocity
            state.qpos.assign(places)
            state.qvel.assign(speeds)
        if any("force" in body for body in bodies):
            forces = state.xfrc_applied.numpy()
            for body, number in zip(bodies, self._numbers):
                if "force" in body:
                    forces[0, number, :3] = force_at(body["force"], time)
            state.xfrc_applied.assign(forces)
        speeds = [b["hinge"]["speed"] for b in bodies if b.get("hinge", {}).get("torque")]
        if speeds:
            state.ctrl.assign(np.array([speeds], dtype=np.float32))
        self._warp.capture_launch(self._graph)
        self._warp.synchronize()

    def poses(self) -> np.ndarray:
        self._data.qpos[:] = self._state.qpos.numpy()[0]
        return super().poses()


class MuJoCoWarpFields(_OnDevice, MuJoCoFields):
    name = "mjwarp-sdf"
    settings = "as mujoco-sdf, on a CUDA device, in single precision; one world: it is made for thousands, so its time says little"


class MuJoCoWarpHulls(_OnDevice, MuJoCoHulls):
    name = "mjwarp-hulls"
    settings = "as mujoco-hulls, on a CUDA device, in single precision; one world"


ENGINES = [MuJoCoWarpFields, MuJoCoWarpHulls]
