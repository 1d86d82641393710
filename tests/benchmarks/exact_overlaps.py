"""Writes poses of a solid and its copy with their exact overlaps, for overlap_accuracy and triangle_overlaps.

    pip install manifold3d numpy
    python3 exact_overlaps.py bunny.obj -o bunny.csv            # a closed mesh
    python3 exact_overlaps.py blade -o blade.csv --mesh blade.obj  # a solid made here: blade, cup, horn, chain_link

Each pose turns the copy at random and moves it along a random direction until both share a wanted part of the solid, from
0.01 % to 45 %. The overlaps are booleans of meshes by Manifold (https://github.com/elalish/manifold), which shares no code
with InnerSphere.
"""

import argparse

import manifold3d
import numpy as np


def read_obj(path):
    vertices, triangles = [], []
    for line in open(path):
        words = line.split()
        if words[:1] == ["v"]:
            vertices.append([float(x) for x in words[1:4]])
        elif words[:1] == ["f"]:
            corners = [int(word.split("/")[0]) - 1 for word in words[1:]]
            triangles += [[corners[0], corners[k], corners[k + 1]] for k in range(1, len(corners) - 1)]
    return np.array(vertices), np.array(triangles)


def to_solid(vertices, triangles):
    solid = manifold3d.Manifold(manifold3d.Mesh64(vertices, triangles.astype(np.uint64)))
    if solid.status() != manifold3d.Error.NoError:
        raise SystemExit(f"the mesh is not closed: {solid.status()}")
    return solid


def tube(path, radii, sides, closed):
    """A tube of circles about the points of a path."""
    n = len(path)
    ahead = np.roll(path, -1, 0) - np.roll(path, 1, 0) if closed else np.gradient(path, axis=0)
    ahead /= np.linalg.norm(ahead, axis=1, keepdims=True)
    across = np.cross(ahead, [0, 0, 1.0])
    across /= np.linalg.norm(across, axis=1, keepdims=True)
    up = np.cross(across, ahead)
    angle = 2 * np.pi * np.arange(sides) / sides
    rings = path[:, None] + radii[:, None, None] * (
        np.cos(angle)[None, :, None] * across[:, None] + np.sin(angle)[None, :, None] * up[:, None])
    vertices, triangles = list(rings.reshape(-1, 3)), []
    for i in range(n if closed else n - 1):
        for j in range(sides):
            a, b = i * sides + j, i * sides + (j + 1) % sides
            c, d = (i + 1) % n * sides + j, (i + 1) % n * sides + (j + 1) % sides
            triangles += [[a, b, d], [a, d, c]]
    if not closed:
        for end, flip in ((0, True), (n - 1, False)):
            vertices.append(path[end])
            for j in range(sides):
                corner = [len(vertices) - 1, end * sides + j, end * sides + (j + 1) % sides]
                triangles.append(corner[::-1] if flip else corner)
    vertices, triangles = np.array(vertices), np.array(triangles)
    a, b, c = (vertices[triangles[:, k]] for k in range(3))
    return to_solid(vertices, triangles if np.einsum("ij,ij", a, np.cross(b, c)) > 0 else triangles[:, ::-1])


def make(name):
    if name == "blade":  # 0.2 x 0.03 m, 2 mm thick at the back, 0.2 mm at the edge
        profile = [[0, -0.001], [0.03, -0.0001], [0.03, 0.0001], [0, 0.001]]
        return manifold3d.CrossSection([profile]).extrude(0.2, n_divisions=40, twist_degrees=20)
    if name == "cup":  # 0.1 m high, walls of 2 mm
        profile = [[0, 0], [0.03, 0], [0.04, 0.1], [0.038, 0.1], [0.028, 0.002], [0, 0.002]]
        return manifold3d.CrossSection([profile]).revolve(96)
    if name == "horn":  # a bent cone
        t = np.linspace(0, 1, 60)
        path = np.stack([np.cos(2 * t), np.sin(2 * t), 0 * t], 1)
        return tube(path, 0.15 - 0.14 * t, 32, closed=False)
    if name == "chain_link":  # two half circles of wire and straight bars between
        t = 2 * np.pi * np.arange(96) / 96
        path = np.stack([np.cos(t) + 0.8 * np.sign(np.cos(t)), 0.7 * np.sin(t), 0 * t], 1)
        return tube(path, np.full(96, 0.16), 24, closed=True)
    return to_solid(*read_obj(name))


def turned(rng, centre):
    q = rng.normal(size=4)
    w, x, y, z = q / np.linalg.norm(q)
    r = np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                  [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                  [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])
    return np.hstack([r, (centre - r @ centre)[:, None]])


def corners_of(solid):
    mesh = solid.to_mesh64()
    p = np.asarray(mesh.vert_properties)[:, :3]
    return [p[np.asarray(mesh.tri_verts)[:, k]] for k in range(3)], np.asarray(mesh.run_original_id), np.asarray(
        mesh.run_index)


def row(solid, copy):
    shared = solid ^ copy
    (a, b, c), ids, starts = corners_of(shared)
    volumes = np.einsum("ij,ij->i", a, np.cross(b, c)) / 6
    volume = volumes.sum()
    centroid = (volumes[:, None] * (a + b + c) / 4).sum(0) / volume
    normals = np.cross(b - a, c - a) / 2
    gradient = np.zeros(3)  # the outward normal over the copy's part
    for run, original in enumerate(ids):
        if original == copy.original_id():
            gradient += normals[starts[run] // 3:starts[run + 1] // 3].sum(0)
    return volume, centroid, gradient


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("solid")
    parser.add_argument("-o", "--output", required=True)
    parser.add_argument("--mesh", help="write the mesh there, too (OBJ)")
    parser.add_argument("--poses", type=int, default=100)
    parser.add_argument("--seed", type=int, default=1)
    arguments = parser.parse_args()
    rng = np.random.default_rng(arguments.seed)
    solid = make(arguments.solid)
    mesh = solid.to_mesh64()
    if arguments.mesh:
        with open(arguments.mesh, "w") as out:
            for v in np.asarray(mesh.vert_properties)[:, :3]:
                out.write("v %.17g %.17g %.17g\n" % tuple(v))
            for t in np.asarray(mesh.tri_verts):
                out.write("f %d %d %d\n" % tuple(t + 1))
    box = np.array(solid.bounding_box()).reshape(2, 3)
    centre, size, whole = box.mean(0), np.linalg.norm(box[1] - box[0]), solid.volume()
    with open(arguments.output, "w") as out:
        out.write("pose," + ",".join(f"m{i}{j}" for i in range(3) for j in range(4)) + ",V,cx,cy,cz,gx,gy,gz\n")
        for pose in range(arguments.poses):
            wanted = 10 ** rng.uniform(-4, np.log10(0.45))
            turn, way = turned(rng, centre), rng.normal(size=3)
            way /= np.linalg.norm(way)
            at = lambda s: solid.transform(turn + np.hstack([np.zeros((3, 3)), (s * size * way)[:, None]]))
            near, far = 0.0, 1.2
            for _ in range(14):
                middle = (near + far) / 2
                near, far = (middle, far) if (solid ^ at(middle)).volume() > wanted * whole else (near, middle)
            copy = at(near).as_original()
            if (solid ^ copy).volume() < 5e-5 * whole:
                continue
            volume, centroid, gradient = row(solid, copy)
            place = turn + np.hstack([np.zeros((3, 3)), (near * size * way)[:, None]])
            numbers = [*place.ravel(), volume, *centroid, *gradient]
            out.write(f"{pose}," + ",".join("%.17g" % x for x in numbers) + "\n")


main()
