"""Packings: how they are made, what they tell, and that they survive files, pickles and threads."""

import copy
import inspect
import multiprocessing
import os
import pickle
import signal
import subprocess
import sys
import textwrap
import threading
from types import SimpleNamespace

import numpy as np
import pytest
from conftest import BOX_FACES, BOX_VERTICES, write_obj, write_spheres

import innersphere
from innersphere import _core


def test_spheres_lie_in_the_box_and_do_not_overlap(box):
    spheres = box.spheres.astype(np.float64)
    centres, radii = spheres[:, :3], spheres[:, 3]
    assert len(box) == len(spheres) == 300
    rounding = 1e-6
    assert (centres - radii[:, None] > -rounding).all()
    assert (centres + radii[:, None] < np.array([1, 2, 3]) + rounding).all()
    assert (np.diff(radii) <= 0).all()
    distance = np.linalg.norm(centres[:, None] - centres[None], axis=2) + 10 * np.eye(300)
    assert (distance - radii[:, None] - radii[None] > -rounding).all()
    filled = (4 / 3 * np.pi * radii**3).sum() / 6
    assert 0.5 < filled < 1
    assert box.quality["density"] == pytest.approx(filled, rel=1e-5)


def test_mass_properties_are_those_of_the_box(box):
    assert box.volume == pytest.approx(6)
    np.testing.assert_allclose(box.center_of_mass, [0.5, 1, 1.5])
    np.testing.assert_allclose(box.inertia, np.diag([4 + 9, 1 + 9, 1 + 4]) * 6 / 12, atol=1e-12)
    assert box.inertia.shape == (3, 3) and box.inertia.dtype == np.float64


def test_the_surface_is_that_of_the_mesh(box):
    assert box.vertices.dtype == np.float32 and box.faces.dtype == np.uint32
    a, b, c = np.moveaxis(box.vertices[box.faces].astype(float), 1, 0)
    assert np.einsum("ij,ij->", a, np.cross(b, c)) / 6 == pytest.approx(6)  # the divergence theorem


def test_views_share_memory_outlive_the_packing_and_cannot_be_written(tmp_path):
    packing = innersphere.read(write_spheres(tmp_path / "two.xyzr", [[0, 0, 0, 2], [5, 0, 0, 1]]))
    views = [packing.spheres, packing.spheres]
    assert np.shares_memory(*views)
    assert np.shares_memory(packing[:1].spheres, packing.spheres)
    del packing
    np.testing.assert_array_equal(views[0], [[0, 0, 0, 2], [5, 0, 0, 1]])
    with pytest.raises(ValueError, match="read-only"):
        views[0][0] = 0


def test_slices_are_the_first_spheres(box):
    coarse = box[:64]
    assert len(coarse) == 64
    np.testing.assert_array_equal(coarse.spheres, box.spheres[:64])
    radii = coarse.spheres[:, 3].astype(float)
    assert coarse.quality["density"] == pytest.approx((4 / 3 * np.pi * radii**3).sum() / 6)
    assert np.isnan(box[:100].quality["gap_max"]) and coarse.quality["gap_max"] > box.quality["gap_max"] > 0
    assert coarse.volume == box.volume
    assert len(box[:]) == len(box[: 10**9]) == 300 and len(box[:-100]) == 200 and len(coarse[:10]) == 10
    for wrong in (slice(1, 10), slice(None, None, 2), slice(0, 0), slice(None, None, -1)):
        with pytest.raises(ValueError, match=r"\[:n\]"):
            box[wrong]
    with pytest.raises(TypeError, match="slices"):
        box[0]


def test_errors_of_overlaps_are_told(box):
    assert box.overlap_errors == ()
    packing = innersphere.pack((BOX_VERTICES, BOX_FACES), spheres=300)
    counts = [count for count, _, _ in packing.overlap_errors]
    assert counts == [64, 128, 256, 300]
    for _, raw, volume_true in packing.overlap_errors:
        depths, errors = zip(*volume_true)
        assert 0 < depths[0] and list(depths) == sorted(depths) and depths[-1] < 1
        assert all(0 < error <= 1 for error in errors)
        assert errors[-1] < raw[-1][1] < 1  # where it is deepest
    assert [count for count, _, _ in packing[:200].overlap_errors] == [64, 128]


def test_coverage_is_how_far_the_surface_is_from_the_first_spheres(box):
    assert box.order == "radius"
    assert box.coverage["count"].tolist() == [64, 128, 256, 300]
    assert box[:200].coverage["count"].tolist() == [64, 128]
    # Points spread evenly over the six sides of the box, beside all spheres.
    rng = np.random.default_rng(3)
    sides = rng.choice(6, 20000, p=np.array([6, 6, 3, 3, 2, 2]) / 22)
    points = rng.uniform(size=(20000, 3)) * [1, 2, 3]
    points[np.arange(20000), sides // 2] = np.where(sides % 2, np.array([1, 2, 3])[sides // 2], 0)
    for row in box.coverage:
        spheres = box.spheres[: row["count"]].astype(float)
        distance = (np.linalg.norm(points[:, None] - spheres[None, :, :3], axis=2) - spheres[:, 3]).min(axis=1)
        assert row["mean"] == pytest.approx(distance.mean(), rel=0.05)
        assert row["p95"] == pytest.approx(np.quantile(distance, 0.95), rel=0.1)
        assert 0.8 * distance.max() < row["max"] < 1.3 * distance.max()
        assert row["uncovered"] == pytest.approx((distance > 0.01 * np.sqrt(14)).mean(), abs=0.03)
        at = np.linalg.norm(row["farthest"] - spheres[:, :3], axis=1) - spheres[:, 3]
        assert at.min() == pytest.approx(row["max"], rel=1e-3)
    assert box.quality["gap_max"] == pytest.approx(box.coverage["max"][-1])
    assert box[:128].quality["gap_p95"] == box.coverage["p95"][1]


def test_packings_that_cover_first_survive_files_and_pickles(tmp_path):
    def block_with_a_rod(p):
        rod = np.maximum(np.hypot(p[:, 1], p[:, 2]) - 0.05, np.abs(p[:, 0] - 1.5) - 1.1)
        return np.minimum(np.abs(p).max(axis=1) - 0.5, rod)

    solid = innersphere.surface_of(block_with_a_rod, [-0.6, -0.6, -0.6], [2.7, 0.6, 0.6], cells=100)
    largest, covering = (
        innersphere.pack(solid, spheres=64, order=order, overlap_errors=False) for order in ("radius", "coverage")
    )
    assert largest.coverage["max"][-1] > 1 and covering.coverage["max"][-1] < 0.2  # the rod is 2.1 m long
    assert covering.order == "coverage"
    assert (np.diff(covering.spheres[:, 3]) > 0).any()
    covering.save(tmp_path / "rod.cbor")
    for again in (innersphere.read(tmp_path / "rod.cbor"), pickle.loads(pickle.dumps(covering))):
        assert again.order == "coverage"
        np.testing.assert_array_equal(again.coverage, covering.coverage)
        np.testing.assert_array_equal(again.spheres, covering.spheres)


def test_imported_spheres_have_no_coverage(ball):
    assert len(ball.coverage) == 0 and ball.coverage.dtype == innersphere.coverage_dtype


def test_paths_arrays_and_objects_give_the_same_packing(box, tmp_path):
    path = write_obj(tmp_path / "box.obj")
    as_object = SimpleNamespace(vertices=BOX_VERTICES, faces=BOX_FACES)
    for mesh in (path, str(path), as_object, [BOX_VERTICES.tolist(), BOX_FACES.tolist()]):
        other = innersphere.pack(mesh, spheres=300, overlap_errors=False)
        np.testing.assert_array_equal(other.spheres, box.spheres)
    assert innersphere.pack(path, spheres=1).provenance["source"] == str(path)
    assert innersphere.pack(as_object, spheres=1, name="crate").provenance["source"] == "crate"


@pytest.mark.parametrize("dtype", ["float32", "float64", "int32", ">f8"])
@pytest.mark.parametrize("index", ["int32", "uint8", "uint64", ">i8"])
def test_dtypes_of_meshes(box, dtype, index):
    other = innersphere.pack((BOX_VERTICES.astype(dtype), BOX_FACES.astype(index)), spheres=5, overlap_errors=False)
    np.testing.assert_array_equal(other.spheres[0], box.spheres[0])


def test_strided_and_read_only_meshes(box):
    vertices = np.repeat(BOX_VERTICES, 2, axis=0)[::2]
    faces = np.asfortranarray(BOX_FACES)
    faces.flags.writeable = False
    assert not vertices.flags.c_contiguous
    other = innersphere.pack((vertices, faces), spheres=300, overlap_errors=False)
    np.testing.assert_array_equal(other.spheres, box.spheres)


def test_scale(tmp_path):
    for mesh in ((1000 * BOX_VERTICES, BOX_FACES), write_obj(tmp_path / "box.obj", 1000 * BOX_VERTICES)):
        assert innersphere.pack(mesh, spheres=1, scale=0.001).volume == pytest.approx(6)
        with pytest.raises(innersphere.InvalidArgumentError, match="scale"):
            innersphere.pack(mesh, scale=-1)


# A corner of a cube, cut off: it has no symmetry that a mirror leaves as it is, and its moments are in closed form.
CORNER = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], dtype=float), np.array(
    [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]
)


@pytest.mark.parametrize("scale", [(-1, 1, 1), (2, 3, 0.5), (-0.02, 0.01, -0.04), [-1, -1, -1]])
def test_a_scale_for_each_axis(tmp_path, scale):
    a = np.array(scale, float)
    moments = np.abs(a.prod()) * np.outer(a, a) * (np.eye(3) / 120 + 1 / 120 - 1 / 96)
    for mesh in (CORNER, write_obj(tmp_path / "corner.obj", *CORNER)):
        packing = innersphere.pack(mesh, spheres=40, scale=scale, overlap_errors=False)
        assert not any("turned" in warning or "flipped" in warning for warning in packing.warnings)
        assert packing.volume == pytest.approx(np.abs(a.prod()) / 6)
        np.testing.assert_allclose(packing.origin + packing.center_of_mass, a / 4)
        inertia = np.trace(moments) * np.eye(3) - moments
        np.testing.assert_allclose(packing.inertia, inertia, atol=1e-9 * np.abs(inertia).max())
        # From the outside, counter-clockwise.
        corners = (packing.vertices + packing.origin)[packing.faces]
        assert np.linalg.det(corners).sum() / 6 == pytest.approx(packing.volume, rel=1e-5)
        assert {tuple(v) for v in packing.vertices + packing.origin} == {tuple(np.float32(v)) for v in CORNER[0] * a}
        balls = packing.spheres.astype(float)
        centres = (balls[:, :3] + packing.origin) / a  # of what was a corner of a cube
        assert (centres * np.abs(a) > balls[:, 3:] * (1 - 1e-5)).all()
        assert ((1 - centres.sum(1)) / np.linalg.norm(1 / a) > balls[:, 3] * (1 - 1e-5)).all()


def test_scales_have_packings_of_their_own(tmp_path):
    mesh, cache = write_obj(tmp_path / "corner.obj", *CORNER), tmp_path / "cache"

    def spheres(scale):
        return innersphere.pack(mesh, spheres=5, scale=scale, overlap_errors=False, cache=cache).spheres.tolist()

    scales = [2.0, (2, 2, -2), (-2, 2, 2), (2, 2, 1)]
    first = [spheres(scale) for scale in scales]
    assert len(list(cache.iterdir())) == 4 and all(a != b for i, a in enumerate(first) for b in first[:i])
    assert [spheres(scale) for scale in scales] == first and spheres([2, 2, 2]) == first[0]
    assert len(list(cache.iterdir())) == 4


@pytest.mark.parametrize(
    "scale, error, message",
    [
        ((1, 0, 1), innersphere.InvalidArgumentError, "scale is .*0.0.*; it must be finite and not 0"),
        ((1, 1, np.nan), innersphere.InvalidArgumentError, "scale is .*finite"),
        (-1, innersphere.InvalidArgumentError, "scale is -1; it must be positive"),
        ((1, 1), ValueError, r"scale has the shape \(2,\)"),
        ("1 1 1", TypeError, "scale"),
    ],
)
def test_bad_scales(tmp_path, scale, error, message):
    for mesh in (CORNER, write_obj(tmp_path / "corner.obj", *CORNER)):
        with pytest.raises(error, match=message):
            innersphere.pack(mesh, spheres=1, scale=scale)


def test_limits():
    mesh = (BOX_VERTICES, BOX_FACES)
    options = dict(overlap_errors=False)
    assert innersphere.pack(mesh, spheres=0, min_radius=0.2, **options).spheres[-1, 3] >= np.float32(0.2)
    assert innersphere.pack(mesh, spheres=0, density=0.6, **options).quality["density"] >= 0.6
    assert innersphere.pack(mesh, spheres=0, gap=0.5, **options).quality["gap_max"] <= 0.5


def test_defaults_are_those_of_the_library():
    parameters = inspect.signature(innersphere.pack).parameters
    assert {name: parameters[name].default for name in _core.pack_defaults} == _core.pack_defaults


@pytest.mark.parametrize(
    "mesh, error, message",
    [
        ((BOX_VERTICES, BOX_FACES[:-1]), innersphere.NotASolidError, "open"),
        ((BOX_VERTICES, BOX_FACES + 1), innersphere.InvalidArgumentError, "vertex 8"),
        ((BOX_VERTICES, BOX_FACES - 1), innersphere.InvalidArgumentError, "vertex -1"),
        ((BOX_VERTICES, BOX_FACES.astype("uint64") + 2**63), ValueError, "names no vertex"),
        ((BOX_VERTICES * [1, np.nan, 1], BOX_FACES), innersphere.NotFiniteError, "vertex 0 of mesh"),
        ((BOX_VERTICES + np.inf, BOX_FACES), innersphere.NotFiniteError, "vertex 0 of mesh"),
        ((np.zeros((0, 3)), np.zeros((0, 3), int)), innersphere.EmptyInputError, "triangles"),
        ((BOX_VERTICES, np.zeros((0, 3), int)), innersphere.EmptyInputError, "triangles"),
        (([], []), ValueError, "shape"),
        ((BOX_VERTICES[:, :2], BOX_FACES), ValueError, r"vertices has the shape \(8, 2\)"),
        ((BOX_VERTICES, BOX_FACES.reshape(-1, 4)), ValueError, r"faces has the shape \(9, 4\)"),
        ((BOX_VERTICES[0], BOX_FACES), ValueError, "vertices has the shape"),
        ((BOX_VERTICES, BOX_FACES.astype(float)), TypeError, "faces has the dtype float64"),
        ((BOX_VERTICES, BOX_FACES > 3), TypeError, "faces has the dtype bool"),
        ((BOX_VERTICES.astype(complex), BOX_FACES), TypeError, "vertices has the dtype complex"),
        ((BOX_VERTICES.astype(str), BOX_FACES), TypeError, "vertices has the dtype <U"),
        ((BOX_VERTICES,), ValueError, "1 parts"),
        (7, TypeError, "int"),
        (SimpleNamespace(geometry={}), TypeError, r"scene: scene.to_mesh\(\)"),
        ("no/such.obj", FileNotFoundError, "no/such.obj"),
    ],
)
def test_bad_meshes(mesh, error, message):
    with pytest.raises(error, match=message):
        innersphere.pack(mesh)


def test_holes_are_closed_on_request():
    packing = innersphere.pack((BOX_VERTICES, BOX_FACES[:-1]), spheres=10, repair=True)
    assert packing.volume == pytest.approx(6, rel=0.05)
    assert packing.warnings


@pytest.mark.parametrize("options", [dict(spheres=0), dict(spheres=-1), dict(delta=0.0), dict(density=2.0), dict(gap=np.nan), dict(threads=-1), dict(order='size')])
def test_bad_options(options):
    with pytest.raises(innersphere.InvalidArgumentError, match=next(iter(options))):
        innersphere.pack((BOX_VERTICES, BOX_FACES), **options)


def test_counts_may_be_written_as_floats():
    packing = innersphere.pack((BOX_VERTICES, BOX_FACES), spheres=1e1, threads=np.int32(1), overlap_errors=False)
    assert len(packing.spheres) == 10
    for bad in (1.5, "10", None):
        with pytest.raises(TypeError, match="spheres is .*whole number"):
            innersphere.pack((BOX_VERTICES, BOX_FACES), spheres=bad)


def test_too_large_a_radius():
    with pytest.raises(innersphere.NoSphereFitsError):
        innersphere.pack((BOX_VERTICES, BOX_FACES), min_radius=1.0)


@pytest.mark.parametrize("ending", ["cbor", "json"])
def test_files_keep_every_bit(box, tmp_path, ending):
    path = tmp_path / f"box.{ending}"
    box.save(path)
    again = innersphere.read(path)
    for name in ("spheres", "vertices", "faces", "center_of_mass", "inertia", "origin"):
        np.testing.assert_array_equal(getattr(again, name), getattr(box, name))
    assert again.quality == box.quality and again.provenance == box.provenance
    with pytest.raises(FileExistsError) as caught:
        box.save(path)
    assert isinstance(caught.value, innersphere.Error) and caught.value.code == "file_exists"
    box.save(path, overwrite=True)


def test_bad_files(box, tmp_path):
    with pytest.raises(innersphere.InvalidArgumentError, match="slice"):
        box[:10].save(tmp_path / "slice.cbor")
    with pytest.raises(innersphere.InvalidArgumentError, match="written to"):
        box.save(tmp_path / "box.stl")
    with pytest.raises(innersphere.WriteError):
        box.save(tmp_path / "no" / "folder.cbor")
    with pytest.raises(FileNotFoundError):
        innersphere.read(tmp_path / "none.cbor")
    (tmp_path / "damaged.cbor").write_bytes(b"\xa1")
    with pytest.raises(innersphere.FormatError, match="damaged.cbor"):
        innersphere.read(tmp_path / "damaged.cbor")
    assert not (tmp_path / "slice.cbor").exists() and not (tmp_path / "box.stl").exists()


def test_a_full_disk_is_an_error_and_nothing_is_left(tmp_path):
    """A limit of the size of files does what a full disk does."""
    script = """
        import resource, warnings, innersphere
        from innersphere import robots
        solid, warnings.showwarning = innersphere.solid("nut"), lambda message, *_: print(message)
        resource.setrlimit(resource.RLIMIT_FSIZE, (1000, 1000))
        packing = innersphere.pack(solid, spheres=100, overlap_errors=False, cache="cache")  # goes on without
        for write, name in ((packing.save, "a.cbor"), (lambda name: robots.write_mjcf(name, packing), "a.xml")):
            try:
                write(name)
            except innersphere.WriteError as error:
                print(error)
    """
    done = subprocess.run(
        [sys.executable, "-c", textwrap.dedent(script)], capture_output=True, text=True, cwd=tmp_path
    )
    assert done.returncode == 0, done.stderr
    kept, saved, written = done.stdout.strip().split("\n")
    assert "not kept" in kept and "a.cbor" in saved and "a.xml" in written and done.stdout.count("File too large") == 3
    assert [path for path in tmp_path.rglob("*") if path.is_file()] == []


def test_pickles_and_copies(box):
    for packing in (box, box[:100]):
        again = pickle.loads(pickle.dumps(packing))
        np.testing.assert_array_equal(again.spheres, packing.spheres)
        assert len(again) == len(packing)
        assert again.volume == packing.volume
    assert len(pickle.loads(pickle.dumps(box[:100]))[:50]) == 50
    assert copy.copy(box) is box and copy.deepcopy([box])[0] is box


def test_equal_are_packings_of_which_all_is_equal(box, ball, tmp_path):
    box.save(tmp_path / "box.json")
    made_again = innersphere.pack((BOX_VERTICES, BOX_FACES), spheres=300, overlap_errors=False)
    same = [pickle.loads(pickle.dumps(box)), innersphere.read(tmp_path / "box.json"), made_again, box[:300]]
    for other in same:
        assert other == box and not other != box and hash(other) == hash(box)
        assert other[:100] == box[:100] and other[:100] != box and other[:100] != box[:101]
    assert {box: 1}[same[0]] == 1 and len({box, *same}) == 1
    # Of imported spheres little is known: those numbers are nan.
    assert np.isnan(ball.quality["largest_missing_radius"]) and pickle.loads(pickle.dumps(ball)) == ball
    assert all(box != other for other in (ball, 300, None, "box"))
    one_more_bit = np.nextafter(box.spheres[-1, 3], np.float32(9))
    text = (tmp_path / "box.json").read_text()
    for number, instead in ((str(box.spheres[-1, 3]), str(one_more_bit)), (f"{box.volume!r}", "6.5"), ('"mesh"', '"crate"')):
        assert number in text, number
        (tmp_path / "other.json").write_text(text.replace(number, instead, 1))
        assert innersphere.read(tmp_path / "other.json") != box


def test_damaged_pickles(box):
    data, count = box.__getstate__()
    for wrong in ((data[: len(data) // 2], count), (data, count + 1), (data, 0), (b"", 1)):
        with pytest.raises(innersphere.FormatError):
            innersphere.Packing.__new__(innersphere.Packing).__setstate__(wrong)


def _volume(packing):
    return innersphere.Query("cpu").overlap(packing, packing)["volume"]


def test_packings_go_to_other_processes(box):
    with multiprocessing.get_context("spawn").Pool(1) as pool:
        assert pool.apply(_volume, (box,)) == _volume(box)


def test_the_cache_is_read(tmp_path):
    mesh = (BOX_VERTICES, BOX_FACES)
    first = innersphere.pack(mesh, spheres=20, cache=tmp_path / "cache")
    (file,) = (tmp_path / "cache").iterdir()
    stages = []
    again = innersphere.pack(mesh, spheres=20, cache=tmp_path / "cache", progress=lambda *now: stages.append(now))
    np.testing.assert_array_equal(again.spheres, first.spheres)
    assert not stages
    file.write_bytes(b"damaged")
    with pytest.warns(RuntimeWarning, match="packed anew"):
        innersphere.pack(mesh, spheres=20, cache=tmp_path / "cache")


def test_progress_is_told_and_can_cancel(capsys):
    mesh = (BOX_VERTICES, BOX_FACES)
    seen = []
    innersphere.pack(mesh, spheres=100, progress=lambda stage, fraction: seen.append((stage, fraction)))
    assert seen[0][0] == "packing" and seen[-1] == ("measuring", 1.0)
    assert all(0 <= fraction <= 1 for _, fraction in seen)
    with pytest.raises(innersphere.CancelledError):
        innersphere.pack(mesh, progress=lambda *_: False)

    def fail(stage, fraction):
        raise LookupError("the user's own")

    with pytest.raises(LookupError, match="the user's own"):
        innersphere.pack(mesh, progress=fail)
    with pytest.raises(TypeError, match="progress"):
        innersphere.pack(mesh, progress=3)
    capsys.readouterr()
    innersphere.pack(mesh, spheres=100, progress=True)
    shown = capsys.readouterr()
    assert "packing" in shown.err and "100 %" in shown.err and not shown.out
    assert shown.err.endswith("\r")


@pytest.fixture
def ctrl_c():
    """Ctrl-C as a terminal has it: a shell lets programs in the background ignore it."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


def test_ctrl_c_ends_packing(ctrl_c):
    sent = []

    def interrupt(stage, fraction):
        if not sent:  # one that comes late would end pytest
            sent.append(stage)
            os.kill(os.getpid(), signal.SIGINT)

    with pytest.raises(KeyboardInterrupt):
        innersphere.pack((BOX_VERTICES, BOX_FACES), spheres=100000, progress=interrupt)
    timer = threading.Timer(0.3, lambda: os.kill(os.getpid(), signal.SIGINT))
    with pytest.raises(KeyboardInterrupt):  # without a callback of the user's, too
        timer.start()
        innersphere.pack((BOX_VERTICES, BOX_FACES), spheres=1000000)
    timer.join()


def test_names():
    assert repr(innersphere.read).startswith("<function")
    assert set(innersphere.__all__) <= set(dir(innersphere))
    for name in innersphere.__all__:
        thing = getattr(innersphere, name)
        if isinstance(thing, type) or callable(thing):
            assert thing.__doc__, name


def test_repr(box):
    assert repr(box[:64]).startswith("<innersphere.Packing: 64 spheres, ")


def test_messages_name_what_python_has(tmp_path):
    packing = innersphere.pack((BOX_VERTICES, BOX_FACES), spheres=10, overlap_errors=False)
    packing.save(tmp_path / "box.json")
    with pytest.raises(innersphere.FileThereError, match="overwrite=True"):
        packing.save(tmp_path / "box.json")
    with pytest.raises(innersphere.NotASolidError, match="repair=True") as error:
        innersphere.pack((BOX_VERTICES, BOX_FACES[:-1]), spheres=10)
    assert "--" not in str(error.value)
    with pytest.raises(innersphere.NoSphereFitsError) as error:
        innersphere.pack((np.array(BOX_VERTICES) * [1, 1, 1e-6], BOX_FACES), spheres=10)
    assert "--" not in str(error.value)
    with pytest.raises(innersphere.InvalidArgumentError, match="a quaternion has to have the length 1"):
        innersphere.Query("cpu").overlap(packing, packing, pose_b=([0, 0, 0], [0, 0, 0, 2]))
    for shared in (5.0, np.zeros(3), {"volume": 1.0}):
        with pytest.raises(TypeError, match="Query.overlap"):
            innersphere.expected_error(packing, packing, shared)
