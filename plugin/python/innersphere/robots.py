"""Robots' files in, spheres out: for planners, other engines and particle codes.

    import innersphere.robots as robots

    arm = robots.spheres_of_urdf("arm.urdf", spheres=32, cover=True)  # by link
    robots.write_curobo("arm.yml", arm)
    robots.write_urdf("arm_spheres.urdf", "arm.urdf", arm)

Files that are there are replaced only with overwrite=True. They appear when they are complete.
"""

from __future__ import annotations

import copy
import json
import os
import xml.etree.ElementTree as ET
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ._core import Packing
from ._covering import Spheres, spheres_of
from ._errors import FileMissingError, FileThereError, FormatError, InvalidArgumentError, WriteError
from ._pack import pack

__all__ = [
    "Spheres",
    "spheres_of",
    "spheres_of_urdf",
    "write_curobo",
    "write_dem_engine",
    "write_liggghts",
    "write_mjcf",
    "write_srdf",
    "write_urdf",
]

Array = NDArray[np.float64]
_ROUND_PARTS = 64  # sides of a cylinder


def spheres_of_urdf(
    urdf: str | os.PathLike[str],
    *,
    spheres: int = 64,
    cover: bool = False,
    packages: Mapping[str, str | os.PathLike[str]] | None = None,
    **options: Any,
) -> dict[str, Spheres]:
    """Packs what each link of a robot collides with: meshes as they are, hollow or not, boxes, cylinders and balls.

    spheres: for each collision element; a ball has one.
    cover: whether they cover the surface, as in spheres_of(); else they lie inside.
    packages: folders that ``package://NAME`` stands for.
    options: those of innersphere.pack(), such as cache and repair. order is "coverage" for a cover, as with
        `innersphere pack --cover`: spheres that are chosen by radius make covers that reach out up to four times as far.

    Returns the spheres of each link that collides, in the frame of the link. Raises FormatError, which names the link, for
    what is no URDF or has a shape that is none of these; FileMissingError; and what pack() raises.
    """
    tree = _parsed(urdf)
    options = {"overlap_errors": False, "order": "coverage" if cover else "radius", **options}
    found = {}
    for link in tree.getroot().iter("link"):
        name = link.get("name") or ""
        parts = [
            _element(element, name, os.path.dirname(os.fspath(urdf)), packages or {}, spheres, cover, options)
            for element in link.findall("collision")
        ]
        if parts:
            found[name] = Spheres(np.concatenate([p.spheres for p in parts]), max(p.overhang for p in parts))
    return found


def _parsed(path: str | os.PathLike[str]) -> ET.ElementTree[Any]:
    try:
        tree = ET.parse(path, ET.XMLParser(target=ET.TreeBuilder(insert_comments=True)))
    except ET.ParseError as error:
        raise FormatError(f"{os.fspath(path)}: {error}") from None
    except OSError as error:
        raise FileMissingError(f"cannot open {os.fspath(path)}: {error.strerror}") from None
    if tree.getroot().tag != "robot":
        raise FormatError(f"{os.fspath(path)} is no URDF: it begins with <{tree.getroot().tag}>")
    return tree


def _numbers(element: ET.Element | None, name: str, count: int, default: str | None, where: str) -> Array:
    text = default if element is None else element.get(name, default)
    try:
        numbers = np.array([float(word) for word in (text or "").split()])
    except ValueError:
        numbers = np.empty(0)
    if numbers.shape != (count,) or not np.isfinite(numbers).all():
        raise FormatError(f"{where}: {name} is {text!r}; it must be {count} numbers")
    return numbers


def _element(
    element: ET.Element, link: str, folder: str, packages: Any, spheres: int, cover: bool, options: dict[str, Any]
) -> Spheres:
    """The spheres of a <collision>, in the frame of its link."""
    where = f"link {link!r}"
    shape = next((one for one in element.iterfind("geometry/*") if isinstance(one.tag, str)), None)  # no comment
    if shape is None:
        raise FormatError(f"{where} has a collision without a geometry")
    if shape.tag == "sphere":
        radius = _numbers(shape, "radius", 1, None, where)
        found = Spheres(np.append(np.zeros(3), radius)[None], 0.0)
    else:
        found = spheres_of(_packed(shape, where, folder, packages, cover, {**options, "spheres": spheres}), cover=cover)
    origin = element.find("origin")
    balls = found.spheres.copy()
    turn = _rotation(_numbers(origin, "rpy", 3, "0 0 0", where))
    balls[:, :3] = balls[:, :3] @ turn.T + _numbers(origin, "xyz", 3, "0 0 0", where)
    return Spheres(balls, found.overhang)


def _packed(shape: ET.Element, where: str, folder: str, packages: Any, cover: bool, options: dict[str, Any]) -> Packing:
    if shape.tag == "mesh":
        scale = _numbers(shape, "scale", 3, "1 1 1", where)
        return pack(_file(shape.get("filename") or "", where, folder, packages), scale=scale.tolist(), **options)
    if shape.tag == "box":
        half = _numbers(shape, "size", 3, None, where) / 2
        corners = np.array([[i & 1, i >> 1 & 1, i >> 2] for i in range(8)]) * 2 - 1
        faces = [[0, 2, 1], [1, 2, 3], [4, 5, 6], [5, 7, 6], [0, 1, 4], [1, 5, 4], [2, 6, 3], [3, 6, 7], [0, 4, 2]]
        return pack((corners * half, [*faces, [2, 4, 6], [1, 3, 5], [3, 7, 5]]), **options)
    if shape.tag == "cylinder":
        radius, length = (_numbers(shape, name, 1, None, where)[0] for name in ("radius", "length"))
        # The prism lies in the cylinder, or it is around it.
        return pack(_prism(radius / np.cos(np.pi / _ROUND_PARTS) if cover else radius, length), **options)
    raise FormatError(f"{where} has the shape <{shape.tag}>; it must be mesh, box, cylinder or sphere")


def _prism(radius: float, length: float) -> tuple[Array, list[list[int]]]:
    n = _ROUND_PARTS
    angle = 2 * np.pi * np.arange(n) / n
    ring = np.stack([radius * np.cos(angle), radius * np.sin(angle), np.full(n, length / 2)], 1)
    faces = []
    for i in range(n):
        j = (i + 1) % n
        faces += [[n + i, n + j, j], [n + i, j, i], [2 * n, i, j], [2 * n + 1, n + j, n + i]]
    ends = np.array([[0, 0, length / 2], [0, 0, -length / 2]])
    return np.concatenate([ring, ring * [1, 1, -1], ends]), faces


def _file(name: str, where: str, folder: str, packages: Any) -> str:
    if name.startswith("package://"):
        package, _, rest = name[len("package://") :].partition("/")
        if package not in packages:
            raise FileMissingError(f"{where} has the mesh {name}; give packages={{{package!r}: FOLDER}}")
        return os.path.join(packages[package], rest)
    return os.path.join(folder, name[len("file://") :] if name.startswith("file://") else name)


def _rotation(rpy: Array) -> Array:
    """Of a URDF: about the fixed axes x, y, z, one after the other."""
    c, s = np.cos(rpy), np.sin(rpy)
    about_x = np.array([[1, 0, 0], [0, c[0], -s[0]], [0, s[0], c[0]]])
    about_y = np.array([[c[1], 0, s[1]], [0, 1, 0], [-s[1], 0, c[1]]])
    about_z = np.array([[c[2], -s[2], 0], [s[2], c[2], 0], [0, 0, 1]])
    turn: Array = about_z @ about_y @ about_x
    return turn


def _write(path: str | os.PathLike[str], text: str, overwrite: bool) -> None:
    path = os.fspath(path)
    if os.path.lexists(path) and not overwrite:
        raise FileThereError(f"{path} exists; give overwrite=True to replace it")
    temporary = f"{path}.{os.getpid()}.tmp"
    try:
        with open(temporary, "w", encoding="utf-8") as file:
            file.write(text)
        os.replace(temporary, path)
    except OSError as error:
        if os.path.exists(temporary):
            os.remove(temporary)
        raise WriteError(f"cannot write {path}: {error.strerror}") from error


def _words(numbers: Any, between: str = " ") -> str:
    """With all digits: they are read back as the same numbers."""
    return between.join(repr(float(x)).removesuffix(".0") for x in numbers)


def _to_text(root: ET.Element) -> str:
    if hasattr(ET, "indent"):
        ET.indent(root)
    return ET.tostring(root, encoding="unicode") + "\n"


def write_urdf(
    path: str | os.PathLike[str],
    urdf: str | os.PathLike[str],
    links: Mapping[str, Spheres],
    *,
    overwrite: bool = False,
) -> None:
    """Writes a robot whose links collide by spheres, in place of what they collided with in `urdf`. All else stays.

    Names of files are made relative to where it is written. Raises FormatError for a link that the robot does not have.
    """
    root = copy.deepcopy(_parsed(urdf).getroot())
    there = {link.get("name"): link for link in root.iter("link")}
    for name, found in links.items():
        if name not in there:
            raise FormatError(f"{os.fspath(urdf)} has no link {name!r}")
        link = there[name]
        for old in link.findall("collision"):
            link.remove(old)
        for ball in found.spheres:
            collision = ET.SubElement(link, "collision")
            ET.SubElement(collision, "origin", xyz=_words(ball[:3]), rpy="0 0 0")
            ET.SubElement(ET.SubElement(collision, "geometry"), "sphere", radius=_words(ball[3:]))
    folders = [os.path.dirname(os.path.abspath(os.fspath(one))) for one in (urdf, path)]
    for mesh in [*root.iter("mesh"), *root.iter("texture")]:
        name = mesh.get("filename") or ""
        if folders[0] != folders[1] and name and "://" not in name and not os.path.isabs(name):
            mesh.set("filename", os.path.relpath(os.path.join(folders[0], name), folders[1]))
    _write(path, _to_text(root), overwrite)


def write_srdf(
    path: str | os.PathLike[str], robot: str, links: Mapping[str, Spheres], *, overwrite: bool = False
) -> None:
    """Writes the spheres of a robot of this name for MoveIt, as <link_sphere_approximation> of an SRDF."""
    root = ET.Element("robot", name=robot)
    for name, found in links.items():
        link = ET.SubElement(root, "link_sphere_approximation", link=name)
        for ball in found.spheres:
            ET.SubElement(link, "sphere", center=_words(ball[:3]), radius=_words(ball[3:]))
    _write(path, '<?xml version="1.0"?>\n' + _to_text(root), overwrite)


def write_curobo(path: str | os.PathLike[str], links: Mapping[str, Spheres], *, overwrite: bool = False) -> None:
    """Writes the file that ``collision_spheres`` of a robot of cuRobo names (YAML)."""
    lines = ["collision_spheres:"]
    for name, found in links.items():
        lines.append(f"  {json.dumps(name)}:")
        for ball in found.spheres:
            lines += [f'    - "center": [{_words(ball[:3], ", ")}]', f'      "radius": {_words(ball[3:])}']
    _write(path, "\n".join(lines) + "\n", overwrite)


def write_mjcf(
    path: str | os.PathLike[str],
    packing: Packing,
    *,
    name: str = "solid",
    density: float = 1000.0,
    cover: bool = False,
    clump: bool = False,
    overwrite: bool = False,
) -> None:
    """Writes a solid for MuJoCo: a free body with spheres, and the mass properties of the solid, not of these.

    density: [kg/m^3]. cover, clump: as in spheres_of(). The body's frame is that of the solid.
    """
    _check_density(density)
    root = ET.Element("mujoco", model=name)
    body = ET.SubElement(ET.SubElement(root, "worldbody"), "body", name=name)
    ET.SubElement(body, "freejoint")
    i = density * packing.inertia
    ET.SubElement(
        body,
        "inertial",
        pos=_words(packing.origin + packing.center_of_mass),
        mass=_words([density * packing.volume]),
        fullinertia=_words([i[0, 0], i[1, 1], i[2, 2], i[0, 1], i[0, 2], i[1, 2]]),
    )
    for ball in spheres_of(packing, cover=cover, clump=clump).spheres:
        ET.SubElement(body, "geom", type="sphere", pos=_words(ball[:3]), size=_words(ball[3:]))
    _write(path, _to_text(root), overwrite)


def _check_density(density: float) -> None:
    if not (np.isfinite(density) and density > 0):
        raise InvalidArgumentError(f"density is {density}; it must be positive")


def write_dem_engine(
    path: str | os.PathLike[str],
    packing: Packing,
    *,
    density: float = 1000.0,
    cover: bool = False,
    clump: bool = False,
    overwrite: bool = False,
) -> tuple[float, list[float]]:
    """Writes a clump for DEM-Engine (CSV), in the principal frame of the solid: its centre of mass and axes of inertia.

    density: [kg/m^3]. cover, clump: as in spheres_of().

    Returns mass [kg] and moments of inertia [kg m^2] of the solid: LoadClumpType(mass, moments, path, material). They
    stand in the file, too.
    """
    _check_density(density)
    moments, axes = np.linalg.eigh(density * packing.inertia)
    if np.linalg.det(axes) < 0:
        axes[:, 0] *= -1
    found = spheres_of(packing, cover=cover, clump=clump)
    balls = found.spheres.copy()
    balls[:, :3] = (balls[:, :3] - packing.origin - packing.center_of_mass) @ axes
    mass = density * packing.volume
    lines = ["x,y,z,r", *(_words(ball, ",") for ball in balls)]
    lines += [f"# mass = {_words([mass])}", f"# Ixx, yy, zz = {_words(moments, ', ')}"]
    _write(path, "\n".join(lines) + "\n", overwrite)
    return mass, moments.tolist()


def write_liggghts(
    path: str | os.PathLike[str],
    packing: Packing,
    *,
    density: float = 1000.0,
    cover: bool = False,
    clump: bool = False,
    overwrite: bool = False,
) -> str:
    """Writes the spheres of a particle for LIGGGHTS, about the centre of mass of the solid, along its axes.

    density: [kg/m^3]. cover, clump: as in spheres_of().

    Returns the words of `fix particletemplate/multisphere` that belong to it, with mass and inertia of the solid. They
    stand in the file as a comment, too.
    """
    _check_density(density)
    balls = spheres_of(packing, cover=cover, clump=clump).spheres.copy()
    balls[:, :3] -= packing.origin + packing.center_of_mass
    i = density * packing.inertia
    words = (
        f"nspheres {len(balls)} ntry 1000000 spheres file {os.path.basename(os.fspath(path))} scale 1.0 type 1 "
        f"mass {_words([density * packing.volume])} inertia_tensor "
        f"{_words([i[0, 0], i[0, 1], i[0, 2], i[1, 1], i[1, 2], i[2, 2]])} use_volume"
    )
    _write(path, f"# {words}\n" + "".join(_words(ball) + "\n" for ball in balls), overwrite)
    return words
