"""Pictures of PyBullet's world, drawn without a window."""

import numpy as np
import pybullet as p
from PIL import Image


def save(path, target, distance, client=0, yaw=30, pitch=-25):
    """Writes what a camera sees that looks at `target` [m]."""
    colours = [(0.9, 0.6, 0.3, 1), (0.4, 0.6, 0.9, 1), (0.6, 0.8, 0.4, 1), (0.8, 0.5, 0.7, 1)]
    for body in range(p.getNumBodies(physicsClientId=client)):
        p.changeVisualShape(body, -1, rgbaColor=colours[body % len(colours)], physicsClientId=client)
    view = p.computeViewMatrixFromYawPitchRoll(target, distance, yaw, pitch, 0, 2)
    lens = p.computeProjectionMatrixFOV(40, 4 / 3, 0.01, 100)
    pixels = p.getCameraImage(640, 480, view, lens, [1, 2, 4], renderer=p.ER_TINY_RENDERER, physicsClientId=client)[2]
    Image.fromarray(np.reshape(pixels, (480, 640, 4))[..., :3].astype(np.uint8)).save(path)
