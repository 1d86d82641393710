"""Six links hang in each other, and what PyBullet's own hulls do with them."""

import pybullet as p
from picture import save

import innersphere
import innersphere.pybullet

link = innersphere.pack(innersphere.solid("link"), spheres=500, cache="packings", overlap_errors=False)
upright, across = (p.getQuaternionFromEuler([0, 1.5708, turn]) for turn in (0, 1.5708))
ends = []
for packed in (True, False):
    client = p.connect(p.DIRECT)
    p.setGravity(0, 0, -9.81, physicsClientId=client)
    sim = innersphere.pybullet.attach(client)
    hull = p.createCollisionShape(p.GEOM_MESH, vertices=link.vertices.tolist(), physicsClientId=client)
    for i in range(6):
        place, turn, mass = [0, 0, -0.93 * i], across if i % 2 else upright, min(i, 1)
        if packed:
            body = sim.create_body(link, mass, place, turn)
        else:
            body = p.createMultiBody(mass, hull, -1, place, turn, physicsClientId=client)
    for _ in range(2400):
        p.stepSimulation(physicsClientId=client)
    ends.append(p.getBasePositionAndOrientation(body, physicsClientId=client)[0][2])
    if packed:
        save("chain.png", [0, 0, -2.3], 9, client)
print(f"the last link hangs at {ends[0]:.4f} m (taut: -4.7000); that of hulls is at {ends[1]:.1f} m")
