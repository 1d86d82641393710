"""The meshes of the scenes. Each function makes one from the sizes that a scene gives: {"mesh": {"torus": [1, 0.25]}}."""

import math
import pathlib
import subprocess
import tempfile

import numpy as np
import trimesh

tool = "innersphere"  # the program that has the named solids; set by whoever prepares scenes


def solid(name: str, scale: float = 1) -> trimesh.Trimesh:
    """One of InnerSphere's named solids, in its own frame."""
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / "solid.obj"
        subprocess.run([tool, "convert", name, str(path), "--quiet"], check=True)
        return trimesh.load(path, force="mesh", process=True).apply_scale(scale)


def box(x: float, y: float, z: float) -> trimesh.Trimesh:
    return trimesh.creation.box((x, y, z))


def ball(radius: float, subdivisions: int = 4) -> trimesh.Trimesh:
    return trimesh.creation.icosphere(subdivisions=subdivisions, radius=radius)


def torus(ring: float, tube: float, around: int = 64, sections: int = 32) -> trimesh.Trimesh:
    """Its axis is z; `ring` is the radius of its centre line."""
    return trimesh.creation.torus(ring, tube, major_sections=around, minor_sections=sections)


def cylinder(radius: float, length: float, sections: int = 128) -> trimesh.Trimesh:
    return trimesh.creation.cylinder(radius, length, sections=sections)


def plate(outer: float, hole: float, thickness: float, around: int = 128) -> trimesh.Trimesh:
    """A disc with a hole, centred; the polygon of the hole is around the circle that is meant."""
    return trimesh.creation.annulus(hole / math.cos(math.pi / around), outer, thickness, sections=around)


def _prism(outline: list, height: float, holes: list = ()) -> trimesh.Trimesh:
    """Centred along z."""
    import shapely

    mesh = trimesh.creation.extrude_polygon(shapely.Polygon(outline, holes), height)
    mesh.apply_translation([0, 0, -height / 2])
    return mesh


def frame(outer: float, hole: float, thickness: float) -> trimesh.Trimesh:
    """A square plate with a square hole, centred; edges of both [m]."""
    return _prism(_square(outer), thickness, [_square(hole)])


def _square(edge: float) -> list:
    return [(-edge / 2, -edge / 2), (edge / 2, -edge / 2), (edge / 2, edge / 2), (-edge / 2, edge / 2)]


def wedge(inner: float, outer: float, angle: float, depth: float) -> trimesh.Trimesh:
    """A stone of an arch: a sector of a ring about the origin with plane faces, upright, as deep along y. Degrees."""
    s, c = math.sin(math.radians(angle / 2)), math.cos(math.radians(angle / 2))
    mesh = _prism([(-inner * s, inner * c), (-outer * s, outer * c), (outer * s, outer * c), (inner * s, inner * c)], depth)
    return _upright(mesh)


def _upright(mesh: trimesh.Trimesh) -> trimesh.Trimesh:
    """Turns the y axis up."""
    return mesh.apply_transform(trimesh.transformations.rotation_matrix(math.pi / 2, [1, 0, 0]))


def gear(teeth: int, pitch: float = 0.18, tooth: float = 0.05, bore: float = 0.15, thick: float = 0.2) -> trimesh.Trimesh:
    """A spur gear with a gap between teeth at angle 0. `pitch` is along the pitch circle, `tooth` half a tooth's height."""
    radius = pitch * teeth / (2 * math.pi)
    corners = [(-0.22, -tooth), (0, -tooth), (0.22, -tooth), (0.4, tooth), (0.5, tooth), (0.6, tooth)]
    outline = [((radius + height) * math.cos(2 * math.pi * (i + part) / teeth),
                (radius + height) * math.sin(2 * math.pi * (i + part) / teeth))
               for i in range(teeth) for part, height in corners]
    hole = [(bore * math.cos(a), bore * math.sin(a)) for a in np.linspace(0, 2 * math.pi, 64, endpoint=False)]
    return _prism(outline, thick, [hole])


def bowl(outer: float = 0.5, inner: float = 0.42, around: int = 96) -> trimesh.Trimesh:
    """Half a spherical shell with a round rim, open upwards, the centre of the spheres at the origin."""
    rim = (outer - inner) / 2
    profile = [(outer * math.cos(a), outer * math.sin(a)) for a in np.linspace(-math.pi / 2, 0, 31)[:-1]]
    profile += [(outer - rim + rim * math.cos(a), rim * math.sin(a)) for a in np.linspace(0, math.pi, 11)[:-1]]
    profile += [(inner * math.cos(a), inner * math.sin(a)) for a in np.linspace(0, -math.pi / 2, 31)]
    profile[0], profile[-1] = (0, -outer), (0, -inner)
    return _lathe(profile, around)


def _lathe(profile: list, around: int) -> trimesh.Trimesh:
    mesh = trimesh.creation.revolve(np.array(profile), sections=around)
    mesh.merge_vertices()
    mesh.update_faces(mesh.nondegenerate_faces())
    mesh.fix_normals()
    return mesh


def half_pipe(inner: float, wall: float, length: float, facets: int = 360) -> trimesh.Trimesh:
    """The lower half of a pipe along y, its centre line through the origin."""
    angles = np.linspace(math.pi, 2 * math.pi, facets + 1)
    inside = [(inner * math.cos(a), inner * math.sin(a)) for a in angles]
    outside = [((inner + wall) * math.cos(a), (inner + wall) * math.sin(a)) for a in angles]
    return _upright(_prism(inside + outside[::-1], length))


def t_slot(length: float = 0.3) -> trimesh.Trimesh:
    """A C-shaped rail along y; lips of 0.06 m leave a gap of 0.12 m at the bottom."""
    outline = [(0.06, 0), (0.24, 0), (0.24, 0.2), (-0.24, 0.2), (-0.24, 0), (-0.06, 0), (-0.06, 0.06), (-0.16, 0.06)]
    return _upright(_prism(outline + [(-0.16, 0.14), (0.16, 0.14), (0.16, 0.06), (0.06, 0.06)], length))


def t_slider(length: float = 0.3) -> trimesh.Trimesh:
    """A T that hangs on the lips of t_slot(): its flange is above them."""
    return _upright(_prism([(-0.05, -0.1), (0.05, -0.1), (0.05, 0.06), (0.15, 0.06), (0.15, 0.12), (-0.15, 0.12), (-0.15, 0.06),
                            (-0.05, 0.06)], length))


def mug(radius: float = 0.04, height: float = 0.1, wall: float = 0.005) -> trimesh.Trimesh:
    """Stands on z = 0, with a handle in the yz plane."""
    cup = _lathe([(0, 0), (radius, 0), (radius, height), (radius - wall, height), (radius - wall, 0.008), (0, 0.008)], 48)
    handle = trimesh.creation.torus(0.028, 0.005, major_sections=32, minor_sections=12)
    handle.apply_transform(trimesh.transformations.rotation_matrix(math.pi / 2, [0, 1, 0]))
    handle.apply_translation([0, radius - 0.0025, height / 2])
    inside = trimesh.creation.cylinder(radius - wall / 2, 2 * height, sections=48)
    return trimesh.boolean.union([cup, trimesh.boolean.difference([handle, inside])])


def brick(columns: int = 4, rows: int = 2, pitch: float = 0.08, clearance: float = 0.001) -> trimesh.Trimesh:
    """A building brick, ten times as large: studs above, a hollow below whose walls the studs of another fit between."""
    x, y, high, stud, rise = columns * pitch, rows * pitch, 0.096, 0.024, 0.018
    room = pitch - 2 * stud - 2 * clearance  # twice the wall's thickness
    body = trimesh.creation.box((x, y, high))
    hollow = trimesh.creation.box((x - room, y - room, high))
    hollow.apply_translation([0, 0, -0.012])
    studs = []
    for i in range(columns):
        for j in range(rows):
            studs.append(trimesh.creation.cylinder(stud, 2 * rise, sections=32))
            studs[-1].apply_translation([(i - (columns - 1) / 2) * pitch, (j - (rows - 1) / 2) * pitch, high / 2])
    return trimesh.boolean.difference([trimesh.boolean.union([body, *studs]), hollow])


def make(description: dict) -> trimesh.Trimesh:
    """Calls the one generator that a description names. Raises ValueError if the mesh is not closed."""
    (name, sizes), = description.items()
    generators = (solid, box, ball, torus, cylinder, plate, frame, wedge, gear, bowl, half_pipe, t_slot, t_slider, mug, brick)
    generator = {g.__name__: g for g in generators}[name]
    mesh = generator(*(sizes if isinstance(sizes, list) else [sizes]))
    if not mesh.is_watertight or mesh.volume <= 0:
        raise ValueError(f"the mesh of {description} does not bound a volume")
    return mesh
