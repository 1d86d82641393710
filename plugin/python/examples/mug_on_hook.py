"""A mug hangs by its handle on a hook."""

import numpy as np
import pybullet as p
from picture import save

import innersphere
import innersphere.pybullet


def mug(q):
    """Signed distance: a cup about y, open at +y, with a handle above."""
    r, y = np.hypot(q[:, 0], q[:, 2]), q[:, 1]
    cup = np.maximum(np.maximum(r - 0.4, np.abs(y) - 0.5), -np.maximum(r - 0.3, -0.4 - y))
    handle = np.hypot(np.hypot(q[:, 2] - 0.4, y) - 0.25, q[:, 0]) - 0.06
    return np.minimum(cup, np.maximum(handle, 0.35 - r))


def hook(q):
    """A bar along x that bends up at its end."""
    bar = np.linalg.norm(q - np.clip(q, [-0.6, 0, 0], [0.3, 0, 0]), axis=1)
    end = np.linalg.norm(q - np.clip(q, [0.3, 0, 0], [0.3, 0, 0.2]), axis=1)
    return np.minimum(bar, end) - 0.05


surfaces = (
    innersphere.surface_of(mug, [-0.45, -0.55, -0.45], [0.45, 0.55, 0.75], cells=26),
    innersphere.surface_of(hook, [-0.7, -0.1, -0.1], [0.4, 0.1, 0.3], cells=40),
)
cup, bar = (innersphere.pack(s, spheres=2000, cache="packings", overlap_errors=False) for s in surfaces)
p.connect(p.DIRECT)
p.setGravity(0, 0, -9.81)
sim = innersphere.pybullet.attach()
sim.create_body(bar, position=[0, 0, 0.52])
hanging = sim.create_body(cup, 0.3)
p.changeDynamics(hanging, -1, angularDamping=0.9)  # some drag, so that it comes to rest soon
for _ in range(1200):
    p.stepSimulation()
place, speed = sim.mesh_pose(hanging)[0], np.linalg.norm(p.getBaseVelocity(hanging)[0])
print(f"after 5 s the mug hangs at {place[2]:.3f} m, at {1000 * speed:.1f} mm/s, with {len(sim.overlaps())} contact")
save("mug_on_hook.png", [0, 0, 0.1], 3, yaw=40, pitch=-15)
