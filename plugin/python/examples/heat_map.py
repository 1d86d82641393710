"""A million poses of two parts, as a picture: how much they overlap wherever one is put beside the other."""

import numpy as np
from PIL import Image

import innersphere

POSES = 1000  # along each axis
gear = innersphere.pack(innersphere.solid("gear"), spheres=1000, cache="packings", overlap_errors=False)
query = innersphere.Query()
at = np.linspace(-1.2, 1.2, POSES)
rows = []
for y in at:  # a row of the picture in a call
    places = np.stack([at, np.full(POSES, y), np.zeros(POSES)], axis=1)
    rows.append(query.overlap(gear, gear, pose_b=(places, [0, 0, 0, 1]), want="volume")["volume"])
volume = np.array(rows)
share = np.sqrt(volume / gear.volume)  # shallow overlaps show, too
colours = np.stack([share, share**3, 0.25 * (share > 0) + 0.75 * share**8], axis=2)
Image.fromarray((255 * np.clip(colours, 0, 1)).astype(np.uint8)).save("heat_map.png")
free = volume == 0
print(f"{volume.size:,} poses; the gears are free of each other in {100 * free.mean():.1f} % of them")
