"""What a sweep on many workers costs: measures the coordinator and a pose here, and simulates the rest.

PYTHONPATH=build/python build/python-env/bin/python tests/benchmarks/sweep_plan.py > tests/benchmarks/results/sweep.md
"""

import heapq
import os
import platform
import random
import subprocess
import tempfile
import time

import numpy as np

import innersphere

POSES, WORKERS, RESULT = 10**10, 1000, 8  # bytes of a volume
SETUP, RESTART = 1.0, 30.0  # s: a worker opens its models; a new worker comes in place of a dead one
SPHERES = 4000


def zeros(first, count):
    return np.zeros(count)


def cost_of_coordinator(engine, folder):
    """Processor time of the coordinator: for a block [s], and for a byte of results [s]."""
    spent = []
    for blocks, rows in ((1000, 1), (100, 100_000)):
        before = time.process_time()
        innersphere.sweep(
            zeros, blocks * rows, block=rows, engine=engine, workers=1, out=f"{folder}/{engine}{rows}.npy"
        )
        spent.append((time.process_time() - before, blocks, blocks * rows * RESULT))
    start = time.process_time()
    innersphere.sweep(zeros, 1, engine=engine, workers=1)
    start = time.process_time() - start
    (t1, n1, b1), (t2, n2, b2) = [(max(t - start, 0), n, b) for t, n, b in spent]
    per_byte = max((t2 - t1 * n2 / n1) / (b2 - b1 * n2 / n1), 0)
    return (t1 - per_byte * b1) / n1, per_byte


def time_of_pose():
    """One thread's time for the volume of two tori in a random pose [s]."""
    ring, tube = 40, 20
    u, v = np.meshgrid(2 * np.pi * np.arange(ring) / ring, 2 * np.pi * np.arange(tube) / tube, indexing="ij")
    wide = 0.1 + 0.03 * np.cos(v)
    vertices = np.stack([wide * np.cos(u), wide * np.sin(u), 0.03 * np.sin(v)], 2).reshape(-1, 3)
    at = np.arange(ring * tube).reshape(ring, tube)
    a, b, c, d = at, np.roll(at, -1, 0), np.roll(np.roll(at, -1, 0), -1, 1), np.roll(at, -1, 1)
    faces = np.concatenate([np.stack([a, b, c], 2).reshape(-1, 3), np.stack([a, c, d], 2).reshape(-1, 3)])
    torus = innersphere.pack((vertices, faces), spheres=SPHERES, overlap_errors=False)
    poses = innersphere.random_poses(20_000, -0.15, 0.15, seed=1)
    query = innersphere.Query("cpu", threads=1)
    best = np.inf
    for _ in range(3):
        start = time.thread_time()
        query.overlap(torus, torus, pose_b=poses, want="volume")
        best = min(best, time.thread_time() - start)
    return best / 20_000


def simulate(block, pose, per_block, per_byte, deaths_per_hour, seed=1):
    """Time of the whole sweep, share of time the coordinator is busy, and blocks done again.

    A block is computed by a worker and then taken by the coordinator, one after the other; a worker that dies loses its
    block, which goes to the end of the line."""
    rng = random.Random(seed)
    left, lost = -(-POSES // block), 0
    service = per_block + per_byte * block * RESULT
    free = 0.0  # when the coordinator is done with all that it has
    rate = deaths_per_hour / 3600
    events = [(SETUP + i * per_block, i) for i in range(WORKERS)]  # a worker is ready for a block
    heapq.heapify(events)
    busy = end = 0.0
    while events:
        now, worker = heapq.heappop(events)
        if left == 0:
            continue
        left -= 1
        work = block * pose * rng.uniform(0.9, 1.1)
        death = rng.expovariate(rate) if rate else np.inf
        if death < work:
            lost, left = lost + 1, left + 1
            heapq.heappush(events, (now + death + RESTART, worker))
            continue
        free = max(free, now + work) + service
        busy += service
        end = max(end, free)
        # Three more blocks wait at each worker: it stands still only if the coordinator is that far behind.
        heapq.heappush(events, (max(now + work, free - 3 * block * pose), worker))
    return end, busy / end, lost


def main():
    pose = time_of_pose()
    ideal = POSES * pose / WORKERS
    print("# Sweeps on many workers\n")
    with tempfile.TemporaryDirectory() as folder:
        costs = {}
        for engine in ("processes", "dask"):
            costs[engine] = cost_of_coordinator(engine, folder)
    rows = []
    for engine, (per_block, per_byte) in costs.items():
        for block in (10**4, 10**5, 10**6):
            for deaths in (0, 0.1, 10):
                if deaths and block == 10**4:
                    continue
                took, busy, lost = simulate(block, pose, per_block, per_byte, deaths)
                rows.append((engine, block, block * pose, deaths, took, ideal / took, busy, lost))
    best = max((row for row in rows if row[0] == "dask" and row[3] == 0.1), key=lambda row: row[5])
    print(
        f"**{WORKERS:,} workers do {POSES:.0e} poses in {best[4]:.0f} s, {100 * best[5]:.0f} % of what {WORKERS:,} times one "
        f"core would give, in Dask with blocks of {best[1]:,} poses; a worker in ten dies in an hour.** The table says "
        "what limits. `processes` stands for an engine whose coordinator costs little. Only the first part is measured, on one machine; the rest is simulated.\n"
    )
    commit = subprocess.run(["git", "describe", "--always", "--dirty"], capture_output=True, text=True).stdout.strip()
    print(f"`tests/benchmarks/sweep_plan.py`, {time.strftime('%Y-%m-%d')}, {commit}, {platform.processor() or platform.machine()}, "
          f"{os.cpu_count()} cores, Python {platform.python_version()}\n")  # fmt: skip
    print("## Measured\n\n| | |\n|---|---|")
    print(f"| a pose (volume of two tori of {SPHERES:,} spheres, one thread) | {1e6 * pose:.1f} us |")
    for engine, (per_block, per_byte) in costs.items():
        print(f"| coordinator, `{engine}`: a block | {1e3 * per_block:.2f} ms |")
        print(f"| coordinator, `{engine}`: a byte of results, into a file | {1e9 * per_byte:.2f} ns |")
    print("\n## Simulated\n")
    print(f"{POSES:.0e} poses, {RESULT} bytes of result each: {POSES * RESULT / 1e9:.0f} GB come back, and {WORKERS:,} times what "
          f"`setup` reads. Opening takes {SETUP:g} s, a new worker {RESTART:g} s. A block that goes out is 300 bytes. Ideal: "
          f"{ideal:.0f} s.\n")  # fmt: skip
    print(
        "| engine | block | a worker's time for it | deaths a worker and hour | all | of the ideal | coordinator busy | blocks done again |"
    )
    print("|---|---|---|---|---|---|---|---|")
    for engine, block, work, deaths, took, share, busy, lost in rows:
        print(
            f"| {engine} | {block:,} | {work:.2f} s | {deaths:g} | {took:.0f} s | {100 * share:.0f} % | {100 * busy:.0f} % | {lost} |"
        )
    print(
        "\n- Small blocks are limited by the coordinator, which handles one after the other; results of large ones by the bytes "
        "that it writes. `reduce=` in place of `out=`, or a function that sums up its block, takes the bytes away.\n"
        "- Large blocks cost twice: what is lost with a worker, and workers that wait for the last ones at the end.\n"
        "- So take blocks of one to ten seconds. Where the coordinator is busy all the time, split the rows over several sweeps, "
        "or take shards of the tool: these have no coordinator at all, and write to a shared file system."
    )


if __name__ == "__main__":
    main()
