#!/usr/bin/env bash
# Installs the package from this clone into a new virtual environment, and runs its tests there.
#
#   pip_install.sh PYTHON FOLDER [PIP_OPTION...]
set -euo pipefail
python=$1 folder=$2
shift 2
tests=$(dirname "$(realpath "${BASH_SOURCE[0]}")")
rm -rf "$folder"
"$python" -m venv "$folder"
"$folder/bin/pip" install --quiet --only-binary pybullet pybullet || echo "no wheel of PyBullet for $python: its tests are skipped"
"$folder/bin/pip" install --quiet pytest "$(dirname "$(dirname "$tests")")" "$@"
cd "$folder"  # away from the sources
env -u PYTHONPATH "$folder/bin/python" -m pytest -q -p no:cacheprovider -W error "$tests"

# Only what Python and PyBullet look for is exported, and no library of the project is asked for.
module=$("$folder/bin/python" -c 'import innersphere._core as m; print(m.__file__)')
if nm -D --defined-only "$module" | grep -Ev ' (PyInit__core|(initPlugin|exitPlugin|executePluginCommand)_innersphere)$'; then
  echo "$module exports more than its entry and those of PyBullet's plug-in" >&2
  exit 1
fi
if readelf -d "$module" | grep NEEDED | grep -i innersphere; then
  echo "$module needs an installed library of InnerSphere" >&2
  exit 1
fi
"$folder/bin/python" - <<'CHECK'
import pathlib, innersphere
folder = pathlib.Path(innersphere.__file__).parent
assert (folder / "py.typed").exists()
assert "def overlap(" in (folder / "_core.pyi").read_text()
CHECK
