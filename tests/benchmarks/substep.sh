#!/usr/bin/env bash
# Scenes with Bullet's solver and with SubstepSolver, at three steps:
#
#   ./tests/benchmarks/run.sh substep [SCENES]     all of the list below if none is named
#
# prints a Markdown table: every truth, and what each solver shows of it at each step. Takes about half an hour on two cores.
set -euo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/scene_table.sh"
scenes=${*:-stack mass-ratios card-house chain-hang chain-swing chain-heavy rest drop bounce slide roll flip torsion cradle collisions
  tumble bowls soft nut nut-held gears peg maze chazelle pile arch arch-thin dominoes ring-peg half-pipe t-slot gripper gripper-motor
  gear-box chain-rest ring-cylinder carabiner half-pipe-mesh gear-plane gear-mesh drops mixed-pile scan-bin large-pile}
declare -A arguments=()
columns=
for rate in 60 120 240; do
  for solver in substep bullet; do
    columns+=" ${solver}_$rate"
    arguments[${solver}_$rate]="--dt $(awk "BEGIN { printf \"%.9f\", 1 / $rate }") --solver $solver"
  done
done
run_scenes

cat <<EOF
# Scenes with SubstepSolver

$(print_machine)
* command: \`tests/benchmarks/run.sh substep${*:+ $*}\`

Steps a second, with Bullet's solver (two friction directions, ten iterations) and with SubstepSolver, which chose its substeps.
Where a run takes more than $limit s of processor time there is a dash. Each scene's last row is the median time of a step [ms].

EOF
print_table
