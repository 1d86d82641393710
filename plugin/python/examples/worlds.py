"""Two worlds of PyBullet, with innersphere and without, and pictures of both side by side."""

import numpy as np
import pybullet as p
from PIL import Image

import innersphere
import innersphere.pybullet


class World:
    """A client of PyBullet. With `packed` bodies collide as packings, else as PyBullet has them."""

    def __init__(self, packed):
        self.client = p.connect(p.DIRECT)  # or p.GUI, for one of them
        p.setGravity(0, 0, -9.81, physicsClientId=self.client)
        self.sim = innersphere.pybullet.attach(self.client) if packed else None

    def add(self, packing, mass=0, position=(0, 0, 0), orientation=(0, 0, 0, 1), friction=0.5):
        """Puts a solid where its mesh is at a pose. Mass 0: it stands still."""
        if self.sim:
            body = self.sim.create_body(packing, mass, position, orientation)
        else:  # what moves is the hull of its mesh; what stands still may be the mesh itself
            points = dict(vertices=packing.vertices.tolist(), physicsClientId=self.client)
            mesh = dict(points, indices=packing.faces.ravel().tolist())
            shape = p.createCollisionShape(p.GEOM_MESH, **(points if mass else mesh))
            seen = p.createVisualShape(p.GEOM_MESH, **mesh)
            centre = packing.center_of_mass.tolist()
            body = p.createMultiBody(mass, shape, seen, position, orientation, centre, physicsClientId=self.client)
        p.changeDynamics(body, -1, lateralFriction=friction, physicsClientId=self.client)
        return body

    def run(self, seconds):
        for _ in range(round(240 * seconds)):
            p.stepSimulation(physicsClientId=self.client)

    def pose(self, body):
        """Where the body's mesh is: position and quaternion."""
        if self.sim:
            return self.sim.mesh_pose(body)
        inertial = p.getDynamicsInfo(body, -1, physicsClientId=self.client)[3:5]
        mass_centre = p.getBasePositionAndOrientation(body, physicsClientId=self.client)
        return p.multiplyTransforms(*mass_centre, *p.invertTransform(*inertial))


def both():
    return World(packed=True), World(packed=False)


def picture(path, worlds, target, distance, yaw=30, pitch=-25):
    """Writes what a camera sees that looks at `target` [m] in each world."""
    colours = [(0.9, 0.6, 0.3, 1), (0.4, 0.6, 0.9, 1), (0.6, 0.8, 0.4, 1), (0.8, 0.5, 0.7, 1)]
    view = p.computeViewMatrixFromYawPitchRoll(target, distance, yaw, pitch, 0, 2)
    lens = p.computeProjectionMatrixFOV(40, 1, 0.01, 100)
    halves = []
    for world in worlds:
        options = dict(physicsClientId=world.client)
        for body in range(p.getNumBodies(**options)):
            p.changeVisualShape(body, -1, rgbaColor=colours[body % len(colours)], **options)
        pixels = p.getCameraImage(480, 480, view, lens, [1, 2, 4], renderer=p.ER_TINY_RENDERER, **options)[2]
        halves.append(np.reshape(pixels, (480, 480, 4))[..., :3].astype(np.uint8))
    Image.fromarray(np.concatenate(halves, axis=1)).save(path)
