"""Packings inside a running PyBullet: what physics says of bodies that hang and lie, and what errors leave behind."""

import math
import os
import warnings

import numpy as np
import pytest
from conftest import write_obj

import innersphere

p = pytest.importorskip("pybullet", reason="PyBullet has no wheel for this Python")
if not hasattr(innersphere._core, "pybullet"):
    pytest.skip("innersphere was built without Bullet", allow_module_level=True)

import innersphere.pybullet as isp  # noqa: E402

RING, TUBE, MASS = 0.10, 0.02, 0.2  # of a link [m], [kg]
PITCH = 2 * (RING - TUBE)  # of a taut chain [m]
UPRIGHT = p.getQuaternionFromEuler([math.pi / 2, 0, 0])
ACROSS = p.getQuaternionFromEuler([math.pi / 2, 0, math.pi / 2])


def torus_mesh(around=64, across=24):
    """Vertices and faces of a ring about z; its surface goes through the middle of what it bounds, to second order."""
    u, v = np.meshgrid(np.arange(around), np.arange(across), indexing="ij")
    a, b = 2 * np.pi * u / around, 2 * np.pi * v / across
    r = RING + TUBE * np.cos(b)
    vertices = np.stack([r * np.cos(a), r * np.sin(a), TUBE * np.sin(b)], axis=-1).reshape(-1, 3)

    def at(i, j):
        return (i % around) * across + j % across

    faces = [
        np.stack([at(u, v), at(u + 1, v), at(u + 1, v + 1)], -1),
        np.stack([at(u, v), at(u + 1, v + 1), at(u, v + 1)], -1),
    ]
    return vertices, np.concatenate(faces).reshape(-1, 3)


def prism(outline, caps, height):
    """Vertices and faces of an outline (n, 2) that goes from z = 0 to a height; `caps` are triangles that fill it."""
    n = len(outline)
    vertices = np.r_[np.c_[outline, np.zeros(n)], np.c_[outline, np.full(n, height)]]
    faces = [c[::-1] for c in caps] + [[n + i for i in c] for c in caps]
    for i in range(n):
        j = (i + 1) % n
        faces += [[i, j, n + j], [i, n + j, n + i]]
    return vertices, faces


@pytest.fixture(scope="module")
def ring():
    return innersphere.pack(torus_mesh(), spheres=1000, overlap_errors=False)


@pytest.fixture
def client():
    number = p.connect(p.DIRECT)
    p.setGravity(0, 0, -9.81, physicsClientId=number)
    yield number
    if p.isConnected(number):
        p.disconnect(number)


def run(client, seconds):
    for _ in range(round(240 * seconds)):
        p.stepSimulation(physicsClientId=client)


def height(client, body):
    return p.getBasePositionAndOrientation(body, physicsClientId=client)[0][2]


def two_links(sim, ring):
    """A fixed link and one that hangs in it; its place at rest is -PITCH."""
    sim.create_body(ring, 0, [0, 0, 0], UPRIGHT)
    return sim.create_body(ring, MASS, [0, 0, -0.156], ACROSS)


@pytest.mark.parametrize("maximal", [False, True])
def test_a_chain_of_six_hangs_taut(client, ring, maximal):
    sim = isp.attach(client)
    links = [
        sim.create_body(
            ring, MASS * (i > 0), [0, 0, -0.156 * i], ACROSS if i % 2 else UPRIGHT, maximal_coordinates=maximal
        )
        for i in range(6)
    ]
    run(client, 10)
    z = np.array([height(client, body) for body in links])
    np.testing.assert_allclose(z, -PITCH * np.arange(6), atol=1e-3)
    rows = sim.overlaps()
    top = rows[(np.minimum(rows["body_a"], rows["body_b"]) == links[0])]
    assert abs(top["force"][:, 2].sum()) == pytest.approx(5 * MASS * 9.81, rel=0.02)


def test_a_ring_lies_on_a_plane_and_a_ball_in_its_hole(client, ring):
    sim = isp.attach(client)
    plane = p.createMultiBody(0, p.createCollisionShape(p.GEOM_PLANE, physicsClientId=client), physicsClientId=client)
    body = sim.create_body(ring, MASS, [0, 0, 0.05])
    shape = p.createCollisionShape(p.GEOM_SPHERE, radius=0.03, physicsClientId=client)
    ball = p.createMultiBody(0.05, shape, -1, [0, 0, 0.2], physicsClientId=client)
    run(client, 3)
    assert height(client, body) == pytest.approx(TUBE, abs=5e-4)
    assert height(client, ball) == pytest.approx(0.03, abs=5e-4)
    rows = sim.overlaps()
    assert rows.dtype == isp.contact_dtype
    assert [(r["body_a"], r["link_a"], r["body_b"], r["link_b"]) for r in rows] == [(body, -1, plane, -1)]
    assert rows["force"][0, 2] == pytest.approx(-MASS * 9.81, rel=0.02)


def test_mass_properties_and_places_are_those_of_the_mesh(client):
    # An L of two boxes has no symmetry to hide behind; its mass and inertia are sums over boxes.
    low, high = np.array([[0, 0, 0], [0, 0.1, 0]]), np.array([[0.3, 0.1, 0.05], [0.1, 0.4, 0.05]])
    outline = [[0, 0], [0.3, 0], [0.3, 0.1], [0.1, 0.1], [0.1, 0.4], [0, 0.4]]
    mesh = prism(outline, [[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 5]], 0.05)
    packing = innersphere.pack(mesh, spheres=200, overlap_errors=False)
    mass = np.prod(high - low, axis=1)
    middle = (high + low) / 2
    centre = mass @ middle / mass.sum()
    inertia = np.zeros((3, 3))
    for m, size, at in zip(mass, high - low, middle - centre):
        inertia += m * (np.diag((size @ size - size**2) / 12) + at @ at * np.eye(3) - np.outer(at, at))
    moments = np.linalg.eigvalsh(inertia / mass.sum())

    sim = isp.attach(client)
    place, turn = [1.0, 2.0, 3.0], [0.5, 0.5, 0.5, 0.5]
    body = sim.create_body(packing, 2.0, place, turn)
    got = sim.mesh_pose(body)
    np.testing.assert_allclose(got[0], place, atol=1e-6)
    np.testing.assert_allclose(np.abs(np.dot(got[1], turn)), 1, atol=1e-9)
    expected, _ = p.multiplyTransforms(place, turn, centre, [0, 0, 0, 1])
    np.testing.assert_allclose(p.getBasePositionAndOrientation(body, physicsClientId=client)[0], expected, atol=1e-6)
    np.testing.assert_allclose(sorted(p.getDynamicsInfo(body, -1, physicsClientId=client)[2]), 2 * moments, rtol=1e-4)

    def ray(x, y):
        ends = [p.multiplyTransforms(place, turn, [x, y, z], [0, 0, 0, 1])[0] for z in (1, -1)]
        return p.rayTest(*ends, physicsClientId=client)[0][2]

    assert ray(0.2, 0.05) == pytest.approx(0.475, abs=1e-4)  # on the face at z = 0.05
    assert ray(0.05, 0.3) == pytest.approx(0.475, abs=1e-4)
    assert ray(0.2, 0.3) == 1  # past the inner corner


URDF = """<robot name="part"><link name="base">
<inertial><origin xyz="0.01 0 0.02"/><mass value="0.2"/>
<inertia ixx="6e-4" ixy="0" ixz="0" iyy="6e-4" iyz="0" izz="1e-3"/></inertial>
<collision><origin xyz="0.05 0 0" rpy="0 0 0"/><geometry><mesh filename="ring.obj"/></geometry></collision></link>
<link name="arm"><inertial><mass value="0.1"/>
<inertia ixx="1e-4" ixy="0" ixz="0" iyy="1e-4" iyz="0" izz="1e-4"/></inertial>
<collision><geometry><box size="0.01 0.01 0.01"/></geometry></collision></link>
<joint name="hinge" type="fixed"><parent link="base"/><child link="arm"/><origin xyz="0.05 0 0.3"/></joint></robot>"""


def test_links_of_a_urdf_get_packings_of_their_meshes(client, tmp_path):
    write_obj(tmp_path / "ring.obj", *torus_mesh())
    (tmp_path / "part.urdf").write_text(URDF)
    sim = isp.attach(client)
    p.createMultiBody(0, p.createCollisionShape(p.GEOM_PLANE, physicsClientId=client), physicsClientId=client)
    body = p.loadURDF(str(tmp_path / "part.urdf"), [0, 0, 0.05], physicsClientId=client)
    packings = sim.pack_all(body, spheres=500, cache=tmp_path / "cache")
    assert list(packings) == [-1] and len(packings[-1]) == 500
    position, _ = sim.mesh_pose(body)
    np.testing.assert_allclose(position, [0.05, 0, 0.05], atol=1e-9)  # as the URDF says
    by_hand = p.loadURDF(str(tmp_path / "part.urdf"), [1, 0, 0.05], physicsClientId=client)
    sim.set_shape(by_hand, packings[-1], position=[0.05, 0, 0])
    np.testing.assert_allclose(sim.mesh_pose(by_hand)[0], [1.05, 0, 0.05], atol=1e-9)
    run(client, 2)
    for one in (body, by_hand):
        assert sim.mesh_pose(one)[0][2] == pytest.approx(TUBE, abs=1e-3)
    with pytest.raises(isp.PyBulletError, match="has no packing"):
        sim.mesh_pose(body, 0)


@pytest.mark.parametrize("scale", ["-1 1 1", "1 -0.5 2", "-1 -1 -1"])
def test_mirrored_and_stretched_meshes_are_where_pybullet_has_them(client, tmp_path, scale):
    outline = [[0, 0], [0.3, 0], [0.3, 0.1], [0.1, 0.1], [0.1, 0.4], [0, 0.4]]
    write_obj(tmp_path / "bracket.obj", *map(np.array, prism(outline, [[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 5]], 0.05)))
    (tmp_path / "bracket.urdf").write_text(
        URDF.replace("<collision><origin", '<collision concave="yes"><origin', 1)  # PyBullet's hull else
        .replace("ring.obj", f'bracket.obj" scale="{scale}')
        .replace('rpy="0 0 0"', 'rpy="0.1 0.2 0.3"')
    )
    sim = isp.attach(client)
    body = p.loadURDF(str(tmp_path / "bracket.urdf"), [1, 2, 3], UPRIGHT, useFixedBase=True, physicsClientId=client)
    # Rays from all sides, towards where the mesh is, and all from outside: from inside a packing they go out.
    low, high = np.array(p.getAABB(body, physicsClientId=client))
    rng = np.random.default_rng(1)
    ways = rng.normal(size=(1000, 3))
    ways /= np.linalg.norm(ways, axis=1, keepdims=True)
    starts = rng.uniform(low, high, ways.shape) - ways

    def hits():
        ends = (starts.tolist(), (starts + 2 * ways).tolist())
        return np.array([ray[2] for ray in p.rayTestBatch(*ends, physicsClientId=client)])

    before = hits()
    packing = sim.pack_all(body, spheres=100, overlap_errors=False)[-1]
    assert packing.volume == pytest.approx(0.003 * abs(np.prod([float(word) for word in scale.split()])))  # 0.06 m^2
    after = hits()
    hit = before < 1
    assert hit.sum() > 200
    np.testing.assert_allclose(after[hit], before[hit], atol=1e-5)
    assert (after[~hit] == 1).mean() > 0.99  # PyBullet's own misses a few


L_SHAPE = prism(
    [[0, 0], [0.3, 0], [0.3, 0.1], [0.1, 0.1], [0.1, 0.4], [0, 0.4]], [[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 5]], 0.05
)


@pytest.fixture(scope="module")
def bracket():
    """An L: no turn or mirror leaves it as it is."""
    return innersphere.pack(L_SHAPE, spheres=100, overlap_errors=False)


PLACE, TURN = [1.0, 2.0, 3.0], p.getQuaternionFromEuler([0.3, -0.2, 0.5])


def assert_mesh_at(sim, body, place, turn):
    """The pose that is told, and by rays from above the place of the mesh itself."""
    got = sim.mesh_pose(body)
    np.testing.assert_allclose(got[0], place, atol=2e-6)
    assert abs(np.dot(got[1], turn)) == pytest.approx(1, abs=1e-6)  # PyBullet's own sums are in single precision
    for (x, y), hit in (((0.2, 0.05), True), ((0.05, 0.3), True), ((0.2, 0.3), False)):
        ends = [p.multiplyTransforms(place, turn, [x, y, z], [0, 0, 0, 1])[0] for z in (1, -1)]
        fraction = p.rayTest(*ends, physicsClientId=sim.client)[0][2]
        assert fraction == (pytest.approx(0.475, abs=1e-4) if hit else 1)


@pytest.mark.parametrize("solver", ["bullet", "substep"])
def test_bodies_in_maximal_coordinates_get_other_packings_in_place(client, bracket, solver):
    sim = isp.attach(client, solver=solver)
    body = sim.create_body(bracket, 1, PLACE, TURN, maximal_coordinates=True)
    assert_mesh_at(sim, body, PLACE, TURN)
    for part in (bracket[:20], bracket):
        p.getAABB(body, physicsClientId=client)  # what PyBullet leaves of this was taken for a frame
        sim.set_shape(body, part)
        assert_mesh_at(sim, body, PLACE, TURN)


@pytest.mark.parametrize("maximal", [False, True])
def test_packings_are_where_a_urdf_has_its_link(client, bracket, tmp_path, maximal):
    (tmp_path / "one.urdf").write_text(
        """<robot name="one"><link name="base"><inertial><origin xyz="0.01 0.02 0.03" rpy="0.1 0.2 0.3"/>
        <mass value="1"/><inertia ixx=".02" ixy="0" ixz="0" iyy=".03" iyz="0" izz=".04"/></inertial>
        <collision><geometry><box size="0.1 0.1 0.1"/></geometry></collision></link></robot>"""
    )
    sim = isp.attach(client)
    options = dict(useMaximalCoordinates=maximal, physicsClientId=client)
    body = p.loadURDF(str(tmp_path / "one.urdf"), PLACE, TURN, **options)
    sim.set_shape(body, bracket)
    assert_mesh_at(sim, body, PLACE, TURN)
    inside = [0.1, -0.2, 0.3], p.getQuaternionFromEuler([0.5, 0.4, 0.3])
    sim.set_shape(body, bracket, -1, *inside)
    assert_mesh_at(sim, body, *p.multiplyTransforms(PLACE, TURN, *inside))
    shape = p.createCollisionShape(p.GEOM_SPHERE, radius=0.1, physicsClientId=client)
    other = p.createMultiBody(1, shape, -1, [0, 0, 9], TURN, [0.1, 0.2, 0.3], UPRIGHT, **options)
    sim.set_shape(other, bracket)
    assert_mesh_at(sim, other, [0, 0, 9], TURN)


def test_a_surface_is_drawn_by_one_shape(client, ring, bracket, monkeypatch):
    draw, drawn = p.createVisualShape, []

    def count(*arguments, **options):
        drawn.append((options["vertices"], options["indices"]))
        return draw(*arguments, **options)

    monkeypatch.setattr(p, "createVisualShape", count)
    sim = isp.attach(client)
    for _ in range(3):  # PyBullet never lets go of the lists
        bodies = [sim.create_body(one, 1) for one in (ring, bracket, ring[:50], bracket)]
        for body, packing in zip(bodies, (ring, bracket, ring, bracket)):
            (data,) = p.getVisualShapeData(body, physicsClientId=client)
            assert data[2] == p.GEOM_MESH
        p.removeBody(bodies[0], physicsClientId=client)
        p.resetSimulation(physicsClientId=client)
    assert len(drawn) == 6
    for vertices, indices in drawn[2:]:
        assert any(vertices is one[0] and indices is one[1] for one in drawn[:2])
    np.testing.assert_allclose(drawn[0][0], ring.vertices, atol=1e-12)
    isp.attach(client)  # in a new world, before the object that knows the shapes of the old one
    sim.create_body(ring, 1)
    assert len(drawn) == 7


def links_robot(tmp_path):
    """One mesh; two; a mesh and a box; a box: each in a link of its own."""
    write_obj(tmp_path / "ring.obj", *torus_mesh(24, 12))
    mesh, box = '<mesh filename="ring.obj"/>', '<box size="0.01 0.01 0.01"/>'
    links = {"base": [mesh], "pair": [mesh, mesh], "mixed": [mesh, box], "plain": [box], "tip": [mesh]}
    text = ""
    for name, shapes in links.items():
        collisions = "".join(f"<collision concave=\"yes\"><geometry>{shape}</geometry></collision>" for shape in shapes)
        text += f"""<link name="{name}"><inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0"
            izz="1"/></inertial>{collisions}</link>"""
    for parent, child, kind in (("base", "pair", "continuous"), ("pair", "mixed", "continuous"), ("mixed", "plain", "continuous"),
                                ("plain", "tip", "continuous")):  # fmt: skip
        text += f'<joint name="to_{child}" type="{kind}"><parent link="{parent}"/><child link="{child}"/></joint>'
    (tmp_path / "robot.urdf").write_text(f'<robot name="links">{text}</robot>')
    return str(tmp_path / "robot.urdf")


def test_links_that_keep_their_meshes_are_named(client, tmp_path):
    sim = isp.attach(client)
    body = p.loadURDF(links_robot(tmp_path), useFixedBase=True, physicsClientId=client)
    options = dict(spheres=20, overlap_errors=False, cache=tmp_path / "cache")
    with pytest.raises(TypeError, match="no option 'sphers'"):
        sim.pack_all(body, sphers=20)
    with pytest.warns(UserWarning) as told:
        assert list(sim.pack_all(body, **options)) == [-1, 3]
    (first,) = told
    assert first.filename == __file__
    text = str(first.message)
    assert f"body {body}" in text and "plain" not in text and "base" not in text and "tip" not in text
    assert "link 0 (pair) has 2 shapes, 2 of them meshes" in text and "link 1 (mixed) has 2 shapes, 1 of" in text
    with pytest.warns(UserWarning, match=r"link -1 \(base\) has a packing already.*link 3 \(tip\) has a packing already"):
        assert sim.pack_all(body, **options) == {}

    vertices = torus_mesh(24, 12)[0].tolist()
    shape = p.createCollisionShape(p.GEOM_MESH, vertices=vertices, physicsClientId=client)
    given = p.createMultiBody(1, shape, physicsClientId=client)
    with pytest.warns(UserWarning, match="without the name of its file: .*set_shape"):
        assert sim.pack_all(given, **options) == {}
    with pytest.warns(UserWarning, match=f"no link of body {floor(client)} collides with a mesh"):
        assert sim.pack_all(given + 1, **options) == {}
    maximal = p.createMultiBody(1, shape, useMaximalCoordinates=True, physicsClientId=client)
    with pytest.raises(isp.PyBulletError, match=f"body {maximal} is in maximal coordinates.*set_shape"):
        sim.pack_all(maximal, **options)
    with pytest.raises(isp.PyBulletError, match="no body 99 "):
        sim.pack_all(99, **options)
    with isp.attach(client) as other:
        pass
    with pytest.raises(isp.PyBulletError, match="detached"):
        other.pack_all(given, **options)
    sim = isp.attach(client)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        write_obj(tmp_path / "ring.obj", *torus_mesh(24, 12))
        (tmp_path / "part.urdf").write_text(URDF)
        part = p.loadURDF(str(tmp_path / "part.urdf"), [0, 0, 5], physicsClientId=client)
        assert list(sim.pack_all(part, **options)) == [-1]  # its other link is a box


def test_worlds_of_other_kinds_are_found_after_resets(client, ring):
    sim = isp.attach(client)
    for kind in (None, p.RESET_USE_DEFORMABLE_WORLD, None, p.RESET_USE_DEFORMABLE_WORLD):
        for _ in range(3):
            p.resetSimulation(*([] if kind is None else [kind]), physicsClientId=client)
            body = sim.create_body(ring, MASS, [0, 0, 0.5], visual=-1)
            floor(client)
            p.setGravity(0, 0, -9.81, physicsClientId=client)
            np.testing.assert_allclose(sim.mesh_pose(body)[0], [0, 0, 0.5], atol=1e-6)
            assert len(sim.overlaps()) == 0
            run(client, 0.5)
            assert len(sim.overlaps()) == 1


def test_a_restored_state_goes_on_the_same_after_set_shape(client, ring):
    sim = isp.attach(client)
    floor(client)
    bodies = [sim.create_body(ring, MASS, [0.03 * i, 0, 0.3 + 0.2 * i], [0.2, 0.1, 0, math.sqrt(0.95)]) for i in range(3)]
    run(client, 0.02)
    state, ends = p.saveState(physicsClientId=client), []
    for _ in range(3):
        p.restoreState(state, physicsClientId=client)
        for body in bodies:
            sim.set_shape(body, ring)
        run(client, 0.5)
        ends.append([p.getBasePositionAndOrientation(body, physicsClientId=client) for body in bodies])
    assert ends[0] == ends[1] == ends[2]


def test_resets_and_removal(client, ring):
    sim = isp.attach(client)
    heights = []
    for _ in range(5):
        p.resetSimulation(physicsClientId=client)
        p.setGravity(0, 0, -9.81, physicsClientId=client)
        body = two_links(sim, ring)
        run(client, 1)
        heights.append(height(client, body))
    np.testing.assert_allclose(heights, -PITCH, atol=1e-3)
    assert len(set(heights)) == 1
    p.removeBody(body, physicsClientId=client)  # while it touches
    run(client, 0.1)
    assert len(sim.overlaps()) == 0
    with pytest.raises(isp.PyBulletError, match=f"no body {body} "):
        sim.set_shape(body, ring)
    body = sim.create_body(ring, MASS, [0, 0, -0.156], ACROSS)
    run(client, 1)
    assert height(client, body) == pytest.approx(-PITCH, abs=1e-3)


def test_clients_do_not_mix(client, ring):
    other = p.connect(p.DIRECT)
    a, b = isp.attach(client), isp.attach(other)
    hangs, falls = two_links(a, ring), b.create_body(ring, MASS)
    p.setGravity(0, 0, -1, physicsClientId=other)
    run(other, 1)
    run(client, 1)
    assert height(client, hangs) == pytest.approx(-PITCH, abs=1e-3)
    assert height(other, falls) == pytest.approx(-0.5, abs=0.02)
    p.disconnect(other)
    run(client, 0.5)
    assert height(client, hangs) == pytest.approx(-PITCH, abs=1e-3)
    with pytest.raises(isp.PyBulletError, match=f"client {other} of PyBullet is not connected"):
        b.overlaps()
    b.detach()  # does nothing


def test_states_are_restored(client, ring):
    sim = isp.attach(client)
    body = two_links(sim, ring)
    run(client, 1)
    state, before = p.saveState(physicsClientId=client), height(client, body)
    p.resetBasePositionAndOrientation(body, [0.5, 0, 1], ACROSS, physicsClientId=client)
    run(client, 0.1)
    p.restoreState(state, physicsClientId=client)
    assert height(client, body) == pytest.approx(before, abs=1e-12)
    run(client, 1)
    assert height(client, body) == pytest.approx(-PITCH, abs=1e-3)


def test_detaching_gives_shapes_back(client, ring):
    shape = p.createCollisionShape(p.GEOM_SPHERE, radius=0.05, physicsClientId=client)
    p.createMultiBody(0, p.createCollisionShape(p.GEOM_PLANE, physicsClientId=client), physicsClientId=client)
    body = p.createMultiBody(MASS, shape, -1, [0, 0, 0.1], physicsClientId=client)
    with isp.attach(client) as sim:
        sim.set_shape(body, ring)
        sim.set_shape(body, ring[:256])
        run(client, 1)
        assert height(client, body) == pytest.approx(TUBE, abs=5e-4)
    p.resetBasePositionAndOrientation(body, [0, 0, 0.1], [0, 0, 0, 1], physicsClientId=client)
    run(client, 1)
    assert height(client, body) == pytest.approx(0.05, abs=5e-4)
    sim.detach()
    with pytest.raises(isp.PyBulletError, match="detached"):
        sim.overlaps()
    again = isp.attach(client)
    again.set_shape(body, ring)
    run(client, 1)
    assert height(client, body) == pytest.approx(TUBE, abs=5e-4)


def test_two_attachments_of_a_client_are_one(client, ring):
    first, second = isp.attach(client), isp.attach(client, response="rigid")
    body = two_links(first, ring)
    run(client, 1)
    assert height(client, body) == pytest.approx(-PITCH, abs=5e-3)  # rigid contacts give more
    assert len(first.overlaps()) == len(second.overlaps()) == 1
    second.detach()
    with pytest.raises(isp.PyBulletError, match="detached, in client"):
        first.overlaps()


def test_a_client_that_was_connected_anew_is_another(client, ring):
    sim = isp.attach(client)
    two_links(sim, ring)
    p.disconnect(client)
    assert p.connect(p.DIRECT) == client
    with pytest.raises(isp.PyBulletError, match="connected anew"):
        sim.overlaps()
    sim.detach()  # does nothing
    p.setGravity(0, 0, -9.81, physicsClientId=client)
    body = two_links(isp.attach(client), ring)
    run(client, 1)
    assert height(client, body) == pytest.approx(-PITCH, abs=1e-3)


def test_a_server_in_a_thread(ring):
    client = p.connect(p.SHARED_MEMORY_SERVER, os.getpid())  # as that of p.GUI, without a window
    try:
        sim = isp.attach(client)
        p.setGravity(0, 0, -9.81, physicsClientId=client)
        body = two_links(sim, ring)
        run(client, 1)
        assert height(client, body) == pytest.approx(-PITCH, abs=1e-3)
    finally:
        p.disconnect(client)


def test_errors_say_what_and_where(client, ring):
    sim = isp.attach(client)
    body = sim.create_body(ring)
    with pytest.raises(isp.PyBulletError, match=f"body {body} has no link 3; its links are -1"):
        sim.set_shape(body, ring, link=3)
    with pytest.raises(TypeError, match="packing is a str"):
        sim.set_shape(body, "ring")
    with pytest.raises(TypeError, match="body is 'ring'"):
        sim.set_shape("ring", ring)
    with pytest.raises(ValueError, match=r"position of the body has the shape \(2,\)"):
        sim.create_body(ring, position=[0, 0])
    with pytest.raises(ValueError, match="finite"):
        sim.create_body(ring, position=[0, 0, math.nan])
    with pytest.raises(ValueError, match="length 2"):
        sim.create_body(ring, orientation=[0, 0, 0, 2])
    with pytest.raises(ValueError, match="mass is -1"):
        sim.create_body(ring, -1)
    assert p.getNumBodies(physicsClientId=client) == 1
    with pytest.raises(innersphere.InvalidArgumentError, match="response is 'soft'"):
        isp.attach(client, response="soft")
    with pytest.raises(innersphere.InvalidArgumentError, match="stiffness"):
        isp.attach(client, stiffness=-1)
    assert len(sim.overlaps()) == 0  # still attached
    with pytest.raises(isp.PyBulletError, match="client 99 of PyBullet is not connected"):
        isp.attach(99)
    with pytest.raises(TypeError, match="client is 'me'"):
        isp.attach("me")


@pytest.fixture(scope="module")
def channel():
    """A concave box: the profile of a U, 0.3 x 0.2 m, 0.1 m high."""
    outline = 0.1 * np.array([[0, 0], [3, 0], [3, 2], [2, 2], [2, 1], [1, 1], [1, 2], [0, 2]])
    caps = [[0, 1, 4], [1, 2, 3], [1, 3, 4], [0, 4, 5], [0, 5, 6], [0, 6, 7]]
    return innersphere.pack(prism(outline, caps, 0.1), spheres=500, overlap_errors=False)


def floor(client):
    return p.createMultiBody(0, p.createCollisionShape(p.GEOM_PLANE, physicsClientId=client), physicsClientId=client)


def stacked(sim, packing, masses, seconds, **options):
    """How far a stack of bodies 0.1 m high gets from where it was put, in steps of 1/60 s [m]."""
    p.setTimeStep(1 / 60, physicsClientId=sim.client)
    floor(sim.client)
    bodies = [sim.create_body(packing, m, [0, 0, 0.1 * i], **options) for i, m in enumerate(masses)]
    run(sim.client, seconds / 4)  # of 240 steps/s
    places = np.array([sim.mesh_pose(body)[0] for body in bodies])
    return np.linalg.norm(places - [[0, 0, 0.1 * i] for i in range(len(masses))], axis=1).max()


@pytest.mark.parametrize("masses, seconds", [([1] * 10, 10), ([1, 100], 4)])
def test_concave_boxes_stand_in_steps_of_a_sixtieth(client, channel, masses, seconds):
    stands = 3e-3  # [m]
    assert stacked(isp.attach(client, solver="substep"), channel, masses, seconds) < stands
    for maximal in (False, True):  # with PyBullet's own solver
        p.resetSimulation(physicsClientId=client)
        p.setGravity(0, 0, -9.81, physicsClientId=client)
        assert stacked(isp.attach(client), channel, masses, seconds, maximal_coordinates=maximal) > 2 * stands


ARM = """<robot name="arm"><link name="base"/><link name="rod"><inertial><origin xyz="0.3 0 0"/><mass value="1"/>
<inertia ixx="1e-3" ixy="0" ixz="0" iyy="0.03" iyz="0" izz="0.03"/></inertial>
<collision><origin xyz="0.3 0 0"/><geometry><box size="0.6 0.1 0.1"/></geometry></collision></link>
<joint name="hinge" type="revolute"><parent link="base"/><child link="rod"/><axis xyz="0 1 0"/>
<limit lower="-4" upper="4" effort="100" velocity="100"/></joint></robot>"""


def swing(client, tmp_path, stack=None):
    """Where an arm is after half a second, in the world; with a `stack` there is one of it beside the arm."""
    (tmp_path / "arm.urdf").write_text(ARM)
    arm = p.loadURDF(str(tmp_path / "arm.urdf"), [0, 5, 1], useFixedBase=True, physicsClientId=client)
    p.setJointMotorControl2(arm, 0, p.VELOCITY_CONTROL, force=0.5, physicsClientId=client)
    if stack is None:
        run(client, 0.5)
    else:
        stack()
    return arm, p.getJointState(arm, 0, physicsClientId=client)[:2]


def test_substeps_leave_robots_to_pybullet(client, channel, tmp_path):
    p.setTimeStep(1 / 60, physicsClientId=client)
    _, alone = swing(client, tmp_path)
    p.resetSimulation(physicsClientId=client)
    p.setGravity(0, 0, -9.81, physicsClientId=client)
    sim = isp.attach(client, solver="substep")
    off = []
    arm, beside = swing(client, tmp_path, lambda: off.append(stacked(sim, channel, [1, 100], 2)))
    assert beside == alone and alone[0] != 0  # to the last bit
    assert off[0] < 3e-3
    # What it cannot move has no packing.
    with pytest.raises(isp.PyBulletError, match=f"link 0 of body {arm} is in reduced coordinates"):
        sim.set_shape(arm, channel, 0)
    count = p.getNumBodies(physicsClientId=client)
    with pytest.raises(isp.PyBulletError, match="in reduced coordinates, which solver 'substep' does not move"):
        sim.create_body(channel, 1, maximal_coordinates=False)
    assert p.getNumBodies(physicsClientId=client) == count
    sim.create_body(channel, 0, [9, 9, 0], maximal_coordinates=False)  # stands still
    with pytest.raises(innersphere.InvalidArgumentError, match="solver is 'mine'"):
        isp.attach(client, solver="mine")


def test_the_solver_comes_back_after_a_reset_and_goes_with_detach(client, channel):
    sim = isp.attach(client, solver="substep")
    for _ in range(2):
        p.resetSimulation(physicsClientId=client)
        p.setGravity(0, 0, -9.81, physicsClientId=client)
        assert stacked(sim, channel, [1, 100], 1) < 3e-3
    sim.detach()
    p.resetSimulation(physicsClientId=client)
    p.setGravity(0, 0, -9.81, physicsClientId=client)
    with isp.attach(client, solver="substep"):
        pass
    boxes = []
    for number in (client, p.connect(p.DIRECT)):
        p.setGravity(0, 0, -9.81, physicsClientId=number)
        p.setTimeStep(1 / 240, physicsClientId=number)
        isp.attach(number).detach()
        shape = p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.1] * 3, physicsClientId=number)
        floor(number)
        for i in range(3):
            box = p.createMultiBody(1, shape, -1, [0.03 * i, 0, 0.1 + 0.2 * i], physicsClientId=number)
        run(number, 1)
        boxes.append(p.getBasePositionAndOrientation(box, physicsClientId=number))
    p.disconnect(number)
    assert boxes[0] == boxes[1]


def test_substeps_are_not_for_deformable_bodies(client):
    p.resetSimulation(p.RESET_USE_DEFORMABLE_WORLD, physicsClientId=client)
    with pytest.raises(isp.PyBulletError, match=f"deformable bodies, in client {client}"):
        isp.attach(client, solver="substep")
    isp.attach(client)


def test_a_pybullet_that_differs_is_refused(client, monkeypatch):
    monkeypatch.setattr(p, "getAPIVersion", lambda: 202301010)
    with pytest.raises(isp.PyBulletError, match=r"API version must be 202010061: PyBullet .* \(API 202301010\)"):
        isp.attach(client)
    monkeypatch.undo()
    said = p.getPhysicsEngineParameters(physicsClientId=client) | {"numSolverIterations": 7}
    monkeypatch.setattr(p, "getPhysicsEngineParameters", lambda **_: said)
    with pytest.raises(isp.PyBulletError, match="iterations and gravity .* PyBullet .*innersphere"):
        isp.attach(client)
