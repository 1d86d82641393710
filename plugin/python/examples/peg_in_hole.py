"""A peg falls into a hole that is 4 % wider. PyBullet has holes in bodies that stand still; this one may move."""

import pybullet as p
from parts import peg, plate
from worlds import both, picture

worlds, heights = both(), []
for world in worlds:
    floor = p.createCollisionShape(p.GEOM_PLANE, physicsClientId=world.client)
    p.createMultiBody(0, floor, basePosition=[0, 0, -0.2], physicsClientId=world.client)
    world.add(plate(), 5)
    falling = world.add(peg(), 1, [0, 0, 0.7])
    p.resetBaseVelocity(falling, angularVelocity=[0, 0, 3], physicsClientId=world.client)
    world.run(2)
    heights.append(world.pose(falling)[0][2])
print("it stands at {:.3f} m, and PyBullet's at {:.3f} m (on the floor: 0.200; on the plate: 0.600)".format(*heights))
picture("peg_in_hole.png", worlds, [0, 0, 0.2], 2.5)
