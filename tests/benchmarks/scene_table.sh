# Runs scenes in several ways and prints what each truth comes to: a Markdown table. To be sourced; takes $scenes, $columns, and
# ${arguments[COLUMN]} of the tool. A run may take LIMIT (60) seconds of processor time; TOOL is another tool than that built here.
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
tool=${TOOL:-$here/../../build-benchmarks/bin/innersphere}
[ -n "${TOOL:-}" ] || "$here/run.sh" innersphere --version >/dev/null  # builds it
limit=${LIMIT:-60}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

run_scenes() {
  # Each line: a file, and the arguments of the tool whose output goes there. A run that fails or is stopped leaves an empty file
  # and its status.
  for column in $columns; do
    for scene in $scenes; do echo "$scene-$column scene run $scene ${arguments[$column]}"; done
  done | tool=$tool work=$work limit=$limit xargs -P "$(nproc)" -L 1 bash -c '
    out=$1; shift
    ulimit -t "$limit"
    "$tool" "$@" >"$work/$out" 2>"$work/$out.err" || { echo $? >"$work/$out.status"; : >"$work/$out"; }
    echo "$out" >&2' scenes
}

# Lines "what|allowed|holds or MISSED|figure" of a run.
truths() {
  sed -n -E 's/^(truth)? +(holds|MISSED|not shown) +(.*)$/\2|\3/p' "$work/$1" |
    sed -E 's/^([^|]*)\|(.*): ([^ ,]*)[^,]*, ((at most|expected) [^(]*[^( ]) \(.*/\2|\4|\1|\3/'
}

# What one arrangement shows of a truth, by its number.
cell() {
  local row
  row=$(truths "$1" | sed -n "$2p")
  if [ -z "$row" ]; then
    # 137: the kernel ended it at its limit.
    if [ "$(cat "$work/$1.status")" = 137 ]; then printf ' | - timeout'; else printf ' | - error'; fi
  elif [[ $row == *"|holds|"* ]]; then
    printf ' | pass %s' "${row##*|}"
  else
    printf ' | **miss** %s' "${row##*|}"
  fi
}

stepTime() {
  local time
  time=$(sed -n -E 's/^step time +([^ ]*) ms median.*/\1/p' "$work/$1")
  printf ' | %s' "${time:--}"
}

print_machine() {
  cat <<EOF
* machine: $(sed -n 's/^model name.*: //p' /proc/cpuinfo | head -n 1), $(nproc) hardware threads, $(nproc) runs at a time
* date: $(date +%F), commit $(git -C "$here" describe --always --dirty 2>/dev/null || echo unknown)
EOF
}

print_table() {
  printf '| scene | truth'
  for column in $columns; do printf ' | %s' "${column//_/ }"; done
  printf ' |\n|---|---'
  for column in $columns; do printf '|---'; done
  printf '|\n'
  for scene in $scenes; do
    local known= number=0 what allowed
    for column in $columns; do
      if [ -z "$known" ] && [ -s "$work/$scene-$column" ]; then known=$scene-$column; fi
    done
    if [ -z "$known" ]; then
      printf '| %s | - no run ended |\n' "$scene"
      continue
    fi
    while IFS='|' read -r what allowed _; do
      number=$((number + 1))
      printf '| %s | %s: %s' "$scene" "$what" "$allowed"
      for column in $columns; do cell "$scene-$column" "$number"; done
      printf ' |\n'
    done < <(truths "$known")
    printf '| %s | step' "$scene"
    for column in $columns; do stepTime "$scene-$column"; done
    printf ' |\n'
  done
}
