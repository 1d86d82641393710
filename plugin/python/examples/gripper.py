"""Two jaws, pushed together by 20 N, lift a mug by its wall; PyBullet's hull of it is full where one jaw is."""

from pathlib import Path

import pybullet as p
from parts import small_mug
from worlds import both, picture

worlds, lifted = both(), []
for world in worlds:
    options = dict(physicsClientId=world.client)
    p.createMultiBody(0, p.createCollisionShape(p.GEOM_PLANE, **options), **options)
    gripper = p.loadURDF(str(Path(__file__).parent / "gripper.urdf"), useFixedBase=True, **options)
    held = world.add(small_mug(), 0.3)
    for step in range(960):
        height = 0.2 * min(max((step - 240) / 480, 0), 1)
        p.setJointMotorControl2(gripper, 0, p.POSITION_CONTROL, height, force=200, **options)
        for jaw in (1, 2):
            p.setJointMotorControl2(gripper, jaw, p.VELOCITY_CONTROL, targetVelocity=0.1, force=20, **options)
        world.run(1 / 240)
    lifted.append(world.pose(held)[0][2])
tilt = p.getEulerFromQuaternion(worlds[0].pose(held)[1])[:2]
print("the jaws rose by 0.200 m, the mug by {:.3f} m, and PyBullet's by {:.3f} m".format(*lifted))
picture("gripper.png", worlds, [0, 0, 0.15], 0.6, yaw=20)
