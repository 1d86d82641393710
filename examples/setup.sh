# shellcheck shell=bash
# Sourced by examples/run.sh and tests/run.sh: gets what a build needs from apt, and builds.

say() { printf '%s\n' "$*" >&2; }

# attend COMMAND...: runs it, and is never silent for long. A terminal shows all that it says; elsewhere its last line
# shows twice a minute, and the end of it all if it fails.
attend() {
  if [ -t 2 ]; then
    "$@" >&2
    return
  fi
  local log ticker status=0
  log=$(mktemp)
  while sleep 30 >/dev/null 2>&1 && kill -0 $$; do say "  ... $(tail -n 1 "$log")"; done &
  ticker=$!
  "$@" >"$log" 2>&1 || status=$?
  kill "$ticker" 2>/dev/null || true
  wait "$ticker" 2>/dev/null || true
  [ "$status" -eq 0 ] || tail -n 60 "$log" >&2
  rm -f "$log"
  return "$status"
}

# need_packages NAME...: installs what is missing; without root or apt, names it and stops.
need_packages() {
  local missing=() package count megabytes
  local install=(apt-get install -y --no-install-recommends)
  if ! command -v dpkg-query >/dev/null; then
    say "This script installs Debian or Ubuntu packages, and there is no dpkg here."
    say "Install what corresponds to these, then build with: cmake --preset release && cmake --build --preset release"
    say "  $*"
    exit 1
  fi
  for package in "$@"; do
    dpkg-query -W -f '${Status}\n' "$package" 2>/dev/null | grep -q '^install ok installed$' || missing+=("$package")
  done
  [ ${#missing[@]} -eq 0 ] && return
  if [ "$(id -u)" -ne 0 ] || ! command -v apt-get >/dev/null; then
    say "These packages are missing, and without root and apt this script cannot install them:"
    say "  ${missing[*]}"
    say "As root: apt-get install --no-install-recommends ${missing[*]}"
    exit 1
  fi
  export DEBIAN_FRONTEND=noninteractive
  say "Asking apt what there is ..."
  attend apt-get update || exit 1
  # A line for each package: address, name, size in bytes, hash.
  read -r count megabytes < <("${install[@]}" -qq --print-uris "${missing[@]}" | awk '{ n++; s += $3 } END { printf "%d %.0f\n", n, s / 1e6 }')
  say "Installing $count packages, $megabytes MB to download, for: ${missing[*]}"
  attend "${install[@]}" "${missing[@]}" || exit 1
}

# shellcheck disable=SC2034  # by those who source this
build_packages="g++ cmake ninja-build pkg-config libbullet-dev libtbb-dev libeigen3-dev libassimp-dev libembree-dev \
libcli11-dev nlohmann-json3-dev libpng-dev zlib1g-dev libjs-three"

# shellcheck disable=SC2034
python_packages="python3-dev python3-venv"

# python_environment FOLDER NAME...: makes a virtual environment with these packages from PyPI, which Debian has too old or not.
python_environment() {
  local folder=$1
  shift
  if [ -x "$folder/bin/python" ] && "$folder/bin/python" -c 'import sys, importlib.metadata as m; [m.version(name) for name in sys.argv[1:]]' \
    "$@" 2>/dev/null; then
    return
  fi
  say "Installing Python packages into $folder: $*"
  attend /usr/bin/python3 -m venv "$folder" || exit 1
  attend "$folder/bin/pip" install --quiet --disable-pip-version-check "$@" || exit 1
}

# cuda_architectures: those of the cards that are here; fails if there is none.
cuda_architectures() {
  local found
  found=$(nvidia-smi --query-gpu=compute_cap --format=csv,noheader 2>/dev/null) && tr -d . <<<"$found" | sort -u | paste -sd ';'
}

# cuda_for_this_machine: CMake's options for the card that is here, or for none. All cards take ten times as long.
cuda_for_this_machine() {
  local architectures
  if architectures=$(cuda_architectures); then
    printf '%s\n' -DINNERSPHERE_CUDA=AUTO "-DCMAKE_CUDA_ARCHITECTURES=$architectures"
  else
    printf '%s\n' -DINNERSPHERE_CUDA=OFF
  fi
}

# count_steps FOLDER TARGET: what ninja would do. Its rule to run cmake again is left out, for a dry run stops there.
count_steps() {
  local plan=$1/count_steps.ninja
  sed '/^build build\.ninja/,/^$/d' "$1/build.ninja" >"$plan"
  ninja -C "$1" -f "${plan##*/}" -n "$2" | grep -c '^\[' || true
  rm -f "$plan"
}

# build PRESET TARGET [CMAKE_OPTION...]: configures and builds, and says beforehand how long that takes.
build() {
  local preset=$1 target=$2 folder=build-$1 log steps seconds
  [ "$preset" != release ] || folder=build
  shift 2
  log=$(mktemp)
  say "Configuring ($preset) ..."
  # Off unless it is asked for: the folder remembers what was asked for last.
  local show=/dev/null
  [ ! -t 2 ] || show=/dev/stderr  # it may take 20 s on a busy machine
  if ! cmake --preset "$preset" -DCMAKE_UNITY_BUILD=OFF "$@" 2>&1 | tee "$log" >"$show"; then
    tail -n 40 "$log" >&2
    exit 1
  fi
  [ -t 2 ] || grep -A 6 '^-- InnerSphere ' "$log" | sed 's/^-- //' >&2
  rm -f "$log"
  steps=$(count_steps "$folder" "$target")
  [ "$steps" -gt 0 ] || return 0
  # A step takes about 4 s: measured for the tool, as processor time of two busy cores of an AMD EPYC (Zen 3).
  seconds=$((steps * 4 / $(nproc)))
  say "Building $target: $steps steps, about $(((seconds + 59) / 60)) min on $(nproc) free cores like an AMD EPYC's (longer with CUDA) ..."
  attend cmake --build --preset "$preset" --target "$target" || exit 1
}
