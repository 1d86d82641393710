#!/usr/bin/env bash
# pkg_config.sh PREFIX MODULE SOURCE PACKING: compiles and runs a program with nothing but what pkg-config says of a module,
# at PREFIX and again after that has moved.
set -euo pipefail
prefix=$1 module=$2 source=$3 packing=$4
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

hello() {
  local flags
  flags=$(PKG_CONFIG_PATH=$(dirname "$(find "$1" -name "$module.pc")") pkg-config --cflags --libs "$module")
  echo "$flags"
  # shellcheck disable=SC2086  # a list of flags
  "${CXX:-c++}" -std=c++17 -O1 "$source" $flags -o "$work/hello"
  "$work/hello" "$packing"
}
hello "$prefix"
cp -r "$prefix" "$work/moved"
hello "$work/moved" | tee "$work/out"
grep -q -- "-L$work/moved" "$work/out"
