# The beginning of this folder's scripts. Sourced, not run.
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

# needs COMMAND [PACKAGE]: ends the script unless the command exists; PACKAGE is the Debian package that contains it.
needs() {
  command -v "$1" >/dev/null || not_run "no $1${2:+ (apt-get install $2)}"
}

# fail WHY: ends the script.
fail() {
  echo "failed: $*" >&2
  exit 1
}

# same_hello COMMAND...: runs the program built from demos/examples/hello.cpp. Its heights must be those in hello.txt, on every
# platform: they are printed with three decimals, and rounding may change the last one by 1.
same_hello() {
  "$@" >"$folder/hello_output.txt" || fail "$* ended with status $?"
  tr -d '\r' <"$folder/hello_output.txt" | awk '
    !/^frame/ { next }
    { height = $NF; $NF = "" }
    NR == FNR { expected[++lines] = height; frame[lines] = $0; next }
    { ++found; off = height - expected[found]; if ($0 != frame[found] || off * off > 0.0011 ^ 2) wrong = 1 }
    END { exit wrong || found != lines || lines == 0 }' "$repository/tests/platforms/hello.txt" - ||
    fail "$* prints other heights than hello.txt"
}

# debian_bullet PRECISION FOLDER: copies Debian's libraries of Bullet, float or double, to a folder, under the names that
# Bullet's own build gives them.
debian_bullet() {
  local suffix= from part
  [ "$1" = float ] || suffix=-float64
  from=$(find /usr/lib -name "libBulletSoftBody$suffix.so" -printf '%h' -quit)
  [ -n "$from" ] || not_run "no Bullet of Debian (apt-get install libbullet-dev)"
  mkdir -p "$2"
  for part in BulletSoftBody BulletDynamics BulletCollision LinearMath; do
    cp -L "$from/lib$part$suffix.so" "$2/lib$part.so"
  done
}

# form OPTIONS...: configures the application in tests/platforms/form: demos/examples/hello.cpp and the sources of this
# repository.
form() {
  rm -rf "$folder/form"
  cmake -S "$repository/tests/platforms/form" -B "$folder/form" -G Ninja -DCMAKE_BUILD_TYPE=Release \
    -DREPOSITORY="$repository" -DTETSKIN_SOURCE="$repository" "$@"
}

# linked: the libraries of Bullet that the application links, as it names them, in their order.
linked() {
  ninja -C "$folder/form" -t commands hello | tail -n 1 | tr ' ' '\n' | grep -E 'Bullet|LinearMath' | grep -v rpath
}

# links_only FOLDER: the application links four libraries of Bullet, all in this folder.
links_only() {
  linked
  [ "$(linked | grep -c "^$1/lib[A-Za-z]*\.\(so\|a\)$")" -eq 4 ] && [ "$(linked | wc -l)" -eq 4 ] ||
    fail "hello does not link the four libraries in $1, and no others"
}

# run_form OPTIONS...: builds the application and runs it: with the libraries installed in TETSKIN_PREFIX, if this is
# set, otherwise with this repository's sources.
run_form() {
  local package=()
  if [ -n "${TETSKIN_PREFIX:-}" ]; then package=(-DTETSKIN_SOURCE= -DCMAKE_PREFIX_PATH="$TETSKIN_PREFIX"); fi
  form "${package[@]}" "$@"
  cmake --build "$folder/form" --target hello
  same_hello "$folder/form/hello"
}

# pinned FILE HASH: ends the script unless the file has this SHA-256.
pinned() {
  local found
  found=$(sha256sum "$1" | cut -d ' ' -f 1)
  [ "$found" = "$2" ] || fail "the SHA-256 of $1 is not the pinned one: expected $2, found $found." \
    "Remove the file and run again, or set BULLET_SOURCE to a folder of Bullet's sources"
}

# distribution_source PACKAGE FILE: fetches the file, which is part of the distribution's newest source package of this
# name. apt uses separate sources, lists and cache here, and runs no hooks: the machine's stay unchanged, and any user
# may run this.
distribution_source() {
  local apt=$folder/apt list
  command -v apt-get >/dev/null || return 1
  rm -rf "$apt"
  mkdir -p "$apt/sources" "$apt/lists/partial" "$apt/cache"
  for list in /etc/apt/sources.list /etc/apt/sources.list.d/*.list /etc/apt/sources.list.d/*.sources; do
    [ ! -f "$list" ] || sed -E 's/^deb[[:space:]]/deb-src /; s/^Types:.*/Types: deb-src/' "$list" \
      >"$apt/sources/$(basename "$list")"
  done
  cat >"$apt/apt.conf" <<END
Dir::Etc::SourceList "/dev/null";
Dir::Etc::SourceParts "$apt/sources";
Dir::State::Lists "$apt/lists";
Dir::Cache "$apt/cache";
#clear APT::Update;
END
  # This also fails where one of the machine's sources cannot be reached, which need not be the one with the package.
  apt-get -q -c "$apt/apt.conf" update || true
  (cd "$apt" && apt-get -q -c "$apt/apt.conf" source --download-only "$1") || return 1
  mv "$apt/$(basename "$2")" "$2" || return 1
  rm -rf "$apt"
}

# bullet_source: sets `bullet` to a folder with the sources of Bullet: BULLET_SOURCE, if this is set, otherwise those of
# version 3.24 in the distribution, for which a mirror of packages is enough, or else those of version 3.25 on GitHub.
# Either is fetched and unpacked once; its hash is checked each time.
bullet_source() {
  local all=$repository/build/platforms
  local packaged=$all/bullet_3.24+dfsg.orig.tar.xz released=$all/bullet3-3.25.tar.gz archive
  bullet=${BULLET_SOURCE:-}
  if [ -z "$bullet" ]; then
    [ -f "$packaged" ] || [ -f "$released" ] || distribution_source bullet "$packaged" ||
      { curl -fsSL --retry 2 --max-time 300 -o "$released.part" \
        https://github.com/bulletphysics/bullet3/archive/refs/tags/3.25.tar.gz && mv "$released.part" "$released"; } ||
      not_run "neither apt's sources nor GitHub gave Bullet's sources, and BULLET_SOURCE is not set to a folder of them"
    if [ -f "$packaged" ]; then
      archive=$packaged bullet=$all/bullet3-3.24
      pinned "$archive" 43c1edae2024ba18bb5d7bfd3bb2394b066a79151a29789504a2d8efcdc333d7
    else
      archive=$released bullet=$all/bullet3-3.25
      pinned "$archive" c45afb6399e3f68036ddb641c6bf6f552bf332d5ab6be62f7e6c54eda05ceb77
    fi
    if [ ! -d "$bullet" ]; then
      rm -rf "$folder/unpacked"
      mkdir "$folder/unpacked"
      tar -xf "$archive" -C "$folder/unpacked"
      mv -T "$folder/unpacked/$(basename "$bullet")" "$bullet"
    fi
  fi
  [ -f "$bullet/src/btBulletCollisionCommon.h" ] || fail "no Bullet in $bullet"
  echo "Bullet $(cat "$bullet/VERSION") in $bullet"
}
# Bullet's own build asks for a version of CMake that recent ones do not support.
bullet_options=(-DCMAKE_POLICY_VERSION_MINIMUM=3.5)
if [ -z "${CMAKE_CXX_COMPILER_LAUNCHER:-}" ] && command -v ccache >/dev/null; then
  export CMAKE_CXX_COMPILER_LAUNCHER=ccache
fi

# tetskin_prefix: sets `prefix` to an installation of this repository: TETSKIN_PREFIX, or one that is built.
tetskin_prefix() {
  prefix=${TETSKIN_PREFIX:-}
  [ -z "$prefix" ] || return 0
  local built=$repository/build/platforms/tetskin
  prefix=$built/prefix
  cmake -S "$repository" -B "$built" -G Ninja -DCMAKE_BUILD_TYPE=Release -DTETSKIN_TESTS=OFF -DTETSKIN_DEMOS=OFF \
    -DTETSKIN_IO=OFF -DCMAKE_INSTALL_PREFIX="$prefix"
  cmake --build "$built" --target tetskin_libraries --parallel "$(nproc)"
  cmake --install "$built" >/dev/null
}

# drop_hashes COMMAND...: runs drop_hash, and prints a hash of the nodes' positions for each instruction set. Those
# listed in hashes.txt must be equal.
drop_hashes() {
  "$@" >"$folder/hashes.txt" || fail "$* ended with status $?"
  tr -d '\r' <"$folder/hashes.txt" >"$folder/found.txt"
  cat "$folder/found.txt"
  local set hash
  while read -r set hash; do
    [ "$(sed -n "s/^$set //p" "$folder/found.txt")" = "$hash" ] || ! grep -q "^$set " "$folder/found.txt" ||
      fail "the hash of $set is not that in hashes.txt, $hash"
  done <"$repository/tests/platforms/hashes.txt"
}

# scene_hashes FRAMES COMMAND...: runs replay_hashes, the scenes of tests/replay, for this many frames; 60, 120 and 240
# have hashes. They must be those in hashes.txt.
scene_hashes() {
  "${@:2}" "$1" >"$folder/scenes.txt" || fail "${*:2} ended with status $?"
  tr -d '\r' <"$folder/scenes.txt" >"$folder/found_scenes.txt"
  cat "$folder/found_scenes.txt"
  local scene found expected count=0
  while read -r scene found; do
    expected=$(sed -n "s/^$scene //p" "$repository/tests/platforms/hashes.txt")
    [ -n "$found" ] && [[ "$expected " == "$found "* ]] ||
      fail "the hashes of the scene $scene are not those in hashes.txt, $expected"
    count=$((count + 1))
  done <"$folder/found_scenes.txt"
  [ $count -eq 6 ] || fail "${*:2} printed $count scenes of 6"
}

# run_tests FILTER PROGRAM [LAUNCHER...]: builds a program with tests in the application's folder, and runs those that
# match.
run_tests() {
  cmake --build "$folder/form" --target "$2" --parallel "$(nproc)" | tail -n 3
  local program
  program=$(find "$folder/form" -type f \( -name "$2" -o -name "$2.exe" \) -print -quit)
  "${@:3}" "$program" --gtest_filter="$1" --gtest_brief=1 || fail "$2 $1 has failed"
}

# cross OPTIONS...: configures the application with Bullet from its sources for another system, and builds it.
cross() {
  local folder_of_gtest=/usr/src/googletest/googletest
  [ -d "$folder_of_gtest" ] || not_run "no sources of GoogleTest (apt-get install libgtest-dev)"
  set -- "$@" -DGTEST_FOLDER="$folder_of_gtest"
  bullet_source
  form -DREPLAY_HASHES=ON -DBULLET_FOLDER="$bullet" -DCMAKE_DISABLE_FIND_PACKAGE_Bullet=ON "${bullet_options[@]}" \
    -DEigen3_DIR=/usr/share/eigen3/cmake "$@"
  cmake --build "$folder/form" --target hello drop_hash replay_hashes --parallel "$(nproc)" | tail -n 3
}
