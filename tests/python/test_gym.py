"""The environment for learners: Gymnasium's own checks, repeatable episodes, and that a wrench solves it."""

import numpy as np
import pytest

import innersphere

gymnasium = pytest.importorskip("gymnasium")
pytest.importorskip("pybullet", reason="PyBullet has no wheel for this Python")
if not hasattr(innersphere._core, "pybullet"):
    pytest.skip("innersphere was built without Bullet", allow_module_level=True)

import innersphere.gym  # noqa: E402

NAME = "innersphere/NutOnBolt-v0"


@pytest.fixture(scope="module")
def words(tmp_path_factory):
    return dict(spheres=300, cache=str(tmp_path_factory.mktemp("gym")))


@pytest.fixture
def env(words):
    env = gymnasium.make(NAME, **words)
    yield env
    env.close()


@pytest.mark.filterwarnings("default")  # it warns of an observation space without bounds
def test_gymnasium_is_content(words):
    from gymnasium.utils.env_checker import check_env

    env = gymnasium.make(NAME, render_mode="rgb_array", **words)
    check_env(env.unwrapped, skip_render_check=True)
    env.reset(seed=1)
    assert len(np.unique(env.render().reshape(-1, 3), axis=0)) > 10
    env.close()


def episode(env, seed, action, steps=20):
    first, _ = env.reset(seed=seed)
    return np.array([first] + [env.step(action)[0] for _ in range(steps)])


def test_the_same_seed_is_the_same_episode(env):
    action = np.array([0, 0, -1, 0.1, 0, -1], np.float32)
    one, other, again = (episode(env, seed, action) for seed in (1, 2, 1))
    np.testing.assert_array_equal(one, again)
    assert one[0, 2] != other[0, 2] and 0.35 <= one[0, 2] <= 0.6


def test_friction_holds_the_nut_and_a_torque_turns_it_down(env):
    held = episode(env, 3, np.zeros(6, np.float32))
    assert held[-1, 2] == pytest.approx(held[0, 2], abs=0.01)
    env.reset(seed=3)
    total, ended = 0.0, False
    while not ended:
        observation, reward, ended, truncated, _ = env.step(np.array([0, 0, 0, 0, 0, -1], np.float32))
        assert not truncated
        total += reward
    assert observation[2] <= 0.1
    assert total == pytest.approx((held[0, 2] - observation[2]) / 0.125, rel=1e-4)
    np.testing.assert_allclose(observation[:2], 0, atol=0.02)  # it is still on the bolt


def test_processes_do_what_one_does(words, env):
    envs = gymnasium.make_vec(NAME, 2, vectorization_mode="async", vector_kwargs={"context": "spawn"}, **words)
    try:
        action = np.array([0, 0, 0, 0, 0, -1], np.float32)
        got = [envs.reset(seed=[5, 6])[0]] + [envs.step(np.tile(action, (2, 1)))[0] for _ in range(5)]
        for k, seed in enumerate((5, 6)):
            np.testing.assert_array_equal(np.array(got)[:, k], episode(env, seed, action, 5))
    finally:
        envs.close()


@pytest.mark.parametrize(
    "action, error, message",
    [
        (np.full(6, np.nan), innersphere.NotFiniteError, "action is .*nan.*finite"),
        ([0, 0, np.inf, 0, 0, 0], innersphere.NotFiniteError, "action is .*inf.*finite"),
        (np.zeros(3), innersphere.InvalidArgumentError, r"action has the shape \(3,\); it must be \(6,\)"),
        (np.zeros((1, 6)), innersphere.InvalidArgumentError, r"action has the shape \(1, 6\); it must be \(6,\)"),
        (0.5, innersphere.InvalidArgumentError, r"action has the shape \(\); it must be \(6,\)"),
        (["left"] * 6, TypeError, "action has the dtype"),
    ],
)
def test_bad_actions(env, action, error, message):
    before, _ = env.reset(seed=1)
    with pytest.raises(error, match=message):
        env.unwrapped.step(action)
    np.testing.assert_array_equal(env.unwrapped._observation(), before)
