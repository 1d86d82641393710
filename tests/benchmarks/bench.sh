#!/usr/bin/env bash
# The truth bench: all engines that are here over all scenes, and one page of what they show. See bench/README.md.
#
#   ./tests/benchmarks/run.sh bench FOLDER [OPTIONS]          writes FOLDER/bench.md, bench.csv and pictures; --help lists OPTIONS
#   ./tests/benchmarks/run.sh bench compare A.csv B.csv       do two machines agree?
set -euo pipefail
caller=$PWD
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
cd "$here/../.."
. examples/setup.sh

# shellcheck disable=SC2086  # a list of names
need_packages $build_packages $python_packages libode-dev
environment=build-benchmarks/bench-env
python_environment $environment nanobind typing_extensions numpy scipy trimesh shapely mapbox_earcut manifold3d matplotlib pillow
# Peers: one that cannot be installed here is a dash on the page.
peers="coacd mujoco pybullet dartpy python-fcl coal"
if command -v nvidia-smi >/dev/null; then peers+=" mujoco-warp"; fi
for package in $peers; do
  $environment/bin/pip show --quiet $package 2>/dev/null ||
    $environment/bin/pip install --quiet --disable-pip-version-check --only-binary :all: $package >&2 || say "There is no $package here."
done

say "Building ..."
log=$(mktemp)
trap 'rm -f "$log"' EXIT
cmake --preset release -B build-benchmarks -DINNERSPHERE_BENCHMARKS=ON -DINNERSPHERE_TESTS=OFF -DINNERSPHERE_CUDA=OFF \
  -DINNERSPHERE_PYTHON=ON "-DPython_EXECUTABLE=$PWD/$environment/bin/python" >"$log" 2>&1 &&
  cmake --build build-benchmarks --target innersphere innersphere_python bench_bullet bench_ode >"$log" 2>&1 ||
  { tail -n 40 "$log" >&2; exit 1; }

build=$PWD/build-benchmarks
cd "$caller"
# The module `bench` is this folder's; the package is that of the build.
export PYTHONPATH=$here:$build/python INNERSPHERE_BENCH_BIN=$build/bin
if [ "${1:-}" != compare ]; then set -- "$@" --tool "$build/bin/innersphere"; fi
exec "$build/bench-env/bin/python" -m bench "$@"
