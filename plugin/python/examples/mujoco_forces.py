"""Links hang in each other in MuJoCo, which has no contact of its own for them: forces of overlaps, by xfrc_applied."""

import mujoco
import numpy as np

import innersphere

LINKS, MASS, STIFFNESS, DAMPING = 4, 1.0, 3e6, 30.0  # [kg], [N/m^3], [N s/m]
link = innersphere.pack(innersphere.solid("link"), spheres=500, cache="packings", overlap_errors=False)
inertia = " ".join(f"{x:.6g}" for x in np.diag(link.inertia) * MASS / link.volume)
bodies = "".join(
    f'<body pos="0 0 {-0.93 * i}" euler="90 {90 * (i % 2)} 0">{"<freejoint/>" * (i > 0)}'
    f'<inertial pos="0 0 0" mass="{MASS}" diaginertia="{inertia}"/></body>'
    for i in range(LINKS)
)
model = mujoco.MjModel.from_xml_string(
    f'<mujoco><compiler eulerseq="yxz"/><option timestep="0.001"/><worldbody>{bodies}</worldbody></mujoco>'
)
data, query = mujoco.MjData(model), innersphere.Query("cpu", threads=1)
a, b = np.arange(1, LINKS), np.arange(2, LINKS + 1)  # neighbours; body 0 is the world
for _ in range(4000):
    mujoco.mj_forward(model, data)
    poses = data.xpos, data.xquat[:, [1, 2, 3, 0]]  # MuJoCo's quaternions begin with w
    found = query.overlap(link, link, tuple(x[a] for x in poses), tuple(x[b] for x in poses))
    speed = data.cvel[:, 3:]  # of the middle of all: good enough for damping
    touching = (found["volume"] > 0)[:, None]
    force = STIFFNESS * found["force"] - DAMPING * touching * (speed[b] - speed[a])
    torque = STIFFNESS * found["torque"]
    data.xfrc_applied[:] = 0
    data.xfrc_applied[b, :3] += force
    data.xfrc_applied[b, 3:] += torque - 0.02 * touching * data.cvel[b, :3]
    data.xfrc_applied[a, :3] -= force
    data.xfrc_applied[a, 3:] -= torque + np.cross(data.xpos[b] - data.xpos[a], STIFFNESS * found["force"])
    mujoco.mj_step(model, data)
print(
    f"the last link hangs at {data.xpos[-1, 2]:.3f} m (taut: {-0.94 * (LINKS - 1):.3f}, and a little more by overlaps)"
)
