#!/usr/bin/env bash
# What the scenes show, as they are:
#
#   ./tests/benchmarks/run.sh scenes [OPTIONS]     OPTIONS go to `scene check` and `scene run`: for example --backend cuda
#
# prints every truth with what was measured, the energy that packings and GImpact gain from nowhere, and how piles of several seeds
# come to rest, as Markdown. Takes about 20 minutes on two cores.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
"$here/run.sh" innersphere --version >/dev/null  # builds it
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
energy_scenes="drop chain-hang chain-swing bowls nut"
energy_ways=("" "--spheres 256" "--response rigid" "--shape gimpact")
piles="pile large-pile"
seeds="1 2 3 4 5 6 7 8"

# Each line: a file, and the command whose output goes there.
{
  for pile in $piles; do
    for seed in $seeds; do echo "$pile-$seed scene run $pile --seed $seed $*"; done
  done
  echo "check scene check $*"
  for scene in $energy_scenes; do
    for way in "${!energy_ways[@]}"; do echo "$scene-$way scene run $scene ${energy_ways[way]} $*"; done
  done
} | tool=$here/../../build-benchmarks/bin/innersphere work=$work \
  xargs -P "$(nproc)" -L 1 bash -c 'out=$1; shift; "$tool" "$@" >"$work/$out" || [ $? -eq 1 ]' scenes.sh

measured() { sed -n "s/.*$2[^:]*: \([^ ,]*\).*/\1/p" "$work/$1"; }

cat <<EOF
# What the scenes show

* machine: $(sed -n 's/^model name.*: //p' /proc/cpuinfo | head -n 1), $(nproc) hardware threads
* date: $(date +%F), commit $(git -C "$here" describe --always --dirty 2>/dev/null || echo unknown)
* command: \`tests/benchmarks/run.sh scenes${*:+ $*}\`

## Every scene

\`innersphere scene check\`:

\`\`\`
$(grep -v '^  energy  ' "$work/check")
\`\`\`

## Energy from nowhere

All increments of the total energy, over the reference that each scene names. GImpact collides the surfaces that are drawn. Energies are
taken in the middle of steps, for packings and GImpact alike (\`Recording::energyGained()\` says why): with places after the step every body that
falls would lose, and all that swings gain.

| scene | packings, as the scene has them | 256 spheres | rigid | GImpact |
|---|---|---|---|---|
EOF
for scene in $energy_scenes; do
  printf '| %s' "$scene"
  for way in "${!energy_ways[@]}"; do printf ' | %s' "$(measured "$scene-$way" 'energy from nowhere')"; done
  printf ' |\n'
done
cat <<'EOF'

## Piles

At the end of the scene: the largest motion in half a second, over the body's size (rest: 0.01), and how many bodies moved by more.

| scene | seed | largest motion | bodies |
|---|---|---|---|
EOF
for pile in $piles; do
  for seed in $seeds; do
    printf '| %s | %s | %s | %s |\n' "$pile" "$seed" "$(measured "$pile-$seed" 'largest motion')" \
      "$(measured "$pile-$seed" 'bodies that are seen to move')"
  done
done
