"""Overlaps of solids against closed forms: volume, centroid, gradient of the volume, and depth where that is what is told."""

import csv
import importlib.metadata
import math
import pathlib
import tempfile
import time
from collections.abc import Callable

import numpy as np
import trimesh

from . import meshes
from .engines.pybullet_shipped import vhacd

FIELDS = ["engine", "version", "case", "quantity", "expected", "measured", "error", "holds", "ms"]
# Errors: of a volume relative, of a centroid over the solid's size, of a gradient and a depth over the true one.
TOLERANCES = {"volume": 0.02, "centroid": 0.01, "gradient": 0.05, "depth": 0.02}


class Case:
    """Two meshes, the second moved, and what is true of their overlap."""

    def __init__(self, name: str, a: dict, b: dict, shift: list[float], volume: float, centroid: list[float],
                 gradient: list[float], depth: float | None = None) -> None:
        self.name, self.shift = name, np.array(shift, dtype=float)
        self.a, self.b = meshes.make(a), meshes.make(b)
        self.size = float(np.linalg.norm(np.ptp(self.a.bounds, axis=0)))
        # The gradient is that of the volume as b moves.
        self.truth = {"volume": volume, "centroid": np.array(centroid), "gradient": np.array(gradient), "depth": depth}


def cases() -> list[Case]:
    r, d = 0.5, 0.6
    ball = {"ball": [r, 5]}
    lens = math.pi * (4 * r + d) * (2 * r - d) ** 2 / 12
    # The part of a torus below a plane at height h: a circular segment, turned.
    ring, tube, h = 1.0, 0.25, -0.1
    half = math.acos(-h / tube)  # of the angle that the segment is seen under
    segment = tube**2 * (half - math.sin(half) * math.cos(half))
    below = -2 / 3 * (tube * math.sin(half)) ** 3 / segment  # of its centroid
    return [
        Case("two balls", ball, ball, [d, 0, 0], lens, [d / 2, 0, 0], [-math.pi * (r * r - d * d / 4), 0, 0], 2 * r - d),
        Case("two boxes", {"box": [1, 1, 1]}, {"box": [1, 1, 1]}, [0.7, 0.6, 0.5], 0.3 * 0.4 * 0.5, [0.35, 0.3, 0.25],
             [-0.4 * 0.5, -0.3 * 0.5, -0.3 * 0.4], 0.3),
        Case("ball in a box", {"box": [2, 2, 2]}, ball, [0.2, 0.1, 0], 4 / 3 * math.pi * r**3, [0.2, 0.1, 0], [0, 0, 0]),
        Case("torus, partly under a plane", {"torus": [ring, tube, 256, 128]}, {"box": [4, 4, 2]}, [0, 0, h - 1],
             2 * math.pi * ring * segment, [0, 0, below], [0, 0, 4 * math.pi * ring * tube * math.sin(half)], tube + h),
        # The bar is 0.05 in one wall of the hole.
        Case("bar in a square hole", {"frame": [2, 0.8, 0.5]}, {"box": [0.7, 0.7, 2]}, [0.1, 0, 0], 0.05 * 0.7 * 0.5, [0.425, 0, 0],
             [0.7 * 0.5, 0, 0], 0.05),
    ]


def _differences(volume: Callable[[np.ndarray], float], shift: np.ndarray, step: float = 1e-3) -> np.ndarray:
    """The gradient, for those who tell volumes only."""
    return np.array([(volume(shift + step * e) - volume(shift - step * e)) / (2 * step) for e in np.eye(3)])


def _timed(ask: Callable[[], object]) -> tuple[object, float]:
    """What it answers, and the median time of five [s], after one that is not counted."""
    answer, times = ask(), []
    for _ in range(5):
        start = time.perf_counter()
        ask()
        times.append(time.perf_counter() - start)
    return answer, float(np.median(times))


def _packings(case: Case, estimator: str) -> dict:
    import innersphere

    packings = [innersphere.pack((np.asarray(m.vertices), np.asarray(m.faces)), spheres=1000) for m in (case.a, case.b)]
    query, pose = innersphere.Query(), (case.shift, [0, 0, 0, 1])
    found, spent = _timed(lambda: query.overlap(packings[0], packings[1], pose_b=pose, estimator=estimator))
    return {"volume": float(found["volume"]), "centroid": np.array(found["centroid"]),
            "gradient": -np.array(found["area"]), "seconds": spent}


def _innersphere(case: Case) -> dict:
    return _packings(case, "volume_true")


def _innersphere_surface(case: Case) -> dict:
    return _packings(case, "surface")


def _evaluated(solid):
    solid.volume()  # until then it has not begun
    return solid


def _manifold(case: Case) -> dict:
    import manifold3d

    solids = [manifold3d.Manifold(manifold3d.Mesh(np.asarray(m.vertices, np.float32), np.asarray(m.faces, np.uint32)))
              for m in (case.a, case.b)]
    common, spent = _timed(lambda: _evaluated(solids[0] ^ solids[1].translate(case.shift.tolist())))
    volume = common.volume()
    made = common.to_mesh()
    mesh = trimesh.Trimesh(made.vert_properties[:, :3], made.tri_verts)
    return {"volume": volume, "centroid": mesh.center_mass, "seconds": spent,
            "gradient": _differences(lambda s: (solids[0] ^ solids[1].translate(s.tolist())).volume(), case.shift)}


def _trimesh(case: Case) -> dict:
    def common(shift: np.ndarray) -> trimesh.Trimesh:
        return trimesh.boolean.intersection([case.a, case.b.copy().apply_translation(shift)])

    mesh, spent = _timed(lambda: common(case.shift))
    return {"volume": mesh.volume, "centroid": mesh.center_mass, "seconds": spent,
            "gradient": _differences(lambda s: common(s).volume, case.shift)}


# FCL and Coal tell the depth of pairs of triangles; the largest is taken.
def _fcl(case: Case) -> dict:
    import fcl

    objects = []
    for mesh, shift in ((case.a, np.zeros(3)), (case.b, case.shift)):
        model = fcl.BVHModel()
        model.beginModel(len(mesh.vertices), len(mesh.faces))
        model.addSubModel(mesh.vertices, mesh.faces)
        model.endModel()
        objects.append(fcl.CollisionObject(model, fcl.Transform(shift)))

    def ask() -> list:
        result = fcl.CollisionResult()
        fcl.collide(*objects, fcl.CollisionRequest(num_max_contacts=1000, enable_contact=True), result)
        return result.contacts

    contacts, spent = _timed(ask)
    return {"depth": max((c.penetration_depth for c in contacts), default=0.0), "seconds": spent}


def _coal(case: Case) -> dict:
    import coal

    models = []
    for mesh in (case.a, case.b):
        model = coal.BVHModelOBBRSS()
        model.beginModel(len(mesh.faces), len(mesh.vertices))
        corners, faces = coal.StdVec_Vec3s(), coal.StdVec_Triangle()
        corners.extend([np.array(v, dtype=np.float64) for v in mesh.vertices])
        faces.extend([coal.Triangle(*map(int, face)) for face in mesh.faces])
        model.addSubModel(corners, faces)
        model.endModel()
        models.append(model)
    request = coal.CollisionRequest(coal.CollisionRequestFlag.CONTACT, 1000)

    def ask() -> list:
        result = coal.CollisionResult()
        coal.collide(models[0], coal.Transform3s(), models[1], coal.Transform3s(np.eye(3), case.shift), request, result)
        return list(result.getContacts())

    contacts, spent = _timed(ask)
    return {"depth": max((-c.penetration_depth for c in contacts), default=0.0), "seconds": spent}


def _pybullet(case: Case, parts: bool) -> dict:
    """The depth that getContactPoints() tells, of convex hulls, or of the parts that vhacd() makes with its defaults."""
    import pybullet as p

    client = p.connect(p.DIRECT)
    with tempfile.TemporaryDirectory() as folder:
        for name, mesh, shift in (("a", case.a, np.zeros(3)), ("b", case.b, case.shift)):
            file = f"{folder}/{name}.obj"
            mesh.export(file)
            if parts:
                vhacd(file, file := f"{folder}/{name}-parts.obj")
            shape = p.createCollisionShape(p.GEOM_MESH, fileName=file)
            p.createMultiBody(1, shape, basePosition=shift.tolist())
    contacts, spent = _timed(lambda: p.getClosestPoints(0, 1, 0))
    p.disconnect(client)
    return {"depth": max((-c[8] for c in contacts), default=0.0), "seconds": spent}


def _pybullet_hulls(case: Case) -> dict:
    return _pybullet(case, parts=False)


def _pybullet_vhacd(case: Case) -> dict:
    return _pybullet(case, parts=True)


# The package of PyPI that each is, and what asks it.
PEERS = {"innersphere": ("innersphere", _innersphere), "innersphere, surface": ("innersphere", _innersphere_surface), "manifold3d": ("manifold3d", _manifold), "trimesh": ("trimesh", _trimesh),
         "python-fcl": ("python-fcl", _fcl), "coal": ("coal", _coal), "pybullet, hulls": ("pybullet", _pybullet_hulls),
         "pybullet, V-HACD": ("pybullet", _pybullet_vhacd)}


def _version(package: str) -> str:
    if package == "innersphere":
        import innersphere

        return innersphere.__version__
    return importlib.metadata.version(package)


def _rows(name: str, version: str, case: Case, found: dict) -> list[dict]:
    rows = []
    for quantity in TOLERANCES:
        if quantity not in found or case.truth[quantity] is None:
            continue
        truth, measured = case.truth[quantity], found[quantity]
        scale = {"centroid": case.size, "gradient": np.linalg.norm(truth) or case.size**2}.get(quantity, truth)
        error = float(np.linalg.norm(np.asarray(measured) - np.asarray(truth)) / scale)
        numbers = [" ".join(f"{x:.5g}" for x in np.atleast_1d(value)) for value in (truth, measured)]
        rows.append({"engine": name, "version": version, "case": case.name, "quantity": quantity, "expected": numbers[0],
                     "measured": numbers[1], "error": f"{error:.4g}", "holds": error <= TOLERANCES[quantity],
                     "ms": f"{1e3 * found['seconds']:.4g}"})
    return rows


def write(folder: pathlib.Path) -> None:
    """Asks all that are here, and writes overlaps.csv."""
    rows = []
    for name, (package, ask) in PEERS.items():
        try:
            version = _version(package)
        except (ImportError, importlib.metadata.PackageNotFoundError):
            continue
        for case in cases():
            rows += _rows(name, version, case, ask(case))
    with (folder / "overlaps.csv").open("w", newline="") as file:
        writer = csv.DictWriter(file, FIELDS)
        writer.writeheader()
        writer.writerows(rows)
