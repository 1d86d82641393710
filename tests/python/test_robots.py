"""Robots' files in, spheres out: each file is read by the program that it is for, where that is installed."""

import importlib.util
import math
import os
import shutil
import signal
import subprocess
import threading
import xml.etree.ElementTree as ET

import numpy as np
import pytest
from conftest import matrix, write_obj

import innersphere
from innersphere import robots

ROBOT = """<?xml version="1.0"?>
<robot name="arm">
  <!-- what is not collision stays -->
  <link name="base">
    <inertial><mass value="2"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>
    <visual><geometry><mesh filename="ring.obj"/></geometry></visual>
    <collision><origin xyz="0.1 0.2 0.3" rpy="0.3 -0.4 0.5"/><geometry><box size="0.4 0.2 0.6"/></geometry></collision>
    <collision><geometry><sphere radius="0.05"/></geometry></collision>
  </link>
  <link name="ring">
    <inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>
    <collision concave="yes">
      <origin xyz="0 0 1"/>
      <geometry><!-- hollow --><mesh filename="package://arm/ring.obj" scale="0.1 0.1 0.1"/></geometry>
    </collision>
  </link>
  <link name="wheel"><collision><geometry><cylinder radius="0.3" length="0.2"/></geometry></collision></link>
  <link name="sensor"/>
  <joint name="j1" type="revolute"><parent link="base"/><child link="ring"/><axis xyz="0 0 1"/>
    <limit lower="-1" upper="1" effort="1" velocity="1"/></joint>
  <joint name="j2" type="fixed"><parent link="ring"/><child link="wheel"/><origin xyz="1 0 0"/></joint>
  <joint name="j3" type="fixed"><parent link="ring"/><child link="sensor"/></joint>
</robot>
"""


def ring(p):
    """Signed distance to a torus of radii 1 and 0.3."""
    return np.hypot(np.hypot(p[..., 0], p[..., 1]) - 1, p[..., 2]) - 0.3


def in_box(p):
    turn = np.eye(3)
    for axis, angle in zip(np.eye(3), (0.3, -0.4, 0.5)):  # about fixed axes, one after the other
        turn = matrix([0, 0, 0], [*(math.sin(angle / 2) * axis), math.cos(angle / 2)])[:3, :3] @ turn
    q = np.abs((p - [0.1, 0.2, 0.3]) @ turn) - [0.2, 0.1, 0.3]
    return np.linalg.norm(np.maximum(q, 0), axis=-1) + np.minimum(q.max(-1), 0)


def in_wheel(p):
    q = np.stack([np.hypot(p[..., 0], p[..., 1]) - 0.3, np.abs(p[..., 2]) - 0.1], -1)
    return np.linalg.norm(np.maximum(q, 0), axis=-1) + np.minimum(q.max(-1), 0)


DISTANCES = {"base": in_box, "ring": lambda p: 0.1 * ring(10 * (p - [0, 0, 1])), "wheel": in_wheel}


def surface_points(distance, low, high, count=3000):
    """Random points on a surface, by following the distance."""
    p = np.random.default_rng(5).uniform(low, high, (count, 3))
    for _ in range(60):
        step = 1e-5
        gradient = np.stack([distance(p + step * e) - distance(p - step * e) for e in np.eye(3)], -1) / (2 * step)
        p = p - (distance(p) / np.maximum((gradient**2).sum(-1), 1e-2))[:, None] * gradient
    return p[np.abs(distance(p)) < 1e-9]


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    folder = tmp_path_factory.mktemp("robot")
    vertices, faces = innersphere.surface_of(ring, [-1.4, -1.4, -0.4], [1.4, 1.4, 0.4], cells=20)
    write_obj(folder / "ring.obj", vertices, faces)
    (folder / "arm.urdf").write_text(ROBOT)
    return folder


def load(folder, **options):
    return robots.spheres_of_urdf(
        folder / "arm.urdf", spheres=40, packages={"arm": folder}, cache=folder / "c", **options
    )


@pytest.fixture(scope="module")
def inside(folder):
    return load(folder)


@pytest.fixture(scope="module")
def covering(folder):
    return load(folder, cover=True)


def test_spheres_lie_inside(inside):
    assert list(inside) == ["base", "ring", "wheel"]
    for name, found in inside.items():
        assert found.overhang == 0 and found.spheres.shape == ((41 if name == "base" else 40), 4)
        balls = found.spheres[:40]
        rounding = 4e-3 if name == "ring" else 1e-6  # its mesh is cut
        assert (DISTANCES[name](balls[:, :3]) + balls[:, 3] < rounding).all()
    np.testing.assert_allclose(inside["base"].spheres[40], [0, 0, 0, 0.05])


def test_covering_spheres_leave_no_point_of_the_surface_out(covering):
    for name, distance in DISTANCES.items():
        balls, overhang = covering[name]
        points = surface_points(distance, [-0.6, -0.6, -0.4], [0.6, 0.6, 1.3])
        assert len(points) > 500
        gap = (np.linalg.norm(points[:, None] - balls[None, :, :3], axis=2) - balls[:, 3]).min(axis=1)
        assert gap.max() < (4e-3 if name == "ring" else 1e-6)
        ways = np.random.default_rng(1).normal(size=(40, 500, 3))
        on = (balls[:40, None, :3] + balls[:40, None, 3:] * ways / np.linalg.norm(ways, axis=2, keepdims=True)).reshape(-1, 3)
        inside_of = np.linalg.norm(on[:, None] - balls[None, :, :3], axis=2) < balls[:, 3] - 1e-9
        out = distance(on[~inside_of.any(axis=1)]).max()
        assert 0 < out < 1.05 * overhang + 4e-3


def test_covers_are_of_spheres_all_over_the_surface(tmp_path):
    (tmp_path / "arm.urdf").write_text(ROBOT.replace("0.4 0.2 0.6", "0.4 1 0.03").replace("package://arm/ring", "none"))
    (tmp_path / "none.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n")
    by_default, by_radius = (
        robots.spheres_of_urdf(tmp_path / "arm.urdf", spheres=40, cover=True, **options)["base"].overhang
        for options in ({}, {"order": "radius"})
    )
    assert by_default < by_radius / 2  # of a plate


def test_meshes_are_mirrored_and_stretched(folder, tmp_path):
    (tmp_path / "arm.urdf").write_text(
        ROBOT.replace("package://arm/ring.obj", str(folder / "ring.obj"))
        .replace('xyz="0 0 1"', 'xyz="0 0 1" rpy="0 0 1.5707963267948966"')
        .replace('scale="0.1 0.1 0.1"', 'scale="-0.1 0.2 0.1"')
    )
    # The turn takes x to y, and y to -x; what is outside of a ring stays there when it is mirrored.
    def stretched(p):
        return ring(np.stack([-10 * p[..., 1], -5 * p[..., 0], 10 * (p[..., 2] - 1)], -1))

    balls = robots.spheres_of_urdf(tmp_path / "arm.urdf", spheres=60)["ring"].spheres
    ways = np.random.default_rng(2).normal(size=(60, 300, 3))
    on = balls[:, None, :3] + balls[:, None, 3:] * ways / np.linalg.norm(ways, axis=2, keepdims=True)
    assert stretched(on).max() < 0.03  # its mesh is cut
    assert np.abs(balls[:, 0]).max() > 0.15 > np.abs(balls[:, 1]).max()


@pytest.mark.skipif(importlib.util.find_spec("pybullet") is None, reason="needs PyBullet")
def test_pybullet_reads_the_urdf(folder, inside):
    import pybullet as p

    (folder / "sub").mkdir()
    out = folder / "sub" / "spheres.urdf"
    robots.write_urdf(out, folder / "arm.urdf", inside)
    text = out.read_text()
    assert "what is not collision stays" in text and 'filename="../ring.obj"' in text
    client = p.connect(p.DIRECT)
    try:
        body = p.loadURDF(str(out), useFixedBase=True, flags=p.URDF_USE_INERTIA_FROM_FILE)
        assert p.getNumJoints(body) == 3
        for link, name in ((-1, "base"), (0, "ring")):
            shapes = p.getCollisionShapeData(body, link)
            assert {shape[2] for shape in shapes} == {p.GEOM_SPHERE}
            read = np.array([[*shape[5], shape[3][0]] for shape in shapes])
            expected = inside[name].spheres
            np.testing.assert_allclose(read[np.lexsort(read.T)], expected[np.lexsort(expected.T)], atol=1e-6)
        ball = p.createMultiBody(1, p.createCollisionShape(p.GEOM_SPHERE, radius=0.01), basePosition=[0, 0, 1])
        assert not p.getClosestPoints(body, ball, 0.04, 0, -1)  # in the middle of the ring is a hole
        assert p.getClosestPoints(body, ball, 0.07, 0, -1)
    finally:
        p.disconnect(client)


def test_mujoco_reads_the_mjcf_and_the_urdf(folder, inside, tmp_path):
    mujoco = pytest.importorskip("mujoco")
    packing = innersphere.pack(folder / "ring.obj", spheres=50, overlap_errors=False)
    robots.write_mjcf(tmp_path / "ring.xml", packing, name="ring", density=500)
    model = mujoco.MjModel.from_xml_path(str(tmp_path / "ring.xml"))
    assert model.ngeom == 50 and (model.geom_type == mujoco.mjtGeom.mjGEOM_SPHERE).all()
    np.testing.assert_allclose(model.geom_size[:, 0], packing.spheres[:, 3], rtol=1e-6)
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    np.testing.assert_allclose(data.geom_xpos, packing.spheres[:, :3], atol=1e-6)
    # A torus in closed form.
    mass = 500 * 2 * math.pi**2 * 0.3**2
    assert model.body_mass[1] == pytest.approx(mass, rel=0.05)
    np.testing.assert_allclose(
        np.sort(model.body_inertia[1]), mass * np.array([0.5 + 5 / 8 * 0.09] * 2 + [1 + 0.75 * 0.09]), rtol=0.06
    )
    robots.write_urdf(tmp_path / "arm.urdf", folder / "arm.urdf", inside)
    arm = mujoco.MjModel.from_xml_path(str(tmp_path / "arm.urdf"))
    assert (arm.geom_type == mujoco.mjtGeom.mjGEOM_SPHERE).sum() >= 40


def test_yourdfpy_reads_the_urdf(folder, inside, tmp_path):
    yourdfpy = pytest.importorskip("yourdfpy")
    robots.write_urdf(tmp_path / "arm.urdf", folder / "arm.urdf", inside)
    robot = yourdfpy.URDF.load(str(tmp_path / "arm.urdf"), load_meshes=False, build_scene_graph=False)
    for name, found in inside.items():
        read = [[*c.origin[:3, 3], c.geometry.sphere.radius] for c in robot.link_map[name].collisions]
        np.testing.assert_allclose(read, found.spheres, rtol=1e-6, atol=1e-9)


def test_curobo_yaml(inside, tmp_path):
    """As robots/spheres of cuRobo: lists of center and radius under the name of each link."""
    yaml = pytest.importorskip("yaml")
    robots.write_curobo(tmp_path / "arm.yml", inside)
    read = yaml.safe_load((tmp_path / "arm.yml").read_text())["collision_spheres"]
    assert list(read) == list(inside)
    for name, found in inside.items():
        np.testing.assert_allclose(
            [[*s["center"], s["radius"]] for s in read[name]], found.spheres, rtol=1e-6, atol=1e-9
        )


def test_numbers_far_away_have_all_digits(tmp_path):
    """A part of 0.2 m, 1000 km from its origin: its spheres would lie in each other, rounded to 1 mm."""
    corners = np.array([[0, 0, 0], [0.2, 0, 0], [0, 0.2, 0], [0, 0, 0.2]]) + [1e6, -1e6, 0.1]
    packing = innersphere.pack((corners, [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]), spheres=20, overlap_errors=False)
    expected = robots.spheres_of(packing)
    robots.write_mjcf(tmp_path / "a.xml", packing)
    read = [[*map(float, g.get("pos").split()), float(g.get("size"))] for g in ET.parse(tmp_path / "a.xml").iter("geom")]
    np.testing.assert_array_equal(read, expected.spheres)
    robots.write_srdf(tmp_path / "a.srdf", "arm", {"a": expected})
    balls = ET.parse(tmp_path / "a.srdf").iter("sphere")
    read = [[*map(float, s.get("center").split()), float(s.get("radius"))] for s in balls]
    np.testing.assert_array_equal(read, expected.spheres)


def test_srdf(inside, tmp_path):
    """As srdfdom reads it: link_sphere_approximation with the link, spheres with center (three numbers) and radius."""
    robots.write_srdf(tmp_path / "arm.srdf", "arm", inside)
    root = ET.parse(tmp_path / "arm.srdf").getroot()
    assert root.tag == "robot" and root.get("name") == "arm"
    for element, (name, found) in zip(root, inside.items()):
        assert element.tag == "link_sphere_approximation" and element.get("link") == name
        read = [[*map(float, s.get("center").split()), float(s.get("radius"))] for s in element.findall("sphere")]
        np.testing.assert_allclose(read, found.spheres, rtol=1e-6, atol=1e-9)


def test_dem_engine_clumps(box, tmp_path):
    """Columns x, y, z, r; comments begin with #."""
    mass, moments = robots.write_dem_engine(tmp_path / "box.csv", box, density=2000)
    assert mass == pytest.approx(2000 * 6)
    np.testing.assert_allclose(moments, mass / 12 * np.array([1 + 4, 1 + 9, 4 + 9]), rtol=1e-6)
    text = (tmp_path / "box.csv").read_text()
    assert text.startswith("x,y,z,r\n") and "# mass = 12000" in text
    read = np.loadtxt(tmp_path / "box.csv", delimiter=",", skiprows=1)
    assert read.shape == (300, 4)
    # The axes are those of the box, by rising moment: z (3 m long) becomes x, y stays, x becomes z.
    assert (np.abs(read[:, :3]) + read[:, 3:] < np.array([1.5, 1, 0.5]) + 1e-5).all()


def test_liggghts_reads_the_particle(box, tmp_path):
    words = robots.write_liggghts(tmp_path / "box.txt", box[:20], density=2000, cover=True)
    read = np.loadtxt(tmp_path / "box.txt")
    assert read.shape == (20, 4) and f"# {words}" in (tmp_path / "box.txt").read_text()
    assert "nspheres 20 " in words and "mass 12000 " in words
    if shutil.which("liggghts") is None:
        pytest.skip("liggghts is not installed; the file was checked by its documented grammar")
    (tmp_path / "in.box").write_text(f"""
        atom_style granular
        atom_modify map array
        boundary f f f
        newton off
        communicate single vel yes
        units si
        region all block -5 5 -5 5 -5 5 units box
        create_box 1 all
        neighbor 0.1 bin
        fix m1 all property/global youngsModulus peratomtype 1e7
        fix m2 all property/global poissonsRatio peratomtype 0.3
        fix m3 all property/global coefficientRestitution peratomtypepair 1 0.5
        fix m4 all property/global coefficientFriction peratomtypepair 1 0.5
        pair_style gran model hertz tangential history
        pair_coeff * *
        timestep 1e-5
        fix gravity all gravity 9.81 vector 0 0 -1
        fix p1 all particletemplate/multisphere 15485863 atom_type 1 density constant 2000 {words}
        fix d1 all particledistribution/discrete 15485867 1 p1 1.0
        fix ins all insert/pack seed 86028157 distributiontemplate d1 insert_every once overlapcheck yes all_in yes &
            particles_in_region 1 region all
        fix move all multisphere
        run 2
    """)
    done = subprocess.run(["liggghts", "-in", "in.box"], cwd=tmp_path, capture_output=True, text=True, timeout=60)
    assert done.returncode == 0 and "ERROR" not in done.stdout, done.stdout + done.stderr
    assert "inserted 1 particle templates (" in done.stdout and "mass 1.200000e+04" in done.stdout, done.stdout


@pytest.mark.parametrize(
    "old, new, error, message",
    [
        ("<robot ", "<sdf ", innersphere.FormatError, "mismatched tag|begins with"),
        ('<box size="0.4 0.2 0.6"/>', '<box size="0.4 0.2"/>', innersphere.FormatError, "'base'.*3 numbers"),
        ('<box size="0.4 0.2 0.6"/>', '<capsule radius="1" length="1"/>', innersphere.FormatError, "'base'.*<capsule>"),
        ('<box size="0.4 0.2 0.6"/>', "", innersphere.FormatError, "without a geometry"),
        ('rpy="0.3 -0.4 0.5"', 'rpy="0.3 -0.4 up"', innersphere.FormatError, "rpy"),
        ('scale="0.1 0.1 0.1"', 'scale="0.1 0.1 0"', innersphere.InvalidArgumentError, "scale is .*not 0"),
        ("package://arm/", "package://leg/", innersphere.FileMissingError, "'leg': FOLDER"),
        ("package://arm/", "", None, ""),
        ("package://arm/ring", "file://nothing", innersphere.FileMissingError, "nothing.obj"),
    ],
)
def test_bad_robots(old, new, error, message, folder):
    path = folder / "bad.urdf"
    path.write_text(ROBOT.replace(old, new))
    if error is None:
        assert len(robots.spheres_of_urdf(path, spheres=5)["ring"].spheres) == 5
        return
    with pytest.raises(error, match=message):
        robots.spheres_of_urdf(path, spheres=5, packages={"arm": folder})


def test_bad_output(folder, inside, box, tmp_path):
    with pytest.raises(innersphere.FileMissingError):
        robots.spheres_of_urdf(tmp_path / "no.urdf")
    with pytest.raises(innersphere.FormatError, match="no link 'leg'"):
        robots.write_urdf(tmp_path / "a.urdf", folder / "arm.urdf", {"leg": inside["base"]})
    with pytest.raises(innersphere.WriteError):
        robots.write_srdf(tmp_path / "no" / "a.srdf", "arm", inside)
    with pytest.raises(innersphere.InvalidArgumentError, match="density"):
        robots.write_mjcf(tmp_path / "a.xml", box, density=0)
    assert list(tmp_path.iterdir()) == []
    robots.write_mjcf(tmp_path / "a.xml", box)
    with pytest.raises(innersphere.FileThereError):
        robots.write_mjcf(tmp_path / "a.xml", box)
    robots.write_mjcf(tmp_path / "a.xml", box[:10], overwrite=True)
    assert (tmp_path / "a.xml").read_text().count("<geom ") == 10


def test_clumps_overlap_and_come_near_to_the_solid(box, tmp_path):
    balls, overhang = robots.spheres_of(box[:24], clump=True)
    points = np.random.default_rng(2).uniform(-0.5, [1.5, 2.5, 3.5], (100000, 3))
    held = (np.linalg.norm(points[:, None] - balls[None, :, :3], axis=2) < balls[:, 3]).any(axis=1)
    out = np.linalg.norm(points - np.clip(points, 0, [1, 2, 3]), axis=1)
    inside = out == 0
    assert (held & inside).sum() > 0.88 * inside.sum() and (held & ~inside).sum() < 0.08 * inside.sum()
    assert 0 < out[held].max() < 1.02 * overhang
    careful = robots.spheres_of(box[:24], clump=True, outside_weight=20)
    assert careful.overhang < overhang / 2
    robots.write_dem_engine(tmp_path / "box.csv", box[:24], clump=True)
    read = np.loadtxt(tmp_path / "box.csv", delimiter=",", skiprows=1)
    np.testing.assert_allclose(sorted(read[:, 3]), sorted(balls[:, 3]), rtol=1e-7)
    with pytest.raises(innersphere.InvalidArgumentError, match="one of them"):
        robots.spheres_of(box, cover=True, clump=True)
    with pytest.raises(innersphere.InvalidArgumentError, match="weight"):
        robots.spheres_of(box[:4], clump=True, outside_weight=0)


@pytest.mark.parametrize("options", [dict(cover=True, resolution=2e-4), dict(clump=True)])
def test_ctrl_c_ends_coverings_and_clumps(box, options):
    handled, done = [], threading.Event()

    def handle(*_):
        handled.append(1)
        if len(handled) == 3:  # those that come while the library is at work: of others only one is kept
            raise KeyboardInterrupt

    def send():
        while len(handled) < 3 and not done.wait(0.02):
            os.kill(os.getpid(), signal.SIGINT)

    before = signal.signal(signal.SIGINT, handle)
    sender = threading.Thread(target=send)
    try:
        sender.start()
        with pytest.raises(KeyboardInterrupt):
            robots.spheres_of(box, **options)
            done.set()
    finally:
        done.set()
        sender.join()
        signal.signal(signal.SIGINT, before)


def test_covering_needs_a_surface(ball):
    with pytest.raises(innersphere.EmptyInputError, match="surface"):
        robots.spheres_of(ball, cover=True)
    with pytest.raises(innersphere.EmptyInputError, match="surface"):
        robots.spheres_of(ball, clump=True)
    assert robots.spheres_of(ball).spheres.tolist() == [[0, 0, 0, 1]]
