"""Brackets find places in a tray where none overlaps, along the forces that drive them apart."""

import numpy as np
from PIL import Image, ImageDraw

import innersphere

COUNT = 12
vertices, faces = innersphere.solid("lbracket")
options = dict(spheres=1000, cache="packings", overlap_errors=False)
part, tray = (
    innersphere.pack((0.45 * vertices, faces), **options),
    innersphere.pack(innersphere.solid("tray"), **options),
)
query, rng = innersphere.Query(), np.random.default_rng(1)
place = np.append(rng.uniform(-0.6, 0.6, (COUNT, 2)), np.full((COUNT, 1), 0.6), axis=1)  # above the floor
angle = rng.uniform(0, 2 * np.pi, COUNT)
i, j = np.triu_indices(COUNT, 1)
for step in range(3000):
    turn = np.stack([0 * angle, 0 * angle, np.sin(angle / 2), np.cos(angle / 2)], axis=1)
    pairs = query.overlap(part, part, (place[i], turn[i]), (place[j], turn[j]))
    walls = query.overlap(tray, part, None, (place, turn))
    shared = pairs["volume"].sum() + walls["volume"].sum()
    if shared < 1e-4 * COUNT * part.volume:
        break
    force, torque, stiffness = walls["force"].copy(), walls["torque"].copy(), walls["stiffness"].copy()
    overlap = walls["volume"].copy()
    arm = np.cross(place[j] - place[i], pairs["force"])
    for body, sign, moment in ((j, 1, pairs["torque"]), (i, -1, pairs["torque"] + arm)):
        np.add.at(force, body, sign * pairs["force"])
        np.add.at(torque, body, sign * moment)
        np.add.at(stiffness, body, pairs["stiffness"])
        np.add.at(overlap, body, pairs["volume"])
    # A force over its stiffness is a way. Noise, the more the deeper, helps out of dead ends.
    noise = 0.03 * rng.normal(size=(COUNT, 3)) * np.sqrt(overlap / part.volume)[:, None]
    place[:, :2] += (0.5 * force / (stiffness[:, None] + 1e-6) + noise)[:, :2]
    place[:, :2] = np.clip(place[:, :2], -0.65, 0.65)  # not out through the walls
    angle += 0.5 * torque[:, 2] / (0.05 * stiffness + 1e-6) + noise[:, 2]
print(
    f"after {step} steps {COUNT} brackets share {100 * shared / (COUNT * part.volume):.3f} % of their volume with others"
)

image = Image.new("RGB", (640, 640), "white")
draw = ImageDraw.Draw(image)
for k in range(COUNT):
    c, s = np.cos(angle[k]), np.sin(angle[k])
    seen = part.vertices[:, :2] @ np.array([[c, s], [-s, c]]) + place[k, :2]
    for face in part.faces:
        draw.polygon([tuple(q) for q in (320 + 380 * seen[face]).tolist()], fill=(60 + 12 * k, 160, 230 - 12 * k))
draw.rectangle([320 - 380 * 0.8] * 2 + [320 + 380 * 0.8] * 2, outline="black", width=2)
image.save("nesting.png")
