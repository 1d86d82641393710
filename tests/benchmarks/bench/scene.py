"""Reads the scenes, and prepares what all engines get: meshes in the bodies' own frames, masses, inertia, places.

A scene file says, in SI units:
  about     one sentence
  seconds   how long it runs
  friction  Coulomb's coefficient of all pairs
  ground    height of a fixed plane; without it there is none
  fall      a height that the energy from nowhere is compared with: that of all moving bodies falling by it
  bodies    each with a `name`, and a `mesh` (see meshes.py) or a `box` (its edges); `density` or `fixed`; `at`, the places of
            the mesh's frame, one body for each, and `turn`, as many rotations or fewer, used in turn: [x, y, z, degrees];
            `hinge` {axis, speed, torque, damping}: on the world, at the centre of mass, with a motor [rad/s, N m] or a load
            [N m s]; `path`: where it is told to be, [t, x, y, z] from the start, straight in between; `force`: at the centre of
            mass, [t, x, y, z] from then on
  truths    each with a `quantity` of quantities.py and what that wants to know, `expected`, `tolerance` (or `at_most`), `source`
"""

import hashlib
import json
import pathlib
import subprocess

import numpy as np
import trimesh
from scipy.spatial.transform import Rotation

from . import meshes

folder = pathlib.Path(__file__).parent / "scenes"


def names() -> list[str]:
    return sorted(path.stem for path in folder.glob("*.json"))


def load(name: str) -> dict:
    return json.loads((folder / f"{name}.json").read_text())


# What a mesh and its convex parts are made by: files are named by it, too, so that others are made when it changes.
_SOURCES = [pathlib.Path(source).read_text() for source in (meshes.__file__, __file__)]


class Assets:
    """Makes what engines need of a mesh, once: files in `folder`, named by what they are of."""

    def __init__(self, folder: pathlib.Path, spheres: int = 1000) -> None:
        self.folder, self.spheres = folder.resolve(), spheres
        folder.mkdir(parents=True, exist_ok=True)

    def _file(self, description: dict) -> pathlib.Path:
        key = hashlib.sha1(json.dumps([description, *_SOURCES]).encode()).hexdigest()[:12]
        return self.folder / f"{next(iter(description))}-{key}.json"

    def of(self, description: dict) -> dict:
        """The mesh in its principal frame as OBJ, its packing, its convex parts, and its mass properties at density 1."""
        return json.loads(self._file(description).read_text())

    def make(self, description: dict) -> None:
        """Makes what of() tells: the packing anew, as the packer may have changed, the others if they are not there."""
        path = self._file(description)
        if not path.exists():
            path.write_text(json.dumps(self._make(description, path.with_suffix(""))))
        made = self.of(description)
        subprocess.run([meshes.tool, "pack", made["mesh"], "--spheres", str(self.spheres), "-o", made["packing"], "--force", "--quiet"],
                       check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)

    def _make(self, description: dict, stem: pathlib.Path) -> dict:
        mesh = meshes.make(description)
        frame = _principal_frame(mesh)
        mesh.apply_transform(np.linalg.inv(frame))
        surface = f"{stem}.obj"
        mesh.export(surface, digits=9)
        hulls = []
        for i, part in enumerate(_convex_parts(mesh)):
            hulls.append(f"{stem}-hull-{i}.obj")
            part.export(hulls[-1], digits=9)
        return {"mesh": surface, "packing": f"{stem}.cbor", "hulls": hulls, "volume": mesh.volume,
                "inertia": np.diag(mesh.moment_inertia).tolist(), "frame": frame.tolist(),
                "size": float(np.linalg.norm(np.ptp(mesh.bounds, axis=0))), "vertices": len(mesh.vertices)}


def _principal_frame(mesh: trimesh.Trimesh) -> np.ndarray:
    """The pose of the principal frame in that of the mesh. No rotation where the axes are principal as they are."""
    inertia = mesh.moment_inertia
    frame = np.eye(4)
    frame[:3, 3] = mesh.center_mass
    if np.abs(inertia - np.diag(np.diag(inertia))).max() > 1e-6 * inertia.max():
        axes = np.linalg.eigh(inertia)[1]
        frame[:3, :3] = axes * np.sign(np.linalg.det(axes))
    return frame


def _convex_parts(mesh: trimesh.Trimesh) -> list[trimesh.Trimesh]:
    """CoACD's, finer than its default of 0.05: threads and teeth ask for it. A convex mesh is its own part."""
    if mesh.is_convex:
        return [mesh.convex_hull]
    try:
        import coacd
    except ImportError:
        return []
    coacd.set_log_level("error")
    parts = coacd.run_coacd(coacd.Mesh(mesh.vertices, mesh.faces), threshold=0.02, seed=1)
    return [trimesh.Trimesh(vertices, faces) for vertices, faces in parts]


def prepare(name: str, assets: Assets) -> dict:
    """The scene with one entry for each body, in numbers and files. Places are those of the centre of mass."""
    scene = load(name)
    bodies = []
    for description in scene["bodies"]:
        for i, place in enumerate(description["at"]):
            bodies.append(_body(description, i, place, assets))
    return {"name": name, "seconds": scene["seconds"], "friction": scene["friction"], "ground": scene.get("ground"),
            "fall": scene.get("fall"), "truths": scene["truths"], "bodies": bodies}


def _body(description: dict, index: int, place: list[float], assets: Assets) -> dict:
    turns = description.get("turn", [[0, 0, 1, 0]])
    x, y, z, degrees = turns[index % len(turns)]
    axis = np.array([x, y, z]) / np.linalg.norm([x, y, z])
    frame = np.eye(4)
    frame[:3, :3] = Rotation.from_rotvec(np.radians(degrees) * axis).as_matrix()
    frame[:3, 3] = place
    if "box" in description:
        made = _box(description["box"])
    else:
        made = assets.of(description["mesh"])
    pose = frame @ np.array(made["frame"])
    several = len(description["at"]) > 1
    mass = 0 if description.get("fixed") or "path" in description else description["density"] * made["volume"]
    body = {key: made[key] for key in ("mesh", "box", "packing", "hulls", "size") if key in made}
    body |= {key: description[key] for key in ("hinge", "path", "force") if key in description}
    return body | {"name": f"{description['name']}.{index}" if several else description["name"],
                   "mass": mass, "inertia": [mass / made["volume"] * moment for moment in made["inertia"]],
                   "position": pose[:3, 3].tolist(), "rotation": Rotation.from_matrix(pose[:3, :3]).as_quat().tolist(),
                   "mesh_frame": np.linalg.inv(made["frame"]).tolist()}


def _box(edges: list[float]) -> dict:
    x, y, z = edges
    volume = x * y * z
    return {"box": edges, "volume": volume, "frame": np.eye(4).tolist(), "size": float(np.linalg.norm(edges)),
            "inertia": [volume / 12 * (y * y + z * z), volume / 12 * (x * x + z * z), volume / 12 * (x * x + y * y)]}


def path_at(path: list[list[float]], time: float) -> tuple[np.ndarray, np.ndarray]:
    """How far along its path a body is at a time [m], and how fast it goes [m/s]."""
    times, ways = np.array(path)[:, 0], np.array(path)[:, 1:]
    way = np.array([np.interp(time, times, ways[:, k]) for k in range(3)])
    i = np.searchsorted(times, time, side="right")
    if i == 0 or i == len(times):
        return way, np.zeros(3)
    return way, (ways[i] - ways[i - 1]) / (times[i] - times[i - 1])


def force_at(force: list[list[float]], time: float) -> np.ndarray:
    """The force on a body at a time [N]."""
    now = [entry for entry in force if entry[0] <= time + 1e-9]
    return np.array(now[-1][1:] if now else [0, 0, 0], dtype=float)
