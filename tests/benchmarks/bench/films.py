"""Short films of a scene in all engines, side by side."""

import pathlib

import numpy as np
import trimesh
from PIL import Image, ImageDraw

from .recording import Recording, read_scene

FILMS = (("arch", 60), ("stack", 60))  # few triangles each: they are drawn one by one
_SIDE, _FRAMES = 150, 24  # [pixels] of a picture, and how many there are
_COLOURS = [(229, 178, 69), (98, 146, 178), (178, 98, 98), (120, 160, 100), (150, 120, 170)]


def _camera(points: np.ndarray) -> np.ndarray:
    """Seen along y, a little from above and the side."""
    a, b = np.radians(25), np.radians(15)
    x = points @ [np.cos(a), np.sin(a), 0]
    depth = points @ [-np.sin(a), np.cos(a), 0]
    return np.stack([x, points[:, 2] * np.cos(b) + depth * np.sin(b), depth * np.cos(b) - points[:, 2] * np.sin(b)], axis=1)


def _draw(recording: Recording, meshes: list, step: int, low: np.ndarray, scale: float, title: str) -> Image.Image:
    image = Image.new("RGB", (_SIDE, _SIDE), "white")
    draw = ImageDraw.Draw(image)
    faces = []
    for i, mesh in enumerate(meshes):
        seen = _camera(recording.rotations(i)[step].apply(np.array(mesh.vertices)) + recording.position[step, i])
        normals = recording.rotations(i)[step].apply(np.array(mesh.face_normals))
        for triangle, normal in zip(mesh.faces, normals):
            light = 0.55 + 0.45 * max(0.0, float(normal @ [0.3, -0.6, 0.74]))
            colour = tuple(int(c * light) for c in _COLOURS[i % len(_COLOURS)])
            faces.append((-seen[triangle, 2].mean(), seen[triangle, :2], colour))
    for _, corners, colour in sorted(faces, key=lambda face: face[0]):
        draw.polygon([((x - low[0]) * scale, _SIDE - 4 - (z - low[1]) * scale) for x, z in corners], fill=colour)
    draw.text((3, 2), title, fill="black")
    return image


def _film(folder: pathlib.Path, name: str, rate: int, engines: list[str]) -> str:
    prepared = read_scene(folder / "scenes" / f"{name}.json")
    meshes = [trimesh.load(body["mesh"], process=False) for body in prepared["bodies"]]
    recordings = {}
    for engine in engines:
        file = folder / "runs" / f"{engine}-{name}-{rate}.f64"
        if file.exists():
            try:
                recordings[engine] = Recording.read(prepared, rate, file)
            except ValueError:
                continue
    if not recordings:
        return ""
    first = next(iter(recordings.values()))
    seen = np.vstack([_camera(first.rotations(i)[0].apply(np.array(m.vertices)) + first.position[0, i]) for i, m in enumerate(meshes)])
    low, high = seen[:, :2].min(0), seen[:, :2].max(0)
    scale = 0.8 * _SIDE / (high - low).max()
    low = np.array([(low[0] + high[0] - _SIDE / scale) / 2, low[1]])
    columns = min(len(recordings), 4)
    frames = []
    for k in range(_FRAMES):
        sheet = Image.new("RGB", (columns * _SIDE, -(-len(recordings) // columns) * _SIDE), "white")
        for i, (engine, recording) in enumerate(recordings.items()):
            step = round(k / (_FRAMES - 1) * recording.steps)
            sheet.paste(_draw(recording, meshes, step, low, scale, engine), (i % columns * _SIDE, i // columns * _SIDE))
        frames.append(sheet.quantize(32))
    file = f"bench-{name}.gif"
    frames[0].save(folder / file, save_all=True, append_images=frames[1:], duration=120, loop=0)
    return file


def write(folder: pathlib.Path, results) -> list[tuple[str, str]]:
    """Makes films of the scenes that were run, and returns their files and what they show."""
    made = []
    for name, rate in FILMS:
        if name in results.scenes and rate in results.rates:
            file = _film(folder, name, rate, results.engines)
            if file:
                made.append((file, f"{name} at {rate} steps a second in all engines"))
    return made
