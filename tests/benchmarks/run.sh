#!/usr/bin/env bash
# Builds and runs one benchmark:
#
#   ./tests/benchmarks/run.sh PART [ARGUMENTS]      for example: packing_benchmark --help
#
# PARTs `bench`, `coverage`, `query`, `scenes`, `contact-scenes`, `solver`, `substep` and `trade` run all that belongs to one question:
# see bench.sh, coverage.sh, query.sh, scenes.sh, contact_scenes.sh, solver.sh, substep.sh, trade.sh. Tables go to stdout as Markdown. To
# keep one: redirect it into tests/benchmarks/results/PART.md. Only what the part needs is built, in build-benchmarks/, and CUDA only where
# there is a device.
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
if [[ $part =~ ^(bench|coverage|query|scenes|contact-scenes|solver|substep|trade)$ ]]; then
  cd "$caller"
  exec "$here/${part//-/_}.sh" "$@"
fi

# shellcheck disable=SC2086  # a list of names
need_packages $build_packages libfcl-dev
cuda=OFF
if nvidia-smi >/dev/null 2>&1; then cuda=AUTO; fi
log=$(mktemp)
say "Building $part ..."
if ! cmake --preset release -B build-benchmarks -DINNERSPHERE_CUDA=$cuda -DINNERSPHERE_BENCHMARKS=ON \
    -DINNERSPHERE_TESTS=OFF >"$log" 2>&1; then
  tail -n 40 "$log" >&2
  exit 1
fi
grep '^-- FCL is not found' "$log" >&2 || true
if ! cmake --build build-benchmarks --target "$part" >"$log" 2>&1; then
  grep -q 'unknown target' "$log" && say "There is no benchmark $part; see innersphere_benchmark() in tests/benchmarks/CMakeLists.txt."
  tail -n 40 "$log" >&2
  exit 1
fi
rm -f "$log"
cd "$caller"
exec "$here/../../build-benchmarks/bin/$part" "$@"
