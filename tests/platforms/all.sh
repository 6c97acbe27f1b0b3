#!/usr/bin/env bash
# Runs the tests of this folder, or those named, one after the other, and prints a table of results. Exit status 1 if
# one failed; 2 if a name does not exist. It is not a test itself: names of tests have no extension.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
repository=$(cd "$here/../.." && pwd)
logs=$repository/build/platforms/logs
mkdir -p "$logs"

names=("$@")
if [ $# -eq 0 ]; then
  for file in "$here"/*; do
    if [ -f "$file" ] && [ -x "$file" ] && [[ $file != *.* ]]; then names+=("$(basename "$file")"); fi
  done
fi
for name in "${names[@]}"; do
  if [ ! -f "$here/$name" ] || [ ! -x "$here/$name" ] || [[ $name == *.* ]]; then
    echo "tests/platforms has no test $name" >&2
    exit 2
  fi
done

rows=()
passed=0 not_run=0 failed=0
for name in "${names[@]}"; do
  echo "$name ..."
  start=$SECONDS status=0
  "$here/$name" >"$logs/$name.txt" 2>&1 || status=$?
  case $status in
    0) passed=$((passed + 1)) outcome=passed ;;
    77) not_run=$((not_run + 1)) outcome=$(tail -n 1 "$logs/$name.txt") ;;
    *)
      failed=$((failed + 1)) outcome="FAILED: $logs/$name.txt ends with"
      tail -n 20 "$logs/$name.txt"
      ;;
  esac
  rows+=("$(printf '%-24s %5d s  %s' "$name" $((SECONDS - start)) "$outcome")")
  if [ $status -ne 0 ] && [ $status -ne 77 ]; then rows+=("$(tail -n 1 "$logs/$name.txt")"); fi
done

printf '\nplatforms, on %s\n' "$(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -n 1)"
printf '%s\n' "${rows[@]}"
echo "$passed passed, $failed failed, $not_run not run"
[ $failed -eq 0 ]
