"""Writes the page: bench.md, bench.png, bench-motion.png and films, of what a folder of the bench has."""

import csv
import datetime
import json
import os
import pathlib
import platform
import subprocess

import numpy as np

from . import films, scene
from .engines import all_engines
from .recording import Recording, read_scene

_ENERGY = 0.05  # a run gains energy if it is more than this part of what it could fall


def _read(path: pathlib.Path) -> list[dict]:
    if not path.exists():
        return []
    with path.open(newline="") as file:
        return list(csv.DictReader(file))


def _table(head: list[str], rows: list[list[str]]) -> str:
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows]) + "\n"


def _figure(text: str) -> str:
    return f"{float(text):.3g}" if text else ""


def _cell(row: dict | None) -> str:
    if row is None:
        return "-"
    if row["why"]:
        return f"**{'time' if 'processor time' in row['why'] or row['why'].startswith('more') else 'failed'}**"
    return _figure(row["measured"]) if row["holds"] == "True" else f"**{_figure(row['measured'])}**"


def _expected(row: dict) -> str:
    unit = f" {row['unit']}" if row["unit"] else ""
    if row["at_most"]:
        return f"at most {_figure(row['at_most'])}{unit}"
    return f"{float(row['expected']):.5g} ± {_figure(row['tolerance']) or 0}{unit}"


class Results:
    """The rows of bench.csv by engine, scene and rate."""

    def __init__(self, folder: pathlib.Path) -> None:
        self.rows = _read(folder / "bench.csv")
        self.versions = json.loads((folder / "versions.json").read_text())
        self.engines = list(self.versions)
        self.scenes = sorted({row["scene"] for row in self.rows})
        self.rates = sorted({int(row["rate"]) for row in self.rows}, reverse=True)

    def of(self, engine: str, name: str, rate: int) -> list[dict]:
        return [r for r in self.rows if (r["engine"], r["scene"], int(r["rate"])) == (engine, name, rate)]

    def held(self, engine: str, name: str, rate: int) -> float | None:
        """The share of the scene's truths that hold; None if the engine was not there."""
        rows = self.of(engine, name, rate)
        return sum(r["holds"] == "True" for r in rows) / len(rows) if rows else None


def _machine() -> str:
    for line in pathlib.Path("/proc/cpuinfo").read_text().splitlines():
        if line.startswith("model name"):
            return f"{line.split(':')[1].strip()}, {os.cpu_count()} hardware threads"
    return platform.processor()


def _commit() -> str:
    done = subprocess.run(["git", "describe", "--always", "--dirty"], cwd=pathlib.Path(__file__).parent, capture_output=True,
                          text=True)
    return done.stdout.strip() or "unknown"


def _spent(folder: pathlib.Path) -> str:
    """How long the last command took."""
    known = folder / "spent.json"
    if not known.exists():
        return "unknown"
    spent = json.loads(known.read_text())
    return (f"{spent['runs']} runs and their repetition took {spent['minutes']:.0f} minutes by the clock and "
            f"{spent['processor_minutes']:.0f} of processor time, meshes and packings included")


def _summary(results: Results) -> str:
    """Truths that hold, by engine and rate, and what else can be counted."""
    rows = []
    for engine in results.engines:
        if not results.versions[engine]:
            rows.append([engine] + ["-"] * (2 * len(results.rates) + 4))
            continue
        cells = [engine]
        for rate in results.rates:
            whole = [results.held(engine, name, rate) == 1 for name in results.scenes if results.of(engine, name, rate)]
            mine = [r for r in results.rows if r["engine"] == engine and int(r["rate"]) == rate]
            cells += [f"{sum(whole)} of {len(whole)}", f"{sum(r['holds'] == 'True' for r in mine)} of {len(mine)}"]
        # The first row of each run has what is told of the run.
        runs = {(r["scene"], r["rate"]): r for r in reversed(results.rows) if r["engine"] == engine}.values()
        done = [r for r in runs if not r["why"]]
        memory = max((float(r["memory_mb"]) for r in done), default=0)
        gained = [r for r in done if r["energy"] and float(r["energy"]) > _ENERGY]
        with_energy = [r for r in done if r["energy"]]
        again = [r for r in done if r["same_bits"]]
        cells += [str(len(runs) - len(done)), f"{len(gained)} of {len(with_energy)}",
                  f"{sum(r['same_bits'] == 'True' for r in again)} of {len(again)}", f"{memory:.0f}"]
        rows.append(cells)
    head = ["engine"]
    for rate in results.rates:
        head += [f"scenes that hold at {rate}/s", f"truths that hold at {rate}/s"]
    head += ["runs without an end", "runs that gain energy", "runs with the same bits again", "most memory [MB]"]
    return _table(head, rows)


def _truths(results: Results, rate: int) -> str:
    rows = []
    for name in results.scenes:
        found = {engine: results.of(engine, name, rate) for engine in results.engines}
        some = next((r for r in found.values() if r), [])  # none: the scene was not run at this rate
        for k in range(len(some)):
            rows.append([name, some[k]["quantity"], _expected(some[k])]
                        + [_cell(found[engine][k] if found[engine] else None) for engine in results.engines])
    return _table(["scene", "quantity", "truth", *results.engines], rows)


def _per_run(results: Results, rate: int, key: str) -> str:
    rows = []
    for name in results.scenes:
        cells = [name]
        for engine in results.engines:
            found = results.of(engine, name, rate)
            cells.append(_figure(found[0][key]) or "-" if found else "-")
        if any(cell != "-" for cell in cells[1:]):
            rows.append(cells)
    return _table(["scene", *results.engines], rows)


def _overlaps(rows: list[dict]) -> str:
    engines = list(dict.fromkeys(row["engine"] for row in rows))
    lines = []
    for case, quantity in dict.fromkeys((row["case"], row["quantity"]) for row in rows):
        cells = []
        for engine in engines:
            found = [r for r in rows if (r["case"], r["quantity"], r["engine"]) == (case, quantity, engine)]
            error = f"{100 * float(found[0]['error']):.2g} %" if found else "-"
            cells.append(error if not found or found[0]["holds"] == "True" else f"**{error}**")
        lines.append([case, quantity, *cells])
    for case in dict.fromkeys(row["case"] for row in rows):
        times = {r["engine"]: r["ms"] for r in rows if r["case"] == case}
        lines.append([case, "time [ms]", *[_figure(times.get(engine, "")) or "-" for engine in engines]])
    versions = {row["engine"]: row["version"] for row in rows}
    return _table(["case", "error of", *[f"{engine} {versions[engine]}" for engine in engines]], lines)


def _failures(results: Results) -> str:
    seen = {}
    for row in results.rows:
        if row["why"]:
            seen[(row["engine"], row["why"])] = seen.get((row["engine"], row["why"]), [])
            seen[(row["engine"], row["why"])].append(f"{row['scene']} at {row['rate']}")
    return "".join(f"* {engine}: {', '.join(dict.fromkeys(where))}: {why}\n" for (engine, why), where in seen.items())


def _picture(results: Results, path: pathlib.Path) -> None:
    """A field for each engine and scene: green if all truths hold, yellow if some do, red if none does."""
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot
    from matplotlib.colors import ListedColormap

    here = [engine for engine in results.engines if results.versions[engine]]
    figure, axes = pyplot.subplots(1, len(results.rates), figsize=(4 + 3.2 * len(results.rates), 0.8 + 0.27 * len(results.scenes)),
                                   sharey=True, squeeze=False)
    for axis, rate in zip(axes[0], results.rates):
        held = np.array([[_rank(results, engine, name, rate) for engine in here] for name in results.scenes])
        axis.imshow(held, cmap=ListedColormap(["#b0b0b0", "#c8553d", "#f2c14e", "#4f9d69"]), vmin=0, vmax=3, aspect="auto")
        axis.set_xticks(range(len(here)), here, rotation=50, ha="right", fontsize=8)
        axis.set_yticks(range(len(results.scenes)), results.scenes, fontsize=8)
        axis.set_xticks(np.arange(len(here)) - 0.5, minor=True)
        axis.set_yticks(np.arange(len(results.scenes)) - 0.5, minor=True)
        axis.grid(which="minor", color="white", linewidth=1.5)
        axis.tick_params(which="both", length=0)
        axis.set_title(f"{rate} steps a second", fontsize=9)
    figure.suptitle("green: all truths hold; yellow: some; red: none; grey: no result in its time, or not run", fontsize=8)
    figure.tight_layout()
    figure.savefig(path, dpi=110)
    pyplot.close(figure)


def _rank(results: Results, engine: str, name: str, rate: int) -> int:
    held = results.held(engine, name, rate)
    rows = results.of(engine, name, rate)
    if held is None or rows[0]["why"]:
        return 0
    return 3 if held == 1 else 2 if held > 0 else 1


def _watched(prepared: dict) -> int:
    """The body that the scene's first truth is about, or the last one of its bodies."""
    truth = prepared["truths"][0]
    names = [body["name"] for body in prepared["bodies"]]
    if truth.get("body") in names:
        return names.index(truth["body"])
    return max(i for i, body in enumerate(prepared["bodies"]) if body["mass"] > 0)


def _motion(results: Results, folder: pathlib.Path, rate: int, path: pathlib.Path) -> None:
    """How far one body of each scene is from where it started, in all engines."""
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    columns = 4
    lines = -(-len(results.scenes) // columns)
    figure, axes = pyplot.subplots(lines, columns, figsize=(3.4 * columns, 2.3 * lines), squeeze=False)
    for axis in axes.flat[len(results.scenes):]:
        axis.axis("off")
    colours = pyplot.get_cmap("tab20")
    for name, axis in zip(results.scenes, axes.flat):
        prepared = read_scene(folder / "scenes" / f"{name}.json")
        watched = _watched(prepared)
        for k, engine in enumerate(results.engines):
            file = folder / "runs" / f"{engine}-{name}-{rate}.f64"
            rows = results.of(engine, name, rate)
            if not rows or rows[0]["why"] or not file.exists():
                continue
            try:
                recording = Recording.read(prepared, rate, file)
            except ValueError:
                continue
            way = np.linalg.norm(recording.position[:, watched] - recording.position[0, watched], axis=1)
            axis.semilogy(np.arange(len(way)) * recording.dt, np.clip(way, 1e-6, 1e2), color=colours(k % 20), linewidth=1, label=engine)
        axis.set_title(f"{name}: {prepared['bodies'][watched]['name']}", fontsize=8)
        axis.tick_params(labelsize=6)
    handles = {label: handle for axis in axes.flat for handle, label in zip(*axis.get_legend_handles_labels())}
    figure.legend(handles.values(), handles.keys(), loc="lower center", ncols=6, fontsize=8)
    figure.tight_layout(rect=(0, 0.06, 1, 1))
    figure.savefig(path, dpi=90)
    pyplot.close(figure)


def write(folder: pathlib.Path) -> None:
    results = Results(folder)
    fast = results.rates[0]
    _picture(results, folder / "bench.png")
    _motion(results, folder, fast, folder / "bench-motion.png")
    shown = films.write(folder, results)
    overlaps = _read(folder / "overlaps.csv")
    parts = [f"""# The truth bench

{_summary(results)}
Figures in bold miss their truth. "Without an end" are runs that took more than their processor time or failed. A run gains energy if the
increments of its total energy are more than {100 * _ENERGY:.0f} % of what its bodies could fall.

![Which truths hold, for each scene and engine](bench.png)

* machine: {_machine()}
* date: {datetime.date.today()}, commit {_commit()}
* time: {_spent(folder)}
* command: `tests/benchmarks/run.sh bench FOLDER`; how it works: [the bench's own page](../bench/README.md)

"""]
    for rate in results.rates:
        parts.append(f"## Truths at {rate} steps a second\n\n{_truths(results, rate)}\n")
    parts.append("## Cost\n\n" + "".join(
        f"Processor time of a step on one core at {rate}/s [ms]:\n\n{_per_run(results, rate, 'cpu_ms')}\n" for rate in results.rates))
    parts.append(f"Time of a step with all cores free at {fast}/s [ms], by the clock:\n\n{_per_run(results, fast, 'wall_ms')}\n")
    parts.append(f"## Energy from nowhere\n\nAt {fast}/s, over that of a fall by each scene's `fall`:\n\n"
                 f"{_per_run(results, fast, 'energy')}\n")
    if overlaps:
        parts.append("## Overlaps\n\nErrors against closed forms ([overlaps.py](../bench/overlaps.py)): of the volume, of the centroid over "
                     "the solid's size, of the gradient of the volume, of the depth. Gradients of manifold3d and trimesh are differences of "
                     "volumes. FCL, Coal and PyBullet tell depths; those of FCL and Coal are of pairs of triangles, not of solids: the largest is taken.\n\n"
                     f"{_overlaps(overlaps)}\n")
    parts.append(f"## Motion\n\nHow far a body of each scene is from where it started [m], over time [s], at {fast}/s. Where a scene should "
                 "stay as it was put\n(arch, chain-heavy, mass-ratios, nut-locked, pyramid, stack, t-slot) that is its error:\n\n"
                 "![Way of a body over time](bench-motion.png)\n\n" + "".join(f"![{text}]({file})\n\n" for file, text in shown))
    if _failures(results):
        parts.append(f"## Runs without an end\n\n{_failures(results)}\n")
    parts.append("## Engines\n\n" + _table(["engine", "version", "settings"], [
        [name, results.versions[name] or "not here", all_engines()[name].settings] for name in results.engines]))
    parts.append("\n## Scenes\n\n" + _table(["scene", "what happens", "truths and their sources"], [
        [name, scene.load(name)["about"], "; ".join(dict.fromkeys(t["source"] for t in scene.load(name)["truths"]))]
        for name in results.scenes]))
    (folder / "bench.md").write_text("".join(parts))
