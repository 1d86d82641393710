"""Overlaps beside closed forms and sums over all pairs of spheres, and what bad poses do."""

import json
import threading
import time

import numpy as np
import pytest
from conftest import BOX_FACES, BOX_VERTICES, brute_force, lens, matrix, placed, random_quaternions, write_spheres

import innersphere
from innersphere import Query

NO_TURN = [0.0, 0.0, 0.0, 1.0]
WORDS = innersphere.overlap_dtype.names


def moved(x, y=0.0, z=0.0):
    pose = np.eye(4)
    pose[:3, 3] = x, y, z
    return pose


def random_poses(rng, n, spread):
    """n positions and quaternions, and the same as matrices."""
    positions, quaternions = spread * rng.uniform(-1, 1, (n, 3)), random_quaternions(rng, n)
    return (positions, quaternions), np.array([matrix(p, q) for p, q in zip(positions, quaternions)])


def test_two_balls_share_a_lens(ball, backends):
    distance = np.linspace(0, 2.5, 51)
    poses = np.tile(np.eye(4), (51, 1, 1))
    poses[:, 0, 3] = distance
    for backend in backends:
        got = Query(backend).overlap(ball, ball, pose_b=poses)
        np.testing.assert_allclose(got["volume"], lens(distance, 1, 1), rtol=1e-5, atol=1e-6)
        rim = np.pi * np.maximum(1 - distance**2 / 4, 0)
        np.testing.assert_allclose(got["area"][1:, 0], rim[1:], rtol=1e-5, atol=1e-6)
        np.testing.assert_allclose(got["centroid"][1:40, 0], distance[1:40] / 2, rtol=1e-5)
        np.testing.assert_array_equal(got["pair_count"], distance < 2)
        np.testing.assert_allclose(got["force"][1:, 0], lens(distance, 1, 1)[1:], rtol=1e-5, atol=1e-6)


def test_random_poses_beside_all_pairs_of_spheres(box, backends):
    rng = np.random.default_rng(1)
    (pose_a, matrix_a), (pose_b, matrix_b) = random_poses(rng, 20, 1), random_poses(rng, 20, 1)
    truth = [brute_force(box.spheres, box.spheres, a, b) for a, b in zip(matrix_a, matrix_b)]
    volume = np.array([t[0] for t in truth])
    surely = [(t[1] > 1e-5).sum() for t in truth]
    maybe = [(t[1] > -1e-5).sum() for t in truth]
    assert (volume > 0.01).sum() > 5
    for backend in backends:
        query = Query(backend)
        by_quaternion = query.overlap(box, box, pose_a, pose_b, estimator="raw")
        by_matrix = query.overlap(box, box, matrix_a, matrix_b, estimator="raw")
        for got in (by_quaternion, by_matrix):
            np.testing.assert_allclose(got["volume"], volume, rtol=1e-4, atol=1e-6)
            assert (got["pair_count"] >= surely).all() and (got["pair_count"] <= maybe).all()


def test_volumes_of_boxes():
    box = innersphere.pack((BOX_VERTICES, BOX_FACES), spheres=1000, overlap_errors=False)
    shift = np.array([0.1, 0.3, 0.5])
    poses = np.tile(np.eye(4), (3, 1, 1))
    poses[:, 2, 3] = 3 - shift * 3
    got = Query().overlap(box, box, pose_b=poses)
    np.testing.assert_allclose(got["volume"], 6 * shift, rtol=0.05)  # as near as a thousand spheres come
    np.testing.assert_allclose(got["centroid"], [[0.5, 1, 3 - 1.5 * s] for s in shift], atol=0.1)
    np.testing.assert_allclose(got["area"][:, 2], 2, rtol=0.15)


def test_force_and_torque_are_minus_the_gradient_of_the_energy(box):
    query, step = Query(), 1e-4
    rng = np.random.default_rng(2)
    q = random_quaternions(rng)
    place = np.array([0.4, 0.8, 0.9])

    def energy(position, turn):
        pose = matrix(position, q)
        pose[:3, :3] = matrix([0, 0, 0], turn)[:3, :3] @ pose[:3, :3]
        return query.overlap(box, box, pose_b=pose)["energy"]

    got = query.overlap(box, box, pose_b=(place, q))
    force, torque = np.zeros(3), np.zeros(3)
    for k in range(3):
        e = np.eye(3)[k]
        force[k] = -(energy(place + step * e, NO_TURN) - energy(place - step * e, NO_TURN)) / (2 * step)
        turn = np.append(np.sin(step / 2) * e, np.cos(step / 2))
        back = np.append(-turn[:3], turn[3])
        torque[k] = -(energy(place, turn) - energy(place, back)) / (2 * step)
    np.testing.assert_allclose(got["force"], force, atol=1e-3 * np.linalg.norm(force))
    np.testing.assert_allclose(got["torque"], torque, atol=1e-3 * np.linalg.norm(torque))


def test_slices_use_fewer_spheres(box):
    pose = moved(0.3, 0.2)
    expected, _ = brute_force(box.spheres[:50], box.spheres[:120], np.eye(4), pose)
    got = Query().overlap(box[:50], box[:120], pose_b=pose, estimator="raw")
    assert got["volume"] == pytest.approx(expected, rel=1e-4)


def test_expected_errors_are_those_of_the_file(tmp_path):
    packing = innersphere.pack(innersphere.solid("lbracket"), spheres=300)
    packing.save(tmp_path / "p.json")
    kept = json.loads((tmp_path / "p.json").read_text())["errors_by_depth"]
    by_count = {row["count"]: row for row in kept["prefixes"]}
    size = packing.volume ** (1 / 3)
    for part, count in ((packing, 300), (packing[:200], 128)):
        for estimator in ("raw", "volume_true"):
            rows = by_count[300][estimator]
            depth, volume = np.array([row["depth"] for row in rows]), packing.volume * 0.1
            area = np.zeros((len(rows), 3))  # of a layer that is so deep
            area[:, 1] = np.sqrt(np.maximum((volume / (depth * size)) ** 2 - volume ** (4 / 3), 1e-12))
            layer = {"volume": np.full(len(rows), volume), "area": area, "stiffness": 100 * area[:, 1] + 100, "energy": area[:, 1]}
            got = innersphere.expected_error(part, packing, layer, estimator=estimator)
            layers = depth < 0.1 ** (1 / 3)  # others are deeper than this volume can be
            assert layers.sum() > 5
            for field in ("mean", "bound"):
                squares = 0  # of the logarithms of found over true
                for number, of in ((count, by_count[count][estimator]), (300, rows)):
                    at = np.log([r["depth"] for r in of])
                    error, measured = (np.exp(np.interp(np.log(depth), at, np.log([r[k] for r in of]))) for k in (field, "volume"))
                    power = np.interp(np.log(depth), at, [r["power"] for r in of])
                    error = np.minimum(error * (measured / 0.1) ** power, 1)
                    if estimator == "volume_true":  # no less than of a ball as large, inside
                        largest = by_count[number]["volume_true_inside"][-1]
                        assert largest["depth"] < 0.1
                        error = np.maximum(error, largest[field] * (largest["depth"] / 0.1) ** 0.5)
                    with np.errstate(divide="ignore"):
                        squares = squares + np.log1p(-error) ** 2
                np.testing.assert_allclose(got[field][layers], (1 - np.exp(-np.sqrt(squares / 2)))[layers])
            # Lenses without rims are thicker than those of any copy: planes tell of them, too, if no shallower than they.
            thick = innersphere.expected_error(part, packing, layer | {"stiffness": 0 * depth}, estimator=estimator)
            shallowest = min(by_count[number][estimator + "_planes"]["errors"][0]["depth"] for number in (count, 300))
            assert (thick["mean"] <= got["mean"]).all()
            assert (thick["mean"] == got["mean"])[depth < shallowest].all() and (depth < shallowest).sum() > 3
        half = {"volume": 0.4 * packing.volume, "area": [0, 0.4 * packing.volume / (0.3 * size), 0], "energy": 1}
        thin, thick = (innersphere.expected_error(part, packing, half | {"stiffness": s})["mean"] for s in (1e9, 0))
        assert thick < 0.9 * thin
    assert got.dtype == innersphere.expected_error_dtype
    query = Query()
    shared = query.overlap(packing, packing, pose_b=np.stack([moved(0.3, 0.2), moved(50, 0)]).reshape(2, 1, 4, 4))
    single = innersphere.expected_error(packing, packing, shared)
    assert single.shape == (2, 1) and np.isnan(single["mean"][1, 0])
    assert 0 < single["mean"][0, 0] < single["bound"][0, 0] < 1
    assert innersphere.expected_error(packing, packing, shared, estimator="surface")["bound"][0, 0] == 0
    without_area = query.overlap(packing, packing, pose_b=moved(0.3, 0.2), want="volume")
    assert np.isnan(innersphere.expected_error(packing, packing, without_area)["mean"])
    by_triangles = query.overlap(packing, packing, pose_b=np.stack([moved(0.3, 0.2), moved(50, 0)]), estimator="surface")
    with pytest.raises(innersphere.InvalidArgumentError, match="name the estimator"):
        innersphere.expected_error(packing, packing, by_triangles)
    assert innersphere.expected_error(packing, packing, by_triangles, estimator="surface")["mean"][0] == 0
    with pytest.raises(TypeError):
        innersphere.expected_error(packing, packing, "much")
    for rows in ("raw", "volume_true"):  # areas cancel where a solid lies upon itself: depth does not tell
        shared = query.overlap(packing, packing, estimator=rows)
        itself = innersphere.expected_error(packing, packing, shared, estimator=rows)
        copies, planes = by_count[300][rows], by_count[300][rows + "_planes"]
        is_thick = shared["volume"] > planes["thicker_than"] * size * shared["stiffness"]  # spheres are inside each other
        depth = shared["volume"] ** (1 / 3) / size

        def mean_at(depth, of, part=shared["volume"] / packing.volume):
            at = np.log([row["depth"] for row in of])
            mean, volume = (np.exp(np.interp(np.log(depth), at, np.log([row[field] for row in of]))) for field in ("mean", "volume"))
            return min(1, mean * (volume / part) ** np.interp(np.log(depth), at, [row["power"] for row in of]))

        if rows == "volume_true":  # copies that share so much have a row of their own
            assert itself["mean"] == pytest.approx(mean_at(1, by_count[300]["volume_true_deep"]))
            continue
        of_copies = mean_at(copies[-1]["depth"], copies)
        assert itself["mean"] == pytest.approx(min(of_copies, mean_at(depth, planes["errors"])) if is_thick else of_copies)
    with pytest.raises(innersphere.InvalidArgumentError):
        innersphere.expected_error(packing, packing, {"volume": [1, 2], "area": [[1, 0, 0]], "stiffness": [1, 1], "energy": [1, 1]})


def test_want(box):
    query = Query()
    pose = moved(0.3, 0.2)
    everything = query.overlap(box, box, pose_b=pose, want="wrench")
    volume = query.overlap(box, box, pose_b=pose, want="volume")
    touch = query.overlap(box, box, pose_b=pose, want="touch")
    for name in WORDS:
        wanted = name in ("volume", "centroid", "pair_count")
        np.testing.assert_array_equal(volume[name], everything[name] if wanted else 0 * everything[name])
        np.testing.assert_array_equal(touch[name], 1 if name == "pair_count" else 0 * everything[name])
    assert query.overlap(box, box, pose_b=moved(9), want="touch")["pair_count"] == 0


def test_margin(ball):
    got = Query().overlap(ball, ball, pose_b=moved(2.2), margin=0.5)
    assert got["volume"] == pytest.approx(lens(2.2, 1.5, 1), rel=1e-5)


def test_estimators(box):
    query = Query()
    volumes = {e: query.overlap(box, box, pose_b=moved(0, 0, 1.5), estimator=e)["volume"] for e in ("raw", "volume_true")}
    assert volumes["raw"] < volumes["volume_true"] == pytest.approx(3, rel=0.1)


def test_the_surface_of_two_cubes(backends):
    """Of side 2, one moved by (x, y, z): they share (2 - x)(2 - y)(2 - z), and minus the gradient of that is the area."""
    cube = innersphere.pack((2 * BOX_VERTICES / [1, 2, 3] - 1, BOX_FACES), spheres=64, overlap_errors=False)
    shift = np.array([[0.5, 0.5, 0.5], [0.5, 1.0, 1.5], [1.9, 0.0, -0.25], [2.1, 0, 0]])
    side = np.maximum(2 - np.abs(shift), 0)
    volume = side.prod(axis=1)
    assert volume[0] == 1.5**3
    turn = random_quaternions(np.random.default_rng(9))  # of both, about the origin: what they share turns along
    rotation = matrix(np.zeros(3), turn)[:3, :3]
    for backend in backends:
        query = Query(backend)
        got = query.overlap(cube, cube, None, (shift, NO_TURN), estimator="surface")
        np.testing.assert_allclose(got["volume"], volume, rtol=1e-6, atol=1e-12)
        np.testing.assert_allclose(got["centroid"][:3], shift[:3] / 2, atol=1e-6)
        for one, at, area in zip(got, shift, ([2.25, 2.25, 2.25], [0.5, 0.75, 1.5])):
            # Three faces of B are in A, and each is pushed where its middle is, relative to B.
            middles = np.where(np.eye(3) == 1, -1, -at / 2)
            torque = np.cross(middles, np.diag(area)).sum(axis=0)
            np.testing.assert_allclose(one["area"], area, rtol=1e-6)
            np.testing.assert_allclose(one["force"], area, rtol=1e-6)
            np.testing.assert_allclose(one["torque"], torque, atol=1e-6)
            assert (one["energy"], one["stiffness"]) == pytest.approx((one["volume"], sum(area)), rel=1e-6)
        turned = query.overlap(cube, cube, ([0, 0, 0], turn), (shift @ rotation.T, turn), estimator="surface")
        np.testing.assert_allclose(turned["volume"], volume, rtol=1e-5, atol=1e-12)
        np.testing.assert_allclose(turned["area"][0], rotation @ ([1.5**2] * 3), rtol=1e-4)
        few = query.overlap(cube[:8], cube, None, (shift[0], NO_TURN), estimator="surface")
        assert few["volume"] == pytest.approx(1.5**3, rel=1e-12)  # spheres have no part in it


def test_shapes_are_broadcast(ball):
    query = Query()
    x, y = np.array([0.0, 0.5, 1.0]), np.array([0.0, 1.5])
    a = np.tile(np.eye(4), (3, 1, 1, 1))
    a[:, 0, 0, 3] = x
    b = np.tile(np.eye(4), (2, 1, 1))
    b[:, 0, 3] = y
    got = query.overlap(ball, ball, a, b)
    assert got.shape == (3, 2) and got.dtype == innersphere.overlap_dtype
    np.testing.assert_allclose(got["volume"], lens(np.abs(x[:, None] - y), 1, 1), rtol=1e-5)
    mixed = query.overlap(ball, ball, pose_b=(np.stack([y, 0 * y, 0 * y], 1), NO_TURN))
    assert mixed.shape == (2,)
    np.testing.assert_array_equal(mixed, got[0])
    assert query.overlap(ball, ball, a, None).shape == (3, 1)
    single = query.overlap(ball, ball, pose_b=moved(1.5))
    assert single.shape == () and single["volume"] == got[0, 1]["volume"]


@pytest.mark.parametrize("shape", [(0,), (0, 3), (3, 0)])
def test_no_poses_no_results(ball, shape):
    got = Query().overlap(ball, ball, pose_b=np.empty((*shape, 4, 4)))
    assert got.shape == shape and got.dtype == innersphere.overlap_dtype
    pairs, first = Query().pairs(ball, ball, pose_b=np.empty((*shape, 4, 4)))
    assert len(pairs) == 0 and first.tolist() == [0]


def test_any_strides_and_types(box):
    query = Query()
    rng = np.random.default_rng(3)
    (positions, quaternions), poses = random_poses(rng, 8, 0.5)
    expected = query.overlap(box, box, pose_b=poses)
    read_only = poses.copy()
    read_only.flags.writeable = False
    for same in (read_only, np.asfortranarray(poses), poses.tolist(), poses[::-1].copy()[::-1], poses.astype(">f8")):
        np.testing.assert_array_equal(query.overlap(box, box, pose_b=same), expected)
    transposed = np.ascontiguousarray(poses.swapaxes(1, 2)).swapaxes(1, 2)
    np.testing.assert_array_equal(query.overlap(box, box, pose_b=transposed), expected)
    np.testing.assert_array_equal(query.overlap(box, box, pose_b=poses[::3]), expected[::3])
    together = np.concatenate([positions, quaternions], axis=1)  # rows of seven numbers
    np.testing.assert_array_equal(
        query.overlap(box, box, pose_b=(together[:, :3], together[:, 3:])),
        query.overlap(box, box, pose_b=(positions, quaternions)),
    )
    single = query.overlap(box, box, pose_b=poses.astype(np.float32))
    np.testing.assert_allclose(single["volume"], expected["volume"], atol=1e-4)
    whole = query.overlap(box, box, pose_b=moved(0, 1).astype(int))
    assert whole == query.overlap(box, box, pose_b=moved(0, 1))


@pytest.mark.parametrize(
    "pose, error, message",
    [
        (np.eye(3), ValueError, r"pose_b has the shape \(3, 3\); it must be \(..., 4, 4\)"),
        (np.zeros(16), ValueError, "shape"),
        (7, ValueError, "shape"),
        ([], ValueError, "shape"),
        ([[1, 0], [1]], ValueError, "pose_b"),
        ("here", TypeError, "dtype"),
        (np.eye(4, dtype=complex), TypeError, "complex"),
        (np.eye(4, dtype=bool), TypeError, "bool"),
        (np.eye(4).astype(object), TypeError, "object"),
        (([0, 0, 0], [0, 0, 1]), ValueError, "the quaternion of pose_b"),
        (([0, 0], NO_TURN), ValueError, "the position of pose_b"),
        ((np.eye(4), np.eye(4)), ValueError, "the position of pose_b"),
        (([0, 0, 0],), ValueError, "tuple of 1"),
        ([[0, 0, 0], [0, 0, 0, 1]], ValueError, "pose_b has rows of different lengths.*a tuple of positions"),
        ((np.zeros((2, 3)), np.zeros((3, 4))), ValueError, "broadcast"),
    ],
)
def test_wrong_shapes_and_types(ball, pose, error, message):
    for call in (Query().overlap, Query().pairs):
        with pytest.raises(error, match=message):
            call(ball, ball, pose_b=pose)


def test_poses_that_do_not_fit_together(ball):
    with pytest.raises(ValueError, match=r"pose_a and pose_b .* \(2,\) and \(3,\)"):
        Query().overlap(ball, ball, np.zeros((2, 4, 4)), np.zeros((3, 4, 4)))


def numbered(wrong):
    poses = np.tile(np.eye(4), (4, 5, 1, 1))
    poses[2, 3] = wrong
    return poses


@pytest.mark.parametrize(
    "poses, error",
    [
        (numbered(np.diag([1, 1, np.nan, 1])), innersphere.NotFiniteError),
        (numbered(np.full((4, 4), np.nan)), innersphere.NotFiniteError),
        (numbered(moved(np.inf)), innersphere.NotFiniteError),
        (numbered(np.diag([1, 1, -1, 1])), innersphere.InvalidArgumentError),
        (numbered(np.diag([2, 2, 2, 1])), innersphere.InvalidArgumentError),
        (numbered(np.zeros((4, 4))), innersphere.InvalidArgumentError),
        (numbered(moved(1).T), innersphere.InvalidArgumentError),
        ((np.zeros((20, 3)), np.array(17 * [NO_TURN] + [[0, 0, 0, 0]] + 2 * [NO_TURN])), innersphere.InvalidArgumentError),
        ((np.zeros((20, 3)), np.array(17 * [NO_TURN] + [[0, 0, np.nan, 1]] + 2 * [NO_TURN])), innersphere.NotFiniteError),
    ],
)
def test_a_bad_pose_is_named_by_its_number(ball, poses, error):
    query = Query()
    number = 17 if isinstance(poses, tuple) else 2 * 5 + 3
    for call in (query.overlap, query.pairs):
        with pytest.raises(error, match=rf"^query {number}: "):
            call(ball, ball, pose_b=poses)
    assert query.overlap(ball, ball)["volume"] == pytest.approx(4 / 3 * np.pi)  # the query stays usable


@pytest.mark.parametrize("words", [dict(want="all"), dict(estimator="true"), dict(margin=-1.0), dict(margin=np.nan)])
def test_bad_options(ball, words):
    with pytest.raises(ValueError):
        Query().overlap(ball, ball, **words)


def test_bad_backends():
    with pytest.raises(innersphere.InvalidArgumentError, match="'auto', 'cpu', 'cuda'"):
        Query("gpu")
    for threads in (-1, 10**7, 10**8, 10**10):
        with pytest.raises(innersphere.InvalidArgumentError, match="threads"):
            Query("cpu", threads=threads)
    if not innersphere.cuda_available():
        with pytest.raises(innersphere.NoDeviceError):
            Query("cuda")
    with pytest.raises(innersphere.NoDeviceError):
        Query("cuda", device=innersphere.cuda_device_count())
    for device in (-1, "both"):
        with pytest.raises(ValueError, match="device"):
            Query(device=device)


def test_arrays_in_a_row_are_read_in_place_to_the_same_bits(box):
    """One array in C's order takes another way than a list of single queries, and than any other array."""
    rng = np.random.default_rng(5)
    positions = rng.uniform(-1.2, 1.2, (2, 40, 3))
    quaternions = rng.normal(size=(2, 40, 4))
    quaternions /= np.linalg.norm(quaternions, axis=-1, keepdims=True)
    matrices = np.tile(np.eye(4), (2, 40, 1, 1))
    x, y, z, w = np.moveaxis(quaternions, -1, 0)
    matrices[..., :3, :3] = np.moveaxis(
        np.array(
            [
                [w * w + x * x - y * y - z * z, 2 * (x * y - z * w), 2 * (x * z + y * w)],
                [2 * (x * y + z * w), w * w - x * x + y * y - z * z, 2 * (y * z - x * w)],
                [2 * (x * z - y * w), 2 * (y * z + x * w), w * w - x * x - y * y + z * z],
            ]
        ),
        (0, 1),
        (-2, -1),
    )
    matrices[..., :3, 3] = positions
    place_a = np.eye(4)
    place_a[:3, 3] = 0.1, 0.2, -0.1
    query = Query()
    in_row = query.overlap(box, box, place_a, matrices)
    assert in_row.shape == (2, 40) and (in_row["pair_count"] > 0).any() and (in_row["pair_count"] == 0).any()
    assert query.overlap(box, box, place_a, (positions, quaternions)).tobytes() == in_row.tobytes()
    assert query.overlap(box, box, place_a, np.asfortranarray(matrices)).tobytes() == in_row.tobytes()
    for at in np.ndindex(2, 40):
        assert query.overlap(box, box, place_a, matrices[at]).tobytes() == in_row[at].tobytes()


def test_results_into_an_array_of_the_users(box):
    query = Query("cpu")
    rng = np.random.default_rng(6)
    positions = rng.uniform(-1, 1, (2, 5, 3))
    turns = random_quaternions(rng, 2, 5)
    for pose_a in (None, (np.zeros((5, 3)), [0, 0, 0, 1])):  # in place, and pose by pose
        expected = query.overlap(box, box, pose_a, (positions, turns))
        out = np.full((2, 5, 16), np.nan)
        assert query.overlap(box, box, pose_a, (positions, turns), out=out) is out
        assert out.tobytes() == expected.tobytes()
        assert out.view(innersphere.overlap_dtype)[..., 0]["pair_count"].tolist() == expected["pair_count"].tolist()
    single = np.zeros(16)
    assert query.overlap(box, box, out=single)[0] == query.overlap(box, box)["volume"]
    read_only = np.zeros((2, 5, 16))
    read_only.flags.writeable = False
    for wrong, error in (
        (np.zeros((2, 5, 15)), ValueError),
        (np.zeros((10, 16)), ValueError),
        (np.zeros((2, 5, 16), np.float32), TypeError),
        (np.zeros((2, 5, 32))[..., ::2], TypeError),
        (read_only, TypeError),
        ("out", TypeError),
    ):
        with pytest.raises(error, match="out must"):
            query.overlap(box, box, None, (positions, turns), out=wrong)


def test_not_packings(ball):
    with pytest.raises(TypeError):
        Query().overlap(ball, ball.spheres)


def test_the_backend_is_told(ball, backends):
    query = Query("cpu")
    assert query.last_backend == "cpu"
    for backend in backends[2:]:
        query = Query(backend)
        query.overlap(ball, ball)
        assert query.last_backend == backend


def test_pairs_are_those_that_overlap(box):
    rng = np.random.default_rng(4)
    poses, matrices = random_poses(rng, 6, 1.5)
    pairs, first = Query().pairs(box[:100], box, pose_b=poses, estimator="raw")
    assert pairs.dtype == innersphere.pair_dtype and first.shape == (7,)
    found = 0
    for i, pose in enumerate(matrices):
        _, depth = brute_force(box.spheres[:100], box.spheres, np.eye(4), pose)
        got = {(int(a), int(b)) for a, b in pairs[first[i] : first[i + 1]]}
        assert len(got) == first[i + 1] - first[i]
        assert got >= set(map(tuple, np.argwhere(depth > 1e-5)))
        assert got <= set(map(tuple, np.argwhere(depth > -1e-5)))
        found += len(got)
    assert found > 100


def test_contacts_sum_to_the_overlap(box):
    rng = np.random.default_rng(8)
    poses, matrices = random_poses(rng, 5, 1.0)
    query = Query()
    for far in (np.zeros(3), np.array([1000.0, -2000.0, 500.0])):
        solid = innersphere.pack((BOX_VERTICES + far, BOX_FACES), spheres=100, overlap_errors=False)
        shift = moved(*-far)  # back to where the box is
        pose_b = matrices @ shift
        whole = query.overlap(solid, solid, shift, pose_b)
        (of_a, first_a), (of_b, first_b) = query.contacts(solid, solid, shift, pose_b)
        assert of_a.dtype == innersphere.sphere_contact_dtype and len(first_a) == len(first_b) == 6
        for i in range(5):
            for rows in (of_a[first_a[i] : first_a[i + 1]], of_b[first_b[i] : first_b[i + 1]]):
                assert rows["volume"].sum() == pytest.approx(whole[i]["volume"], rel=1e-4, abs=1e-6)
                np.testing.assert_allclose(rows["area"].sum(0), whole[i]["area"], atol=1e-4)
                assert (np.diff(rows["sphere"].astype(int)) > 0).all()
                mean = (rows["volume"][:, None] * rows["centroid"]).sum(0)
                np.testing.assert_allclose(mean, whole[i]["volume"] * whole[i]["centroid"], atol=1e-3 * (1 + np.abs(far).max()))
            # Each sphere of A has the lenses with all of B.
            (a, r), (b, s) = placed(solid.spheres, matrix(solid.origin - far, NO_TURN)), placed(solid.spheres, pose_b[i] @ moved(*solid.origin))
            shares = lens(np.linalg.norm(a[:, None] - b[None], axis=2), r[:, None], s[None]).sum(1)
            raw, first = query.contacts(solid, solid, shift, pose_b[i], estimator="raw")[0]
            expected = np.zeros(100)
            expected[raw["sphere"]] = raw["volume"]
            np.testing.assert_allclose(expected, shares, atol=2e-4)


class OnlyDLPack:
    """An array of another library, which knows of no numpy."""

    def __init__(self, array, device=(1, 0)):
        self._array, self._device = array, device

    def __dlpack__(self, stream=None, **options):
        return self._array.__dlpack__(**options)

    def __dlpack_device__(self):
        return self._device


class OnDevice(OnlyDLPack):
    """As torch and cupy hand out what lies on a device: not at all, until it is asked to come."""

    def __dlpack__(self, **options):
        raise BufferError("on a device")

    def cpu(self):
        return OnlyDLPack(self._array)


def test_arrays_of_other_libraries(box):
    query = Query()
    poses = np.array([moved(0.1), moved(0.2, 0.3)])
    expected = query.overlap(box, box, pose_b=poses)
    for other in (OnlyDLPack(poses), OnDevice(poses, (2, 0))):
        np.testing.assert_array_equal(query.overlap(box, box, pose_b=other), expected)
    single = query.overlap(box, box, pose_b=OnlyDLPack(poses.astype(np.float32)))
    if not innersphere.cuda_available():
        with pytest.raises(innersphere.NoDeviceError, match="out"):
            query.overlap(box, box, pose_b=poses, out=OnlyDLPack(np.zeros((2, 16)), (2, 0)))
    np.testing.assert_allclose(single["volume"], expected["volume"], rtol=1e-5)


def test_results_outlive_the_query_and_can_be_written(ball):
    got = Query().overlap(ball, ball, pose_b=np.tile(moved(1), (3, 1, 1)))
    again = got.copy()
    for _ in range(10):
        Query().overlap(ball, ball, pose_b=np.tile(moved(0.5), (3, 1, 1)))
    np.testing.assert_array_equal(got, again)
    got["volume"] = 0
    assert (got["volume"] == 0).all()


def test_a_solid_far_from_its_origin():
    """Its packing has a frame of its own; poses and results are in that of the solid all the same."""
    far = np.array([1000.0, -2000.0, 500.0])
    options = dict(spheres=200, overlap_errors=False)
    near = innersphere.pack((BOX_VERTICES, BOX_FACES), **options)
    there = innersphere.pack((BOX_VERTICES + far, BOX_FACES), **options)
    assert np.abs(there.origin - far).max() < 10
    turn = random_quaternions(np.random.default_rng(5))
    pose = matrix([0.2, 0.3, 0.4], turn)
    back = pose.copy()  # takes the far solid to where `pose` takes the near one
    back[:3, 3] -= pose[:3, :3] @ far
    query = Query()
    expected = query.overlap(near, near, pose_b=pose)
    got = query.overlap(there, there, moved(*-far), back)
    assert got["volume"] == pytest.approx(expected["volume"], rel=1e-3)
    np.testing.assert_allclose(got["centroid"] - far, expected["centroid"], atol=1e-3)
    np.testing.assert_allclose(got["force"], expected["force"], rtol=0.01, atol=1e-3)
    # The same wrench, about another point.
    arm = pose[:3, 3] - back[:3, 3]
    np.testing.assert_allclose(got["torque"] - np.cross(arm, got["force"]), expected["torque"], atol=0.01)


def test_the_gil_is_free_while_a_query_runs(box):
    poses = np.tile(moved(0.1, 0.1, 0.1), (20000, 1, 1))
    query = Query("cpu", threads=1)
    done = threading.Event()
    thread = threading.Thread(target=lambda: (query.overlap(box, box, pose_b=poses), done.set()))
    ticks = 0
    thread.start()
    while not done.is_set():
        time.sleep(0.001)
        ticks += 1
    thread.join()
    assert ticks > 10


def test_threads_may_share_packings_and_queries(box):
    rng = np.random.default_rng(6)
    poses, _ = random_poses(rng, 200, 1)
    shared = Query("cpu", threads=1)
    expected = shared.overlap(box, box, pose_b=poses)
    results = []

    def work(query):
        for n in (32, 64, 300):
            query.overlap(box[:n], box[:n], pose_b=poses)
        results.append(query.overlap(box, box, pose_b=poses))

    threads = [threading.Thread(target=work, args=(q,)) for q in (shared, shared, Query("cpu"), Query("auto"))]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(results) == 4
    for result in results:
        np.testing.assert_array_equal(result, expected)


def test_imported_spheres_of_two_sizes(tmp_path):
    rng = np.random.default_rng(7)
    spheres = np.column_stack([rng.uniform(-1, 1, (40, 3)), np.full(40, 0.02)])
    packing = innersphere.read(write_spheres(tmp_path / "loose.xyzr", spheres))
    centres, _ = placed(packing.spheres, np.eye(4))
    np.testing.assert_allclose(np.sort(centres, axis=0), np.sort(spheres[:, :3], axis=0), rtol=1e-6)
    expected, _ = brute_force(packing.spheres, packing.spheres, np.eye(4), moved(0.01))
    got = Query().overlap(packing, packing, pose_b=moved(0.01))
    assert got["volume"] == pytest.approx(expected, rel=1e-4)
