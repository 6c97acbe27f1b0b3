# For demos/run and tests/run: the packages and the configuration of the build in build/. Sourced, not run.

# The packages that the library needs; what tetskin_drop needs in addition, and what all demos need; what the unit tests
# need in addition to the library, and what all tests need in addition to all of these. For Debian 12, Ubuntu 24.04 and
# later.
library_packages=(g++ cmake ninja-build libbullet-dev libeigen3-dev libassimp-dev libtinygltf-dev)
drop_packages=(libcli11-dev nlohmann-json3-dev libjs-three)
demo_packages=(libbenchmark-dev python3-matplotlib)
# Packages for the page that runs in browsers; it needs only the headers of the libraries.
live_packages=(emscripten nodejs cmake ninja-build libeigen3-dev libtinygltf-dev nlohmann-json3-dev libjs-three python3)
test_packages=(libgtest-dev)
check_packages=(ccache clang clang-format-14 clang-tidy-14 pkgconf binutils doxygen libegl-dev libgl1-mesa-dri
  qemu-user-static python3-venv python3-dev debootstrap)
# Another browser of its kind will do: Ubuntu has none as a package.
if ! command -v chromium-browser google-chrome >/dev/null; then check_packages+=(chromium); fi

# Installs the packages that are missing, and prints their names first. Without root or sudo, or without apt, prints
# what to do.
require_packages() {
  local missing=() package
  if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then
    local tool
    for tool in cmake c++; do
      if ! command -v "$tool" >/dev/null; then
        echo "This system has no apt. Install with its own package manager: CMake 3.21, a C++17 compiler, Bullet, Eigen," \
          "assimp, tinygltf (for glTF), CLI11, nlohmann-json, three.js (for pages) and, for the tests, GoogleTest and Google Benchmark; then run this again. Missing: $tool" >&2
        exit 1
      fi
    done
    return
  fi
  for package in "$@"; do
    dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null | grep -qx installed || missing+=("$package")
  done
  [ ${#missing[@]} -gt 0 ] || return 0

  local install="apt-get install -y --no-install-recommends ${missing[*]}"
  local sudo=()
  if [ "$(id -u)" -ne 0 ]; then
    if ! command -v sudo >/dev/null; then
      echo "Missing packages. As root, run: apt-get update && $install" >&2
      exit 1
    fi
    sudo=(sudo)
  fi
  echo "Installing missing packages: ${missing[*]}"
  "${sudo[@]}" apt-get update -qq
  "${sudo[@]}" env DEBIAN_FRONTEND=noninteractive $install
}

# The package with the runtime that clang needs for the fuzzers: libclang-rt-14-dev on Debian 12. Clang itself is
# installed already, or will be.
fuzzer_runtime() {
  local version
  version=$(apt-cache depends clang 2>/dev/null | sed -n 's/.*Depends: clang-\([0-9]*\).*/\1/p' | head -n 1)
  echo "libclang-rt-${version:-14}-dev"
}

# configure REPOSITORY [CMAKE ARGUMENTS]: configures build/, Release. Fast when nothing has changed. By the exported
# commands, the Python package finds objects that have been compiled already.
configure() {
  local repository=$1
  shift
  local generator=()
  if [ ! -f "$repository/build/CMakeCache.txt" ] && command -v ninja >/dev/null; then generator=(-G Ninja); fi
  cmake -S "$repository" -B "$repository/build" "${generator[@]}" -DCMAKE_BUILD_TYPE=Release \
    -DCMAKE_EXPORT_COMPILE_COMMANDS=ON "$@"
}
