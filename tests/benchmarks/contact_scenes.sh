#!/usr/bin/env bash
# The scenes that an outside user tried, stepped in three ways, with packings and with Bullet's own shapes:
#
#   ./tests/benchmarks/run.sh contact-scenes [SCENES]     all of the list below if none is named
#
# prints a Markdown table: every truth, and what each arrangement shows of it. A run may take LIMIT (60) seconds of processor time, so that
# a busy machine changes nothing but the times. Takes about half an hour on two cores.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
tool=${TOOL:-$here/../../build-benchmarks/bin/innersphere}
[ -n "${TOOL:-}" ] || "$here/run.sh" innersphere --version >/dev/null  # builds it
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
scenes=${*:-arch arch-thin dominoes ring-peg ring-cylinder half-pipe half-pipe-mesh t-slot gripper gripper-motor carabiner chain-rest
  mass-ratios gear-box gear-plane gear-mesh drops mixed-pile scan-bin}
declare -A modes=([240]="--dt 0.00416666667" [60]="--dt 0.0166666667" [plain]="--plain")
mode_names="240 60 plain"
shapes="packing gimpact convex"
limit=${LIMIT:-60}

# Each line: a file, and the arguments of the tool whose output goes there. A run that fails or is stopped leaves an empty file
# and its status.
for shape in $shapes; do
  for mode in $mode_names; do
    for scene in $scenes; do echo "$scene-$shape-$mode scene run $scene --shape $shape ${modes[$mode]}"; done
  done
done | tool=$tool work=$work limit=$limit xargs -P "$(nproc)" -L 1 bash -c '
  out=$1; shift
  ulimit -t "$limit"
  "$tool" "$@" >"$work/$out" 2>"$work/$out.err" || { echo $? >"$work/$out.status"; : >"$work/$out"; }
  echo "$out" >&2' contact_scenes.sh

# Lines "what|allowed|holds or MISSED|figure" of a run.
truths() {
  sed -n -E 's/^(truth)? +(holds|MISSED|not shown) +(.*)$/\2|\3/p' "$work/$1" |
    sed -E 's/^([^|]*)\|(.*): ([^ ,]*)[^,]*, ((at most|expected) [^(]*[^( ]) \(.*/\2|\4|\1|\3/'
}

# What one arrangement shows of a truth, by its number.
cell() {
  local row
  row=$(truths "$1" | sed -n "$2p")
  if [ -z "$row" ]; then
    # 137: the kernel ended it at its limit.
    if [ "$(cat "$work/$1.status")" = 137 ]; then printf ' | - timeout'; else printf ' | - error'; fi
  elif [[ $row == *"|holds|"* ]]; then
    printf ' | pass %s' "${row##*|}"
  else
    printf ' | **miss** %s' "${row##*|}"
  fi
}

stepTime() {
  local time
  time=$(sed -n -E 's/^step time +([^ ]*) ms median.*/\1/p' "$work/$1")
  printf ' | %s' "${time:--}"
}

cat <<EOF
# What the scenes of an outside user show

* machine: $(sed -n 's/^model name.*: //p' /proc/cpuinfo | head -n 1), $(nproc) hardware threads, $(nproc) runs at a time
* date: $(date +%F), commit $(git -C "$here" describe --always --dirty 2>/dev/null || echo unknown)
* command: \`tests/benchmarks/run.sh contact-scenes${*:+ $*}\`

240 and 60: steps a second, with two friction directions, and no body sleeps. plain: \`--plain\`, Bullet as its HelloWorld has it. Shapes are
those of \`--shape\`. Where a run takes more than $limit s of processor time there is a dash. Each scene's last row is the median time of a step [ms].

EOF
head="| scene | truth"
rule="|---|---"
for shape in $shapes; do
  for mode in $mode_names; do
    head+=" | $shape $mode"
    rule+="|---"
  done
done
printf '%s |\n%s|\n' "$head" "$rule"
for scene in $scenes; do
  known=
  for shape in $shapes; do
    for mode in $mode_names; do
      if [ -z "$known" ] && [ -s "$work/$scene-$shape-$mode" ]; then known=$scene-$shape-$mode; fi
    done
  done
  if [ -z "$known" ]; then
    printf '| %s | - no run ended |\n' "$scene"
    continue
  fi
  number=0
  while IFS='|' read -r what allowed _; do
    number=$((number + 1))
    printf '| %s | %s: %s' "$scene" "$what" "$allowed"
    for shape in $shapes; do for mode in $mode_names; do cell "$scene-$shape-$mode" "$number"; done; done
    printf ' |\n'
  done < <(truths "$known")
  printf '| %s | step' "$scene"
  for shape in $shapes; do for mode in $mode_names; do stepTime "$scene-$shape-$mode"; done; done
  printf ' |\n'
done
