#!/usr/bin/env bash
# Installs the package into a new virtual environment, and runs its tests there.
#
#   pip_install.sh PYTHON FOLDER                                  builds it from this clone
#   pip_install.sh PYTHON FOLDER --no-index --find-links WHEELS   takes a wheel, which must need nothing of the system
#
# INNERSPHERE_PYBULLET="--only-binary pybullet pybullet==3.2.5" takes that PyBullet, and "--no-binary pybullet pybullet==3.2.7"
# builds it from its sources, which takes 12 minutes of a core. Without, it is the newest that is there for this Python, if any.
set -euo pipefail
python=$1 folder=$2
shift 2
tests=$(dirname "$(realpath "${BASH_SOURCE[0]}")")
rm -rf "$folder"
"$python" -m venv "$folder"
"$folder/bin/pip" install --quiet --disable-pip-version-check numpy pytest
if [ -n "${INNERSPHERE_PYBULLET:-}" ]; then
  # shellcheck disable=SC2086  # options and names
  "$folder/bin/pip" install --quiet --disable-pip-version-check $INNERSPHERE_PYBULLET
else
  "$folder/bin/pip" install --quiet --disable-pip-version-check --only-binary pybullet pybullet ||
    echo "no wheel of PyBullet for $python: its tests are skipped"
fi
if [ $# -gt 0 ]; then
  "$folder/bin/pip" install --quiet --disable-pip-version-check "$@" innersphere
else
  "$folder/bin/pip" install --quiet --disable-pip-version-check "$(dirname "$(dirname "$tests")")"
fi
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
INNERSPHERE_FROM_WHEEL=$# "$folder/bin/python" - <<'CHECK'
import os, pathlib, innersphere
folder = pathlib.Path(innersphere.__file__).parent
assert (folder / "py.typed").exists()
assert "def overlap(" in (folder / "_core.pyi").read_text()
if int(os.environ["INNERSPHERE_FROM_WHEEL"]):
    # What is mapped into the process beside Python's own: parts of the wheel, and what any Linux has.
    with open("/proc/self/maps") as maps:
        mapped = {pathlib.Path(line.split()[-1]) for line in maps if ".so" in line}
    system = sorted(p.name for p in mapped if p.parts[:2] in (("/", "usr"), ("/", "lib")) and "python" not in str(p))
    common = ("ld-", "libc.", "libm.", "libdl", "librt", "libpthread", "libstdc++", "libgcc_s", "libz", "libexpat", "libffi",
              "libcrypto", "libssl", "libbz2", "liblzma", "libuuid", "libutil")
    assert all(name.startswith(common) for name in system), system
    print("parts inside:", sorted(p.name for p in mapped if "innersphere.libs" in str(p)))
CHECK
