"""A peg falls into a hole that is 4 % wider, and fills it; PyBullet's hull of the plate has no hole."""

import numpy as np
import pybullet as p
from picture import save

import innersphere
import innersphere.pybullet


def plate(points):
    """Signed distance: a plate of 1 x 1 x 0.4 m with a hole of 0.26 m radius."""
    block = (np.abs(points) - [0.5, 0.5, 0.2]).max(axis=1)
    return np.maximum(block, 0.26 - np.hypot(points[:, 0], points[:, 1]))


peg, hole = (
    innersphere.pack(mesh, spheres=2000, cache="packings", overlap_errors=False)
    for mesh in (
        innersphere.surface_of(
            lambda q: np.maximum(np.hypot(q[:, 0], q[:, 1]) - 0.25, np.abs(q[:, 2]) - 0.4), -0.42, 0.42, cells=32
        ),
        innersphere.surface_of(plate, [-0.55, -0.55, -0.25], [0.55, 0.55, 0.25], cells=28),
    )
)
p.connect(p.DIRECT)
p.setGravity(0, 0, -9.81)
p.createMultiBody(0, p.createCollisionShape(p.GEOM_PLANE), basePosition=[0, 0, -0.2])
sim = innersphere.pybullet.attach()
sim.create_body(hole)
falling = sim.create_body(peg, 1, [0, 0, 0.7])
p.resetBaseVelocity(falling, angularVelocity=[0, 0, 3])
for _ in range(480):
    p.stepSimulation()
height = sim.mesh_pose(falling)[0][2]
print(f"the peg stands at {height:.3f} m (on the floor through the hole: 0.200; on the plate: 0.600)")
save("peg_in_hole.png", [0, 0, 0.2], 2.5)
