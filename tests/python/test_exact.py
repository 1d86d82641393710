"""Exact overlaps by Manifold, beside closed forms."""

import subprocess
import sys

import numpy as np
import pytest
from conftest import BOX_FACES, BOX_VERTICES, random_quaternions, write_obj

import innersphere

CUBE = BOX_VERTICES / [1, 2, 3], BOX_FACES  # from the origin to (1, 1, 1)


def test_without_manifold_it_says_what_to_install(monkeypatch):
    monkeypatch.setitem(sys.modules, "manifold3d", None)
    with pytest.raises(innersphere.MissingLibraryError, match="pip install manifold3d"):
        innersphere.exact_overlap(CUBE, CUBE)


def test_boxes_and_an_octagon():
    pytest.importorskip("manifold3d")
    shift = np.array([[0.25, 0.5, -0.5], [2, 0, 0]])
    found = innersphere.exact_overlap(CUBE, CUBE, pose_b=(shift, [0, 0, 0, 1]))
    np.testing.assert_allclose(found["volume"], [0.75 * 0.5 * 0.5, 0], atol=1e-12)
    np.testing.assert_allclose(found["centroid"][0], [0.625, 0.75, 0.25], atol=1e-12)
    # Both turned and moved alike share the same, and the centroid is told from where A is.
    turn = random_quaternions(np.random.default_rng(2))
    pose = innersphere.exact_overlap(CUBE, CUBE, ([5, 6, 7], turn), ([5, 6, 7], turn))
    assert pose.shape == () and pose["volume"] == pytest.approx(1)
    assert np.linalg.norm(pose["centroid"]) == pytest.approx(np.sqrt(3) / 2)
    # A square and one that is turned by 45 degrees share an octagon.
    centred = CUBE[0] - 0.5, CUBE[1]
    eighth = np.eye(4)
    eighth[:2, :2] = np.array([[1, -1], [1, 1]]) / np.sqrt(2)
    both = np.broadcast_to(eighth, (2, 3, 4, 4))
    np.testing.assert_allclose(innersphere.exact_overlap(centred, centred, None, both)["volume"], 2 * np.sqrt(2) - 2)


def joined(*meshes):
    starts = np.cumsum([0, *(len(vertices) for vertices, _ in meshes)])
    return np.concatenate([m[0] for m in meshes]), np.concatenate([m[1] + s for m, s in zip(meshes, starts)])


def test_what_shells_share_counts_once():
    pytest.importorskip("manifold3d")
    around = 9 * CUBE[0] - 4, CUBE[1]
    halves = joined(CUBE, (CUBE[0] + [0.5, 0, 0], CUBE[1]))  # flush
    cavity = 0.5 * CUBE[0] + 0.25, CUBE[1][:, ::-1]
    two_hollow = joined(CUBE, cavity, (CUBE[0] + [0.4, 0, 0], CUBE[1]), (cavity[0] + [0.4, 0, 0], cavity[1]))
    for mesh, volume in (
        (halves, 1.5),
        (joined(CUBE, (CUBE[0] + [1, 0, 0], CUBE[1])), 2),
        (joined(CUBE, (0.5 * CUBE[0] + 0.75, CUBE[1])), 1.125 - 0.25**3),
        (joined(CUBE, cavity), 0.875),
        (two_hollow, 1.4 - (0.15 + 0.1 + 0.15) * 0.5**2),  # walls fill cavities, cavities that meet stay
    ):
        assert innersphere.exact_overlap(around, mesh)["volume"] == pytest.approx(volume)
    packing = innersphere.pack(halves, spheres=50, overlap_errors=False)
    assert innersphere.exact_overlap(around, packing)["volume"] == pytest.approx(1.5)
    assert any("shells share" in warning for warning in packing.warnings)


def test_packings_and_solids(box):
    pytest.importorskip("manifold3d")
    pose = ([0.5, 0.5, 0.5], [0, 0, 0, 1])
    exact = innersphere.exact_overlap(box, box, None, pose)["volume"]
    assert exact == pytest.approx(0.5 * 1.5 * 2.5)
    assert innersphere.Query().overlap(box, box, None, pose)["volume"] == pytest.approx(exact, rel=0.05)


def test_the_triangles_of_packings_share_what_manifold_says():
    pytest.importorskip("manifold3d")
    gear = innersphere.pack(innersphere.solid("gear"), spheres=64, overlap_errors=False)
    poses = innersphere.random_poses(30, -0.6, 0.6, seed=4)
    exact = innersphere.exact_overlap(gear, gear, None, poses)
    found = innersphere.Query().overlap(gear, gear, None, poses, estimator="surface", want="volume")
    assert (exact["volume"] > 0).sum() > 20
    np.testing.assert_allclose(found["volume"], exact["volume"], rtol=1e-5, atol=1e-7 * gear.volume)
    np.testing.assert_allclose(found["centroid"], exact["centroid"], atol=1e-4)


def test_open_meshes_are_repaired_on_request():
    pytest.importorskip("manifold3d")
    open_cube = (CUBE[0], BOX_FACES[1:])
    assert innersphere.exact_overlap(open_cube, CUBE, repair=True)["volume"] == pytest.approx(1)
    repaired = innersphere.pack(open_cube, spheres=20, overlap_errors=False, repair=True)
    assert innersphere.exact_overlap(repaired, CUBE)["volume"] == pytest.approx(1)


@pytest.mark.parametrize(
    "mesh, pose, error, message",
    [
        ((CUBE[0], BOX_FACES[1:]), None, innersphere.NotASolidError, "a does not bound.*ask for repair=True"),
        (CUBE, 2 * np.eye(4), innersphere.InvalidArgumentError, "query 0: the placement of B"),
        (CUBE, ([np.nan, 0, 0], [0, 0, 0, 1]), innersphere.NotFiniteError, "query 0: the placement of B"),
        (CUBE, np.eye(3), ValueError, "pose_b has the shape"),
        (CUBE, (np.zeros(3),), ValueError, "a tuple"),
        (CUBE, [[0, 0, 0], [0, 0, 0, 1]], ValueError, "pose_b has rows of different lengths.*a tuple of positions"),
        (3, None, TypeError, "mesh"),
    ],
)
def test_bad_input(mesh, pose, error, message):
    pytest.importorskip("manifold3d")
    with pytest.raises(error, match=message):
        innersphere.exact_overlap(mesh, CUBE, None, pose)


def test_the_command(tmp_path):
    def run(*words):
        return subprocess.run(
            [sys.executable, "-m", "innersphere", "overlap", *words], cwd=tmp_path, capture_output=True, text=True
        )

    names = [f"m{i}{j}" for i in range(3) for j in range(4)]
    rows = np.tile(np.eye(4)[:3].ravel(), (3, 1))
    rows[:, 3] = [0.1, 0.5, 3]
    (tmp_path / "poses.csv").write_text("# moved along x\n" + ",".join(names) + "\n")
    with open(tmp_path / "poses.csv", "a") as file:
        np.savetxt(file, rows, delimiter=",")
    got = run("box", "box", "--poses", "poses.csv", "--spheres", "500")
    assert got.returncode == 0, got.stderr
    header, *lines = got.stdout.splitlines()
    assert header == "pose,volume" and len(lines) == 3 and lines[2] == "2,0"
    # As a spreadsheet writes it: cells in quotes, one with a comma, other ends of lines, a comment and an empty line.
    cells = [["name, place", *names], *([f"at {row[3]}, 0", *row] for row in rows)]
    lines = [",".join(f'"{cell}"' for cell in row) for row in cells]
    lines[1:1] = ["# turned by nothing", "", " "]
    (tmp_path / "sheet.csv").write_bytes(("\ufeff" + "\r\n".join(lines)).encode())
    again = run("box", "box", "--poses", "sheet.csv", "--spheres", "500")
    assert again.stdout == got.stdout, again.stderr
    assert run("nothing", "box").returncode == 1
    (tmp_path / "bad.csv").write_text(",".join(names) + "\n#\n" + ",".join(["1"] * 11 + ["x"]) + "\n")
    (tmp_path / "long.csv").write_text(",".join(names) + "\n" + "1" * 200000 + "\n")
    (tmp_path / "other.csv").write_text("x,y\n1,2\n")
    (tmp_path / "empty.csv").write_text(",".join(names) + "\n")
    for words, message in (
        (["nope.obj", "box"], "there is no file nope.obj"),
        (["box", "box", "--poses", "bad.csv"], 'bad.csv, line 3, column m23: "x" is not a number'),
        (["box", "box", "--poses", "other.csv"], "other.csv has no column m00"),
        (["box", "box", "--poses", "long.csv"], "long.csv, line 2: field larger"),
        (["box", "box", "--poses", "empty.csv"], "empty.csv holds no poses"),
    ):
        refused = run(*words, "--spheres", "20")
        assert refused.returncode == 1 and message in refused.stderr, refused.stderr
    write_obj(tmp_path / "open.obj", CUBE[0] - 0.5, BOX_FACES[1:])
    refused = run("open.obj", "box", "--poses", "poses.csv").stderr
    assert "open.obj does not bound" in refused and "ask for --repair" in refused, refused
    closed = run("open.obj", "box", "--poses", "poses.csv", "--spheres", "500", "--repair")
    shared = np.array([float(line.split(",")[1]) for line in closed.stdout.splitlines()[1:]])
    np.testing.assert_allclose(shared, [0.9, 0.5, 0], rtol=0.1)
    exact = run("box", "box", "--poses", "poses.csv", "--spheres", "500", "--exact")
    try:
        import manifold3d  # noqa: F401
    except ImportError:
        assert exact.returncode == 1 and "pip install manifold3d" in exact.stderr
        return
    assert exact.returncode == 0, exact.stderr
    table = np.array([[float(x) for x in line.split(",")] for line in exact.stdout.splitlines()[1:]])
    sides = np.ptp(innersphere.solid("box")[0], axis=0)
    np.testing.assert_allclose(table[:, 2], np.maximum(sides[0] - rows[:, 3], 0) * sides[1] * sides[2], rtol=1e-6)
    np.testing.assert_allclose(table[:, 1], table[:, 2], rtol=0.1)
    assert "mean error" in exact.stderr
