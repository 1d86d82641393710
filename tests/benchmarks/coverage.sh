#!/usr/bin/env bash
# Pictures of what spheres cover, of all solids of the project and of meshes:
#
#   ./tests/benchmarks/run.sh coverage FOLDER [MESH...]     for example: pictures *.obj
#
# Each solid is packed with 256 spheres, above by radius and below in the order of coverage, and its surface coloured by the
# distance to the nearest sphere. Writes FOLDER/solids.png, and FOLDER/meshes.png of the MESHes; stdout is a table of the
# pictures in their order, six in a row, with the largest gaps. SPHERES=COUNT in the environment takes another number.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
if [ $# -eq 0 ]; then
  sed -n '2,8p' "$0" | cut -c 3- >&2
  exit 2
fi
# shellcheck source=examples/setup.sh
. "$here/../../examples/setup.sh"
need_packages imagemagick
out=$1
shift
mkdir -p "$out"
parts=$(mktemp -d)
trap 'rm -rf "$parts"' EXIT

mapfile -t solids < <("$here/run.sh" innersphere solids | awk '{print $1}')
tool=$here/../../build-benchmarks/bin/innersphere

# picture SOURCE ORDER: FOLDER of parts gets a picture, stdout the largest gap.
picture() {
  local packing=$parts/x.cbor
  "$tool" pack "$1" --repair --spheres "${SPHERES:-256}" --order "$2" -o "$packing" --force 2>/dev/null |
    awk '/^surface gap, max/ {print $6}'
  "$tool" view "$packing" --colour coverage --show surface --width 210 --height 160 --samples 12 \
    --png "$parts/$2.png" --force 2>/dev/null
}

# sheet NAME SOURCE...: FOLDER/NAME.png shows the sources.
sheet() {
  local name=$1 source radius coverage tiles=()
  shift
  for source in "$@"; do
    if ! radius=$(picture "$source" radius) || ! coverage=$(picture "$source" coverage); then
      say "$source is left out: it cannot be packed"
      continue
    fi
    tiles+=("$parts/tile-${#tiles[@]}.png")
    convert "$parts/radius.png" "$parts/coverage.png" -append "${tiles[-1]}"
    printf '| %s | %s | %s |\n' "$(basename "${source%.*}")" "$radius" "$coverage"
  done
  montage "${tiles[@]}" -tile 6x -geometry +2+2 miff:- | convert - -dither None -colors 64 "PNG8:$out/$name.png"
  say "wrote $out/$name.png"
}

printf '| solid | largest gap by radius, %% of the diagonal | in the order of coverage |\n|---|---|---|\n'
sheet solids "${solids[@]}"
if [ $# -gt 0 ]; then sheet meshes "$@"; fi
