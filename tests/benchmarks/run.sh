#!/usr/bin/env bash
# Builds and runs one benchmark:
#
#   ./tests/benchmarks/run.sh PART [ARGUMENTS]      for example: packing_benchmark --help
#
# Tables go to stdout as Markdown. To keep one: redirect it into tests/benchmarks/results/PART.md.
set -euo pipefail
caller=$PWD
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
cd "$here/../.."
. examples/setup.sh

part=${1:-}
if [ -z "$part" ]; then
  say "usage: tests/benchmarks/run.sh PART [ARGUMENTS]"
  exit 2
fi
shift

# shellcheck disable=SC2086  # a list of names
need_packages $build_packages libbenchmark-dev
build release -DINNERSPHERE_BENCHMARKS=ON -DINNERSPHERE_TESTS=OFF
program=$PWD/build/bin/$part
if [ ! -x "$program" ]; then
  say "There is no benchmark $part; see innersphere_benchmark() in tests/benchmarks/CMakeLists.txt."
  exit 2
fi
cd "$caller"
exec "$program" "$@"
