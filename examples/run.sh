#!/usr/bin/env bash
# The main job: packs solids, drops a pile of them into a container in a Bullet world, and shows what happened.
#
#   ./examples/run.sh                      the project's own solids
#   ./examples/run.sh --mesh bunny.obj     yours; may be repeated
#
# All options go to `innersphere scene run pile`; see ./build/bin/innersphere scene run --help.
# Writes build/pile.png (a picture) and build/pile.html (a replay: open it in a browser).
set -euo pipefail
mesh_dir=$PWD
cd "$(dirname "${BASH_SOURCE[0]}")/.."
. examples/setup.sh

# Mesh paths are the caller's, relative to where they called from.
arguments=()
previous=
for argument in "$@"; do
  case "$previous:$argument" in
    --mesh:/*) ;;
    --mesh:*) argument=$mesh_dir/$argument ;;
    *:--mesh=/*) ;;
    *:--mesh=*) argument=--mesh=$mesh_dir/${argument#--mesh=} ;;
  esac
  previous=$argument
  arguments+=("$argument")
done

# shellcheck disable=SC2086  # a list of names
need_packages $build_packages
mapfile -t cuda < <(cuda_for_this_machine)
# Several sources to a compiler run: half of the time.
build release innersphere -DINNERSPHERE_TESTS=OFF -DINNERSPHERE_PRECISIONS=float32 -DCMAKE_UNITY_BUILD=ON "${cuda[@]}"
./build/bin/innersphere scene run pile --seconds 5 --png build/pile.png --html build/pile.html --force \
  ${arguments[@]+"${arguments[@]}"}
say ""
say "Picture: $PWD/build/pile.png"
say "Replay:  $PWD/build/pile.html (open it in a browser)"
