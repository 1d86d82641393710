"""run.sh bench compare A.csv B.csv: do two runs of the bench, on two machines, agree in what they measured?"""

import csv
import sys


def _read(path: str) -> dict[tuple, dict]:
    with open(path, newline="") as file:
        return {(row["engine"], row["scene"], row["rate"], row["quantity"]): row for row in csv.DictReader(file)}


def _differs(a: dict, b: dict, share: float) -> bool:
    """By more than a share of the larger figure, or of the tolerance where that is more: below it a figure is noise."""
    x, y = float(a["measured"]), float(b["measured"])
    floor = float(a["tolerance"] or a["at_most"] or 0)
    return abs(x - y) > share * max(abs(x), abs(y), floor)


def main(arguments: list[str]) -> int:
    """Returns 1 if figures that hold in either differ by more than 5 %, or one holds and the other does not. A run that did not end in its
    time on one machine is counted, but is no figure."""
    if len(arguments) != 2:
        print("usage: run.sh bench compare A.csv B.csv", file=sys.stderr)
        return 2
    a, b = (_read(path) for path in arguments)
    both = [key for key in a if key in b]
    answered = [key for key in both if a[key]["measured"] and b[key]["measured"]]
    late = sum(bool(a[key]["measured"]) != bool(b[key]["measured"]) for key in both)
    worse = [key for key in answered if (a[key]["holds"] == "True" or b[key]["holds"] == "True")
             and (a[key]["holds"] != b[key]["holds"] or _differs(a[key], b[key], 0.05))]
    for key in worse:
        print(f"differs: {' '.join(key)}: {a[key]['measured']} and {b[key]['measured']}")
    missed = sum(a[key]["holds"] == b[key]["holds"] == "False" for key in answered)
    print(f"{len(answered)} figures in both, {missed} of them misses in both, {len(worse)} of the others differ by more than 5 %; "
          f"{late} that one has and the other has not, for want of time")
    return 1 if worse else 0
