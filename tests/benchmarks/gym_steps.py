"""Steps a second of the environment for learners, by number of processes.

PYTHONPATH=build/python build/python-env/bin/python tests/benchmarks/gym_steps.py > tests/benchmarks/results/gym.md
"""

import os
import platform
import subprocess
import tempfile
import time

import gymnasium
import numpy as np

import innersphere.gym  # noqa: F401  registers it

STEPS = 150


def measure(count, cache):
    """Steps a second of `count` processes, by the clock, and processor time of a step in all of them [s]."""
    envs = gymnasium.make_vec(
        "innersphere/NutOnBolt-v0", count, vectorization_mode="async", vector_kwargs={"context": "spawn"}, cache=cache
    )
    envs.reset(seed=1)
    action = np.tile(np.array([0, 0, 0, 0, 0, -0.5], np.float32), (count, 1))
    envs.step(action)
    start = time.perf_counter()
    for _ in range(STEPS):
        envs.step(action)
    took = time.perf_counter() - start
    before = os.times()
    envs.close()
    after = os.times()  # of children that have ended
    used = after.children_user + after.children_system - before.children_user - before.children_system
    return count * STEPS / took, used / (count * STEPS)


def main():
    with tempfile.TemporaryDirectory() as cache:
        measure(1, cache)  # packs
        rows = [(count, *measure(count, cache)) for count in (1, 2, 4)]
    commit = subprocess.run(["git", "describe", "--always", "--dirty"], capture_output=True, text=True).stdout.strip()
    print("# The environment for learners\n")
    print(
        f"**A step takes {1e3 * rows[0][2]:.1f} ms of a core, in any number of processes: {1 / rows[0][2]:.0f} a second on a core that is "
        "free.** It is 12 steps of PyBullet at 240 Hz: a nut of 1,000 spheres on its bolt. Steps by the clock are those of cores that "
        "others use, too.\n"
    )
    print(f"`tests/benchmarks/gym_steps.py`, {time.strftime('%Y-%m-%d')}, {commit}, {platform.machine()}, Python "
          f"{platform.python_version()}, load {os.getloadavg()[0]:.1f}\n")  # fmt: skip
    print("| processes | processor time of a step, start-up included | steps a second by the clock |\n|---|---|---|")
    for count, rate, used in rows:
        print(f"| {count} | {1e3 * used:.1f} ms | {rate:.0f} |")


if __name__ == "__main__":
    main()
