"""Gradients by poses beside finite differences; torch where it is installed."""

import numpy as np
import pytest
from conftest import matrix, random_quaternions

import innersphere
from innersphere._gradients import value_and_gradients

STEP = 1e-4


def turned(q, axis, angle):
    """The quaternion after a turn about an axis of the world: Hamilton's product."""
    u, w, half = q[:3], q[3], angle / 2
    v, c = np.sin(half) * axis, np.cos(half)
    return np.append(c * u + w * v + np.cross(v, u), c * w - v @ u)


def poses_of(seed):
    rng = np.random.default_rng(seed)
    q = random_quaternions(rng, 2)
    # The middles of the boxes lie near each other.
    places = [matrix([0, 0, 0], one)[:3, :3] @ [-0.5, -1, -1.5] for one in q]
    return (places[0] + [0.1, 0, 0], q[0]), (places[1] + [0.5, 0.9, 0.7], q[1])


@pytest.mark.parametrize("estimator", ["volume_true", "surface"])
@pytest.mark.parametrize("what", ["energy", "volume"])
def test_by_finite_differences(box, what, estimator):
    query = innersphere.Query("cpu")
    for seed in range(3):
        poses = poses_of(seed)
        value, gradients = value_and_gradients(what, query, box, box, *poses, estimator=estimator)
        assert value == query.overlap(box, box, *poses, estimator=estimator)[what] > 0
        for body in (0, 1):
            position, quaternion = poses[body]
            by_place, by_turn = gradients[2 * body : 2 * body + 2]

            def at(place, turn):
                both = list(poses)
                both[body] = (place, turn)  # noqa: B023
                return query.overlap(box, box, *both, estimator=estimator)[what]

            measured = np.zeros(6)
            told = np.concatenate([by_place, np.zeros(3)])
            for k, axis in enumerate(np.eye(3)):
                measured[k] = at(position + STEP * axis, quaternion) - at(position - STEP * axis, quaternion)
                step = [turned(quaternion, axis, sign * STEP) for sign in (1, -1)]
                measured[3 + k] = at(position, step[0]) - at(position, step[1])
                told[3 + k] = by_turn @ (step[0] - step[1]) / (2 * STEP)
            measured /= 2 * STEP
            np.testing.assert_allclose(told, measured, atol=2e-3 * np.abs(measured).max())


@pytest.mark.parametrize("what", ["energy", "volume"])
def test_matrices_and_quaternions_agree(box, what):
    query = innersphere.Query("cpu")
    pairs = [poses_of(seed) for seed in range(4)]
    as_tuples = [tuple(np.array([pair[body][k] for pair in pairs]) for k in (0, 1)) for body in (0, 1)]
    as_matrices = [np.array([matrix(*pair[body]) for pair in pairs]) for body in (0, 1)]
    values, by_tuples = value_and_gradients(what, query, box, box, *as_tuples)
    again, by_matrices = value_and_gradients(what, query, box, box, *as_matrices)
    np.testing.assert_allclose(again, values, rtol=1e-6)
    axis = np.array([0.6, 0, 0.8])
    for body in (0, 1):
        np.testing.assert_allclose(by_matrices[body][:, :3, 3], by_tuples[2 * body], rtol=1e-4, atol=1e-6)
        for n in range(4):
            change = (turned(as_tuples[body][1][n], axis, STEP) - turned(as_tuples[body][1][n], axis, -STEP)) / (
                2 * STEP
            )
            moved = [matrix([0, 0, 0], [*(np.sin(s * STEP / 2) * axis), np.cos(STEP / 2)]) for s in (1, -1)]
            turn = (moved[0] - moved[1])[:3, :3] @ as_matrices[body][n, :3, :3] / (2 * STEP)
            by_matrix = (by_matrices[body][n, :3, :3] * turn).sum()
            assert by_matrix == pytest.approx(by_tuples[2 * body + 1][n] @ change, rel=1e-4, abs=1e-6)
        assert (by_matrices[body][:, 3] == 0).all()


def test_one_body_at_the_origin(box):
    query = innersphere.Query("cpu")
    pose = np.eye(4)
    pose[:3, 3] = 0.2, 0.3, 0.4
    _, both = value_and_gradients("energy", query, box, box, np.eye(4), pose)
    _, one = value_and_gradients("energy", query, box, box, None, pose)
    assert len(both) == 2 and len(one) == 1
    np.testing.assert_array_equal(one[0], both[1])


def test_torch(box):
    torch = pytest.importorskip("torch")
    import innersphere.torch

    query = innersphere.Query("cpu")
    for function in (innersphere.torch.energy, innersphere.torch.volume):
        (pa, qa), (pb, qb) = poses_of(0)
        rows = np.stack([pb, pb + [0.1, 0, 0], pb + [0, 0.2, 0]])
        arrays = pa, qa, rows, qb  # one pose of A, three places and one turn of B
        pa, qa, rows, qb = (torch.tensor(x, dtype=torch.float64, requires_grad=True) for x in arrays)
        values = function(query, box, box, (pa, qa), (rows, qb))
        assert values.shape == (3,) and values.dtype == torch.float64
        weights = torch.tensor([1.0, 2.0, 3.0], dtype=torch.float64)
        (values * weights).sum().backward()
        assert [x.grad.shape for x in (pa, qa, rows, qb)] == [(3,), (4,), (3, 3), (4,)]

        def total(pa, qa, rows, qb):
            got = query.overlap(box, box, (pa, qa), (rows, qb))[function.__name__]  # noqa: B023
            return got @ [1, 2, 3]

        for k, (array, tensor) in enumerate(zip(arrays, (pa, qa, rows, qb))):
            axis = np.array([0.6, 0.0, 0.8])
            if array.shape[-1] == 4:
                after, before = turned(array, axis, STEP), turned(array, axis, -STEP)
            else:
                after, before = array + STEP * axis, array - STEP * axis
            measured = total(*arrays[:k], after, *arrays[k + 1 :]) - total(*arrays[:k], before, *arrays[k + 1 :])
            told = (tensor.grad.numpy() * (after - before)).sum()
            assert told == pytest.approx(measured, rel=5e-3, abs=1e-3 * STEP)
    single = torch.eye(4, requires_grad=True)  # float32, a single pose
    value = innersphere.torch.energy(query, box, box, None, single)
    assert value.shape == () and value.dtype == torch.float32
    value.backward()
    assert torch.isfinite(single.grad).all()
    # Overlap takes tensors as they are.
    assert query.overlap(box, box, pose_b=single)["volume"] == query.overlap(box, box)["volume"]
