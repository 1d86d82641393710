"""A nut without friction turns down its bolt, as the law of the screw says. PyBullet's hull of it has no hole."""

import math

import pybullet as p
from parts import packed
from worlds import both, picture

bolt, nut = packed("bolt"), packed("nut")
pitch, start = 0.125, 0.36
worlds, sank = both(), []
for world in worlds:
    turn = p.getQuaternionFromEuler([0, 0, 2 * math.pi * start / pitch])
    bodies = world.add(bolt, friction=0), world.add(nut, 1, [0, 0, start], turn, friction=0)
    for body in bodies:
        p.changeDynamics(body, -1, linearDamping=0, angularDamping=0, physicsClientId=world.client)
    world.run(2)
    sank.append(start - world.pose(bodies[1])[0][2])
speed, spin = (v[2] for v in p.getBaseVelocity(bodies[1], physicsClientId=worlds[0].client))
turns = spin * pitch / (2 * math.pi * speed)  # for each pitch
law = 9.81 / (1 + nut.inertia[2, 2] / nut.volume * (2 * math.pi / pitch) ** 2)
print(f"after 2 s it sinks at {-speed:.4f} m/s (law: {2 * law:.4f}) and turns {turns:.4f} times a pitch")
print(f"it has sunk {sank[0]:.3f} m, and PyBullet's {sank[1]:.3f} m")
picture("nut_on_bolt.png", worlds, [0, 0, 0.4], 2.5)
