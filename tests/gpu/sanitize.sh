#!/usr/bin/env bash
# Runs the tests that need a device under compute-sanitizer, each in a process of its own, several at a time:
#
#   ./tests/gpu/sanitize.sh BIN [TOOL ...]    BIN: where the test programs are; TOOL: memcheck, racecheck and initcheck
#
# Kernels are thousands of times slower there, so tests go through few of their like cases (see cases.hpp). JOBS is how many
# run at once, LIMIT how many seconds each may take. A line for each says what became of it; one that is not "ok" is a failure.
# ALostDeviceIsNamed is left out: it provokes what the tools report. Where several threads launch kernels, racecheck loses
# track of one now and then, and says so: then it tries again.
set -euo pipefail
if [ $# -eq 0 ]; then
  sed -n '2,9p' "$0" | cut -c 3- >&2
  exit 2
fi
bin=$1
shift
export INNERSPHERE_FEW_CASES=1 INNERSPHERE_REQUIRE_GPU=1 LIMIT=${LIMIT:-300}
logs=$(mktemp -d)
export logs

tests() { # PROGRAM
  "$1" --gtest_list_tests --gtest_filter='Cuda/*:Device*-*Lost*' |
    awk -v program="$1" '/^[^ ]/ && /\.$/ { suite = $1 } /^ / { print program, suite $1 }'
}
run() { # TOOL PROGRAM TEST
  local options=() log=$logs/$1.${3//\//.} start=$SECONDS verdict
  if [ "$1" = memcheck ]; then options=(--leak-check full); fi
  for _ in 1 2 3; do
    verdict=ok
    timeout "$LIMIT" compute-sanitizer --tool "$1" --error-exitcode 1 "${options[@]}" "$2" --gtest_filter="$3" >"$log" 2>&1 ||
      verdict="failed ($?)"
    if ! grep -q 'Internal Sanitizer Error' "$log"; then break; fi
  done
  printf '%s %s: %s, %d s; %s\n' "$1" "$3" "$verdict" $((SECONDS - start)) "$(grep SUMMARY "$log" | tr '\n' ' ')"
  if [ "$verdict" != ok ]; then
    sed 's/^/    /' "$log" | head -n 40
    return 1
  fi
}
export -f run

tools=("$@")
if [ ${#tools[@]} -eq 0 ]; then tools=(racecheck memcheck initcheck); fi
list=$(tests "$bin/conformance_tests" && tests "$bin/gpu_unit_tests")
status=0
for tool in "${tools[@]}"; do sed "s/^/$tool /" <<<"$list"; done |
  xargs -P "${JOBS:-8}" -L 1 bash -c 'run "$@"' run || status=1
rm -rf "$logs"
exit $status
