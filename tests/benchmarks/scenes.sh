#!/usr/bin/env bash
# What the scenes show, as they are:
#
#   ./tests/benchmarks/run.sh scenes [OPTIONS]     OPTIONS go to `scene check` and `scene run`: for example --backend cuda
#
# prints every truth with what was measured, the energy that packings and GImpact gain from nowhere, and how piles of several seeds
# come to rest, as Markdown. Takes about 15 minutes on two cores.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
"$here/run.sh" innersphere --version >/dev/null  # builds it
tool() { "$here/../../build-benchmarks/bin/innersphere" "$@"; }
measured() { sed -n "s/.*$1[^:]*: \([^ ,]*\).*/\1/p"; }

cat <<EOF
# What the scenes show

* machine: $(sed -n 's/^model name.*: //p' /proc/cpuinfo | head -n 1), $(nproc) hardware threads
* date: $(date +%F), commit $(git -C "$here" describe --always --dirty 2>/dev/null || echo unknown)
* command: \`tests/benchmarks/run.sh scenes${*:+ $*}\`

## Every scene

\`innersphere scene check\`:

\`\`\`
EOF
tool scene check "$@" | sed '/^  energy  /d' || true  # it says 1 where a truth is missed

cat <<'EOF'
```

## Energy from nowhere

All increments of the total energy, over the reference that each scene names; GImpact's surfaces are those that are drawn.

| scene | packings, as the scene has them | 256 spheres | rigid | GImpact |
|---|---|---|---|---|
EOF
for scene in drop chain-hang chain-swing bowls nut; do
  row="| $scene"
  for how in "" "--spheres 256" "--response rigid" "--shape gimpact"; do
    # shellcheck disable=SC2086  # words
    row+=" | $(tool scene run $scene "$@" $how | measured 'energy from nowhere')"
  done
  printf '%s |\n' "$row"
done

cat <<'EOF'

## Piles

At the end of the scene: the largest motion in half a second, over the body's size (rest: 0.01), and how many bodies moved by more.

| scene | seed | largest motion | bodies |
|---|---|---|---|
EOF
for scene in pile large-pile; do
  for seed in 1 2 3 4 5 6 7 8; do
    summary=$(tool scene run $scene --seed $seed "$@")
    printf '| %s | %s | %s | %s |\n' $scene $seed "$(measured 'largest motion' <<<"$summary")" \
      "$(measured 'bodies that are seen to move' <<<"$summary")"
  done
done
