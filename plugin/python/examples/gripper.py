"""Two jaws, pushed together by 20 N, lift a mug by its walls."""

import numpy as np
import pybullet as p
from picture import save

import innersphere
import innersphere.pybullet

LINK = '<link name="{0}"><inertial><mass value="{1}"/><inertia ixx="1e-3" ixy="0" ixz="0" iyy="1e-3" iyz="0" izz="1e-3"/></inertial>{2}</link>'
BOX = '<{0}><geometry><box size="0.02 0.04 0.06"/></geometry></{0}>'
JOINT = (
    '<joint name="to {1}" type="prismatic"><parent link="{0}"/><child link="{1}"/><origin xyz="{2}"/><axis xyz="{3}"/>'
    '<limit lower="-1" upper="1" effort="100" velocity="1"/></joint>'
)


def mug(q):
    """Signed distance: a cup on z = 0, 8 cm wide and 10 cm high, with walls of 5 mm."""
    r, z = np.hypot(q[:, 0], q[:, 1]), q[:, 2]
    return np.maximum(np.maximum(r - 0.04, np.abs(z - 0.05) - 0.05), -np.maximum(r - 0.035, 0.008 - z))


jaw = BOX.format("visual") + BOX.format("collision")
parts = [
    LINK.format("base", 1, ""),
    LINK.format("lift", 1, ""),
    LINK.format("left", 0.2, jaw),
    LINK.format("right", 0.2, jaw),
]
joints = [
    ("base", "lift", "0 0 0.06", "0 0 1"),
    ("lift", "left", "-0.07 0 0", "1 0 0"),
    ("lift", "right", "0.07 0 0", "-1 0 0"),
]
with open("gripper.urdf", "w") as file:
    file.write("<robot name='gripper'>" + "".join(parts + [JOINT.format(*joint) for joint in joints]) + "</robot>")

surface = innersphere.surface_of(mug, [-0.045, -0.045, -0.005], [0.045, 0.045, 0.105], cells=26)
packing = innersphere.pack(surface, spheres=3000, cache="packings", overlap_errors=False)
p.connect(p.DIRECT)
p.setGravity(0, 0, -9.81)
floor = p.createMultiBody(0, p.createCollisionShape(p.GEOM_PLANE))
gripper = p.loadURDF("gripper.urdf", useFixedBase=True)
sim = innersphere.pybullet.attach()
held = sim.create_body(packing, 0.3)
for step in range(960):
    height = 0.2 * np.clip((step - 240) / 480, 0, 1)
    p.setJointMotorControl2(gripper, 0, p.POSITION_CONTROL, height, force=200)
    for joint in (1, 2):
        p.setJointMotorControl2(gripper, joint, p.VELOCITY_CONTROL, targetVelocity=0.1, force=20)
    p.stepSimulation()
lifted, tilt = sim.mesh_pose(held)[0][2], p.getEulerFromQuaternion(sim.mesh_pose(held)[1])[:2]
print(f"the jaws rose by 0.200 m, the mug by {lifted:.3f} m; it is tilted by {np.abs(tilt).max():.3f} rad")
save("gripper.png", [0, 0, 0.2], 0.7, yaw=20)
