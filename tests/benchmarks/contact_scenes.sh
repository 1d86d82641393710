#!/usr/bin/env bash
# The scenes that an outside user tried, stepped in three ways, with packings and with Bullet's own shapes:
#
#   ./tests/benchmarks/run.sh contact-scenes [SCENES]     all of the list below if none is named
#
# prints a Markdown table: every truth, and what each arrangement shows of it. A run may take LIMIT (60) seconds of processor time, so that
# a busy machine changes nothing but the times. Takes about half an hour on two cores.
set -euo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/scene_table.sh"
scenes=${*:-arch arch-thin dominoes ring-peg ring-cylinder half-pipe half-pipe-mesh t-slot gripper gripper-motor carabiner chain-rest
  mass-ratios gear-box gear-plane gear-mesh drops mixed-pile scan-bin}
declare -A arguments=() modes=([240]="--dt 0.00416666667" [60]="--dt 0.0166666667" [plain]="--plain")
mode_names="240 60 plain"
shapes="packing gimpact convex"

columns=
for shape in $shapes; do
  for mode in $mode_names; do
    columns+=" ${shape}_$mode"
    arguments[${shape}_$mode]="--shape $shape ${modes[$mode]}"
  done
done
run_scenes

cat <<EOF
# What the scenes of an outside user show

$(print_machine)
* command: \`tests/benchmarks/run.sh contact-scenes${*:+ $*}\`

240 and 60: steps a second, with two friction directions, and no body sleeps. plain: \`--plain\`, Bullet as its HelloWorld has it. Shapes are
those of \`--shape\`. Where a run takes more than $limit s of processor time there is a dash. Each scene's last row is the median time of a step [ms].

EOF
print_table
