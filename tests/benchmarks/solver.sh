#!/usr/bin/env bash
# Constraint solvers at 60 steps a second: what they make of stacks, piles and machines, MuJoCo beside, and what they cost.
#
#   ./tests/benchmarks/run.sh solver FOLDER       writes FOLDER/solver.md and solver.png; takes some minutes
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
folder=${1:?usage: tests/benchmarks/run.sh solver FOLDER}
mkdir -p "$folder"
. "$here/../../examples/setup.sh"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# shellcheck disable=SC2154,SC2086  # a list of names
need_packages $python_packages
environment=$here/../../build-benchmarks/solver-env
python_environment "$environment" numpy mujoco matplotlib
"$here/run.sh" solver_benchmark --csv "$work/costs.csv" >"$work/costs.md"
"$here/run.sh" solver_scenes >"$work/scenes.csv"
{
  sed '/^Medians/,$d' "$work/costs.md" | sed 's|^\* command: .*|* command: `tests/benchmarks/run.sh solver FOLDER`|'
  "$environment/bin/python" "$here/solver.py" "$work/scenes.csv" "$work/costs.csv" "$folder/solver.png"
  printf '\n![Times, and motions](solver.png)\n\n'
  sed -n '/^Medians/,$p' "$work/costs.md"
} >"$folder/solver.md"
