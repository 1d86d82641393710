"""The truth bench: all engines that are here over all scenes. See README.md."""

import argparse
import concurrent.futures
import csv
import json
import os
import pathlib
import queue
import resource
import subprocess
import sys
import time

from . import compare, meshes, overlaps, page, quantities, scene
from .engines import Absent, all_engines
from .recording import Recording

FIELDS = ["engine", "scene", "rate", "quantity", "unit", "expected", "tolerance", "at_most", "measured", "holds", "cpu_ms",
          "wall_ms", "memory_mb", "energy", "same_bits", "why"]


class Bench:
    """Runs of engines over scenes, each in a process of its own."""

    def __init__(self, options: argparse.Namespace) -> None:
        self.folder = options.folder.resolve()
        self.limit, self.repeat = options.limit, not options.no_repeat
        self.scenes_folder, self.runs = self.folder / "scenes", self.folder / "runs"
        for folder in (self.scenes_folder, self.runs):
            folder.mkdir(parents=True, exist_ok=True)
        self.cores: queue.Queue[int] = queue.Queue()
        for core in sorted(os.sched_getaffinity(0))[:options.jobs]:
            self.cores.put(core)
        self.jobs = self.cores.qsize()

    def prepare(self, names: list[str], spheres: int) -> dict[str, dict]:
        """Makes the meshes of all scenes, in as many processes as there are jobs."""
        assets = scene.Assets(self.folder / "meshes", spheres)
        wanted = {json.dumps(body["mesh"]): body["mesh"] for name in names for body in scene.load(name)["bodies"]
                  if "mesh" in body}
        say(f"Preparing {len(wanted)} meshes ...")
        with concurrent.futures.ProcessPoolExecutor(self.jobs) as pool:
            list(pool.map(assets.make, wanted.values()))
        prepared = {name: scene.prepare(name, assets) for name in names}
        for name, made in prepared.items():
            self.scene_file(name).write_text(json.dumps(made))
        return prepared

    def prepare_engines(self, names: list[str], prepared: dict[str, dict]) -> None:
        """What engines make of the meshes of bodies that move."""
        moving = {body["mesh"]: body for made in prepared.values() for body in made["bodies"]
                  if "mesh" in body and body["mass"] > 0}
        with concurrent.futures.ThreadPoolExecutor(self.jobs) as pool:
            list(pool.map(lambda pair: all_engines()[pair[0]].prepare(pair[1]),
                          [(name, body) for name in names for body in moving.values()]))

    def scene_file(self, name: str) -> pathlib.Path:
        return self.scenes_folder / f"{name}.json"

    def out(self, engine: str, name: str, rate: int) -> str:
        return str(self.runs / f"{engine}-{name}-{rate}")

    def run(self, engine: str, name: str, rate: int, out: str, cores: set[int]) -> str:
        """Returns why it failed, or nothing."""

        def limits() -> None:
            os.sched_setaffinity(0, cores)
            resource.setrlimit(resource.RLIMIT_CPU, (self.limit, self.limit + 1))

        for ending in (".f64", ".json"):
            pathlib.Path(out + ending).unlink(missing_ok=True)
        command = [sys.executable, "-m", "bench.run", engine, str(self.scene_file(name)), str(rate), out]
        try:
            # One thread on one core, for those who ask the environment; the others see the one core.
            done = subprocess.run(command, preexec_fn=limits, capture_output=True, text=True, timeout=8 * self.limit,
                                  env=os.environ | ({"OMP_NUM_THREADS": "1"} if len(cores) == 1 else {}))
        except subprocess.TimeoutExpired:
            return f"more than {8 * self.limit} s"
        if done.returncode == 0:
            return ""
        for number in ("24", "9"):  # SIGXCPU, SIGKILL; of a program that Python ran, or of Python
            if done.returncode == -int(number) or "SIGXCPU" in done.stderr or f"-{number}" in done.stderr[-40:]:
                return f"more than {self.limit} s of processor time"
        lines = done.stderr.strip().splitlines()
        return lines[-1][:200] if lines else f"exit status {done.returncode}"

    def case(self, engine: str, prepared: dict, rate: int) -> list[dict]:
        """Runs on one core, and measures."""
        out = self.out(engine, prepared["name"], rate)
        core = self.cores.get()
        try:
            why = self.run(engine, prepared["name"], rate, out, {core})
        finally:
            self.cores.put(core)
        rows = judge(engine, prepared, rate, out, why)
        say(f"{engine:22} {prepared['name']:12} {rate:4}  {rows[0]['why'] or ' '.join(shown(row) for row in rows)}")
        return rows

    def again(self, row: dict) -> None:
        """The same on all cores: how long a step takes there, and whether its bits are the same."""
        out = self.out(row["engine"], row["scene"], row["rate"])
        if self.run(row["engine"], row["scene"], row["rate"], out + "-again", os.sched_getaffinity(0)):
            return
        row["same_bits"] = pathlib.Path(out + ".f64").read_bytes() == pathlib.Path(out + "-again.f64").read_bytes()
        row["wall_ms"] = json.loads(pathlib.Path(out + "-again.json").read_text())["wall_ms"]
        pathlib.Path(out + "-again.f64").unlink()


def judge(engine: str, prepared: dict, rate: int, out: str, why: str) -> list[dict]:
    """One row for each truth of the scene."""
    rows, result, recording = [], {}, None
    if not why:
        result = json.loads(pathlib.Path(out + ".json").read_text())
        try:
            recording = Recording.read(prepared, rate, pathlib.Path(out + ".f64"))
        except ValueError as error:
            why = str(error)
    for truth in prepared["truths"]:
        of = truth.get("body") or truth.get("bodies")
        row = {"engine": engine, "scene": prepared["name"], "rate": rate, "why": why,
               "quantity": truth["quantity"].replace("_", " ") + (f" of {of}" if of else "")}
        row |= {key: truth.get(key) for key in ("unit", "expected", "tolerance", "at_most")}
        row |= {key: result.get(key) for key in ("cpu_ms", "memory_mb")}
        row["holds"] = False
        if recording:
            row["measured"] = quantities.measure(truth, recording)
            row["holds"] = quantities.holds(truth, row["measured"])
            row["energy"] = quantities.energy_gained(recording) if prepared["fall"] else None
        rows.append(row)
    return rows


def shown(row: dict) -> str:
    return ("" if row["holds"] else "MISS ") + f"{row['measured']:.4g}"


def say(text: str) -> None:
    print(text, file=sys.stderr, flush=True)


def present(names: list[str]) -> dict[str, str]:
    """Versions of the engines that are here; empty for the others."""
    versions = {}
    for name in names:
        try:
            versions[name] = all_engines()[name].version()
        except (Absent, ImportError) as error:
            say(f"{name} is not here: {error}")
            versions[name] = ""
    return versions


def parse() -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="run.sh bench", description=__doc__)
    parser.add_argument("folder", type=pathlib.Path, help="gets bench.md, bench.csv, pictures, meshes and recordings")
    parser.add_argument("--engines", nargs="+", choices=list(all_engines()), default=list(all_engines()), metavar="ENGINE")
    parser.add_argument("--scenes", nargs="+", choices=scene.names(), default=scene.names(), metavar="SCENE")
    parser.add_argument("--rates", nargs="+", type=int, default=[240, 60], metavar="RATE", help="steps a second")
    parser.add_argument("--limit", type=int, default=20, help="processor time of a run [s]")
    parser.add_argument("--jobs", type=int, default=len(os.sched_getaffinity(0)), help="runs at a time, each on a core of its own")
    parser.add_argument("--spheres", type=int, default=1000, help="of packings")
    parser.add_argument("--tool", default="innersphere", help="the program innersphere")
    parser.add_argument("--no-repeat", action="store_true", help="no second runs, for times on all cores and equal bits")
    parser.add_argument("--no-queries", action="store_true", help="no overlaps")
    parser.add_argument("--page-only", action="store_true", help="writes the page again, of what FOLDER has")
    return parser.parse_args()


def main() -> None:
    if sys.argv[1:2] == ["compare"]:
        sys.exit(compare.main(sys.argv[2:]))
    options, start = parse(), time.monotonic()
    meshes.tool = options.tool
    bench = Bench(options)
    versions = present(options.engines)
    if not options.page_only:
        kept = remember(bench.folder, versions, options)
        prepared = bench.prepare(options.scenes, options.spheres)
        bench.prepare_engines([name for name in versions if versions[name]], prepared)
        cases = [(name, made, rate) for made in prepared.values() for rate in options.rates for name in versions
                 if versions[name]]
        rows: list[dict] = list(kept)
        with concurrent.futures.ThreadPoolExecutor(bench.jobs) as pool:
            for found in pool.map(lambda case: bench.case(*case), cases):
                rows += found
                write(bench.folder / "bench.csv", rows)  # each time: what was measured stays if somebody stops it
        if bench.repeat:
            first = {(row["engine"], row["scene"], row["rate"]): row for row in reversed(rows[len(kept):])}
            for row in first.values():
                if not row["why"] and row["rate"] == max(options.rates):
                    bench.again(row)
        write(bench.folder / "bench.csv", rows)
        if not options.no_queries:
            overlaps.write(bench.folder)
        spent = resource.getrusage(resource.RUSAGE_CHILDREN)
        (bench.folder / "spent.json").write_text(json.dumps({"minutes": (time.monotonic() - start) / 60, "runs": len(cases),
                                                             "processor_minutes": (spent.ru_utime + spent.ru_stime) / 60}))
    page.write(bench.folder)


def remember(folder: pathlib.Path, versions: dict[str, str], options: argparse.Namespace) -> list[dict]:
    """Adds the versions to those that the folder has, and returns what it has of other runs."""
    known, table = folder / "versions.json", folder / "bench.csv"
    before = json.loads(known.read_text()) if known.exists() else {}
    both = before | versions
    known.write_text(json.dumps({name: both[name] for name in all_engines() if name in both}))
    if not table.exists():
        return []
    with table.open(newline="") as file:
        return [row for row in csv.DictReader(file) if not (row["engine"] in versions and row["scene"] in options.scenes
                                                            and int(row["rate"]) in options.rates)]


def write(path: pathlib.Path, rows: list[dict]) -> None:
    with path.open("w", newline="") as file:
        writer = csv.DictWriter(file, FIELDS)
        writer.writeheader()
        for row in rows:
            writer.writerow({key: f"{value:.6g}" if isinstance(value, float) else value for key, value in row.items()})


if __name__ == "__main__":
    main()
