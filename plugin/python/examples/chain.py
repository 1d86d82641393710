"""Six links hang in each other; PyBullet's hulls of the same links burst apart."""

import pybullet as p
from parts import packed
from worlds import both, picture

link = packed("link", spheres=500)
upright, across = (p.getQuaternionFromEuler([0, 1.5708, turn]) for turn in (0, 1.5708))
worlds, ends = both(), []
for world in worlds:
    for i in range(6):
        last = world.add(link, min(i, 1), [0, 0, -0.93 * i], across if i % 2 else upright)
    world.run(10)
    ends.append(world.pose(last)[0][2])
print(f"the last link hangs at {ends[0]:.4f} m (taut: -4.7000); that of hulls is at {ends[1]:.1f} m")
picture("chain.png", worlds, [0, 0, -2.3], 9)
