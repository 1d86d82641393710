#!/usr/bin/env bash
# The trade of speed for accuracy, beside Bullet's own ways to collide moving non-convex bodies:
#
#   ./tests/benchmarks/run.sh trade FOLDER [OPTIONS]     for example: --solids torus,bunny.obj --spheres 4096
#
# writes trade.csv, plots (trade*.png), pictures (shape-*.png) and trade.html, a page with all of it, into FOLDER. OPTIONS
# go to trade_measure; see its --help. Takes about 20 minutes on two cores that have nothing else to do.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
run=$here/run.sh
if [ $# -eq 0 ]; then
  sed -n '2,7p' "$0" | cut -c 3- >&2
  exit 2
fi
# shellcheck source=examples/setup.sh
. "$here/../../examples/setup.sh"
need_packages gnuplot-nox
out=$1
shift
mkdir -p "$out"

"$run" trade_measure --output "$out/trade.csv" "$@"
for picture in scenes rates volume direction pressure; do
  plot=$out/trade-$picture.png
  [ $picture = scenes ] && plot=$out/trade.png
  gnuplot -e "table='$out/trade.csv'; picture='$picture'; output='$plot'" "$here/trade.gp"
done
for shape in packing gimpact spheres convex; do
  spheres=1000
  [ $shape = spheres ] && spheres=256
  "$run" innersphere scene run bowls --seconds 2 --shape $shape --spheres $spheres --concavity 0.01 \
    --png "$out/shape-$shape.png" --width 480 --height 300 --force >/dev/null
done
"$here/trade_page.sh" "$out" >"$out/trade.html"
printf 'wrote %s\n' "$out/trade.html" >&2
