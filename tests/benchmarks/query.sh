#!/usr/bin/env bash
# The evaluation of the query, all tables and plots:
#
#   ./tests/benchmarks/run.sh query FOLDER [MESH=POSES ...]
#
# writes query.md, query-sweep.md, query-growth.md, query-budget.md, query-peers.md, query-deadline.md and tool-accuracy.md into
# FOLDER (with a GPU also query-memory.md and query-construction.md), and plots. POSES is a CSV table of placements of a
# copy of MESH with the exact overlaps. Without meshes the project's own solids serve, whose overlaps are sampled.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
run=$here/run.sh
if [ $# -eq 0 ]; then
  sed -n '2,8p' "$0" | cut -c 3- >&2
  exit 2
fi
out=$1
shift
mkdir -p "$out"
points=$(mktemp -d)
trap 'rm -rf "$points"' EXIT

device=()
if name=$(nvidia-smi --query-gpu=name --format=csv,noheader 2>/dev/null); then device=(--device "${name%%$'\n'*}"); fi
plot() { # NAME SCRIPT: by gnuplot, where it is installed
  if command -v gnuplot >/dev/null; then
    gnuplot -e "points='$points/$1'; output='$out/query-$1.png'" "$here/query_$1.gp"
  else
    printf 'no plots: gnuplot is not installed\n' >&2
  fi
}

"$run" query_benchmark "${device[@]}" --spheres 1000,4000,15000,60000 >"$out/query.md"
"$run" query_sweep "${@%%=*}" "${device[@]}" --points "$points/sweep" >"$out/query-sweep.md"
plot sweep
"$run" query_growth --points "$points/growth" >"$out/query-growth.md"
plot growth
"$run" query_budget "$@" "${device[@]}" --points "$points/budget" >"$out/query-budget.md"
plot budget
"$run" query_peers "$@" >"$out/query-peers.md"
"$run" query_deadline "${@%%=*}" >"$out/query-deadline.md"
if [ ${#device[@]} -gt 0 ]; then
  "$run" query_deadline "${@%%=*}" --backend cuda "${device[@]}" >>"$out/query-deadline.md"
  "$run" query_memory "${device[@]}" >"$out/query-memory.md"
  "$run" query_construction "${device[@]}" >"$out/query-construction.md"
fi

tables=()
for item in "$@"; do
  for spheres in 1000 4000 16000; do
    table=$points/$(basename "${item%%=*}")-$spheres.csv
    "$run" innersphere overlap "${item%%=*}" "${item%%=*}" --poses "${item#*=}" --spheres $spheres -o "$table"
    tables+=("$item=$spheres=$table")
  done
done
if [ ${#tables[@]} -gt 0 ]; then "$run" tool_accuracy "${tables[@]}" >"$out/tool-accuracy.md"; fi
