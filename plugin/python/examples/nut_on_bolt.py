"""A nut without friction turns down its bolt, as the law of the screw says."""

import math

import pybullet as p
from picture import save

import innersphere
import innersphere.pybullet

p.connect(p.DIRECT)  # or p.GUI
p.setGravity(0, 0, -9.81)
sim = innersphere.pybullet.attach()
bolt, nut = (
    innersphere.pack(innersphere.solid(name), spheres=2000, cache="packings", overlap_errors=False)
    for name in ("bolt", "nut")
)
pitch, start, mass = 0.125, 0.36, 1.0
fixed = sim.create_body(bolt)
turning = sim.create_body(nut, mass, [0, 0, start], p.getQuaternionFromEuler([0, 0, 2 * math.pi * start / pitch]))
for body in (fixed, turning):
    p.changeDynamics(body, -1, lateralFriction=0, linearDamping=0, angularDamping=0, restitution=0)
for _ in range(480):
    p.stepSimulation()
sank = start - sim.mesh_pose(turning)[0][2]
speed, spin = (v[2] for v in p.getBaseVelocity(turning))
turns = spin * pitch / (2 * math.pi * speed)  # for each pitch
law = 9.81 / (1 + nut.inertia[2, 2] / nut.volume * (2 * math.pi / pitch) ** 2)
print(
    f"after 2 s it sinks at {-speed:.4f} m/s (law: {2 * law:.4f}), has sunk {sank:.4f} m and turns {turns:.4f} times a pitch"
)
save("nut_on_bolt.png", [0, 0, 0.4], 2.5)
