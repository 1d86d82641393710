# Sourced by examples/run.sh and tests/run.sh: gets what a build needs from apt, and builds.

say() { printf '%s\n' "$*" >&2; }

# need_packages NAME...: installs what is missing; without root or apt, names it and stops.
need_packages() {
  local missing=() package
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
  say "Installing: ${missing[*]}"
  local log
  log=$(mktemp)
  if ! { apt-get update && DEBIAN_FRONTEND=noninteractive apt-get install -y --no-install-recommends "${missing[@]}"; } \
      >"$log" 2>&1; then
    tail -n 20 "$log" >&2
    say "apt-get failed; the whole log is in $log"
    exit 1
  fi
  rm -f "$log"
}

build_packages="g++ cmake ninja-build pkg-config libbullet-dev libtbb-dev libeigen3-dev libassimp-dev libembree-dev \
libcli11-dev nlohmann-json3-dev libpng-dev libjs-three"

# build PRESET [CMAKE_OPTION...]: configures and builds quietly; the log is shown if it fails.
build() {
  local preset=$1 log
  shift
  log=$(mktemp)
  say "Building ($preset) ..."
  if ! cmake --preset "$preset" "$@" >"$log" 2>&1; then
    tail -n 40 "$log" >&2
    exit 1
  fi
  grep -A 7 '^-- InnerSphere ' "$log" | sed 's/^-- //' >&2
  if [ -t 2 ]; then
    cmake --build --preset "$preset" >&2
  elif ! cmake --build --preset "$preset" >"$log" 2>&1; then
    tail -n 60 "$log" >&2
    exit 1
  fi
  rm -f "$log"
}
