"""A mug hangs by its handle on a hook; the handle of PyBullet's hull is filled."""

import numpy as np
import pybullet as p
from parts import hook, mug
from worlds import both, picture

worlds, places, speeds = both(), [], []
for world in worlds:
    world.add(hook(), position=[0, 0, 0.52])
    hanging = world.add(mug(), 0.3)
    # Some drag, so that it comes to rest soon.
    p.changeDynamics(hanging, -1, angularDamping=0.9, physicsClientId=world.client)
    world.run(5)
    places.append(world.pose(hanging)[0])
    speeds.append(np.linalg.norm(p.getBaseVelocity(hanging, physicsClientId=world.client)[0]))
print(f"after 5 s the mug hangs at {places[0][2]:.3f} m, at {1000 * speeds[0]:.1f} mm/s")
print(f"PyBullet's is at {places[1][2]:.3f} m, at {1000 * speeds[1]:.1f} mm/s")
picture("mug_on_hook.png", worlds, [0, 0, 0.1], 3, yaw=40, pitch=-15)
