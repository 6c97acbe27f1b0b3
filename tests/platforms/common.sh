# What the scripts of this folder begin with. Sourced, not run.
set -euo pipefail
repository=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
name=$(basename "$0")
folder=$repository/build/platforms/$name
mkdir -p "$folder"

# not_run WHY: ends the script. This is neither passed nor failed.
not_run() {
  echo "not run: $*"
  exit 77
}

# needs COMMAND [PACKAGE]: ends the script unless the command exists; the package is the one of Debian that has it.
needs() {
  command -v "$1" >/dev/null || not_run "no $1${2:+ (apt-get install $2)}"
}

# fail WHY: ends the script.
fail() {
  echo "failed: $*" >&2
  exit 1
}

# same_hello COMMAND...: runs what was built from demos/hello.cpp. Its heights must be those in hello.txt, on every
# platform: they are printed with three decimals.
same_hello() {
  "$@" >"$folder/hello_output.txt" || fail "$* ended with status $?"
  tr -d '\r' <"$folder/hello_output.txt" | grep ^frame | diff "$repository/tests/platforms/hello.txt" - ||
    fail "$* prints other heights than hello.txt"
}
