# shellcheck shell=bash
# Set-up shared by ./run and ./test: Debian's packages, configuration, build.
#
# Sourced by bash.  Everything said here goes to standard error, so that the program's
# own answer has standard output to itself.  A second call finds nothing to do and takes
# a second.  SIGHTLINE_NO_INSTALL=1 leaves packages alone.

source_dir=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
build_dir=$source_dir/build/default

program_packages=(g++ cmake ninja-build libcgal-dev libeigen3-dev libembree-dev libtbb-dev
  libtinygltf-dev libassimp-dev libminizip-dev libvtk9-dev nlohmann-json3-dev libcli11-dev libfmt-dev)
test_packages=("${program_packages[@]}" libgtest-dev python3)

say() { printf '%s\n' "$*" >&2; }

# Prints those of the named packages that are not installed.
missing_packages() {
  local package
  for package in "$@"; do
    [[ $(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null) == installed ]] ||
      printf '%s ' "$package"
  done
}

# apt-get that asks nothing and removes nothing.  dpkg wants the sbin folders in PATH.
apt_get() {
  DEBIAN_FRONTEND=noninteractive LC_ALL=C PATH=$PATH:/usr/local/sbin:/usr/sbin:/sbin \
    apt-get -q -y --no-remove --no-install-recommends \
    -o Dpkg::Options::=--force-confold -o Dpkg::Use-Pty=0 "$@" </dev/null >&2
}

# Makes sure that the named packages are installed.
install_packages() {
  [[ -z ${SIGHTLINE_NO_INSTALL:-} ]] || return 0
  if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then
    say "Not a Debian system: taking for granted what Debian calls $*"
    return 0
  fi
  local missing
  read -ra missing <<<"$(missing_packages "$@")"
  ((${#missing[@]})) || return 0
  if ((EUID != 0)); then
    say "Packages are missing. As root, run this once, then try again:"
    say "apt-get update && apt-get -y --no-remove --no-install-recommends install ${missing[*]}"
    return 1
  fi
  say "Installing ${missing[*]}"
  lend_proc
  # Package lists that are missing or too old show as a failure; then they are fetched.
  if ! apt_get -s install "${missing[@]}" 2>/dev/null >/dev/null; then
    apt_get update
  fi
  apt_get install "${missing[@]}" || { apt_get update && apt_get install "${missing[@]}"; }
  return_proc
}

# A bare chroot has no /proc, but Java, which libvtk9-dev brings, cannot be set up without.
# Mounted until return_proc or the end of the script, and left as it was found.
lend_proc() {
  [[ ! -e /proc/self ]] || return 0
  if ! mount -t proc proc /proc 2>/dev/null; then
    say "/proc is not mounted and cannot be: run 'mount -t proc proc /proc', then try again"
    return 1
  fi
  trap return_proc EXIT
}

return_proc() {
  [[ $(trap -p EXIT) == *return_proc* ]] || return 0
  trap - EXIT
  umount /proc
}

# Parallel compilations: one per core, and 2 GB of memory for each (CGAL's need it).
build_jobs() {
  local jobs memory_kb
  jobs=$(nproc)
  memory_kb=$(awk '/^MemAvailable:/ {print $2}' /proc/meminfo 2>/dev/null || true)
  if [[ -n $memory_kb ]] && ((memory_kb / 2000000 < jobs)); then
    jobs=$((memory_kb / 2000000))
  fi
  ((jobs > 0)) || jobs=1
  printf '%s\n' "$jobs"
}

# configure [cmake option...]: a release build below build/default.
configure() {
  local generator=()
  if [[ ! -f $build_dir/CMakeCache.txt ]] && command -v ninja >/dev/null; then
    generator=(-G Ninja)
  fi
  cmake -S "$source_dir" -B "$build_dir" "${generator[@]}" "$@" >&2
}

# build [target...]
build() {
  local started=$SECONDS
  cmake --build "$build_dir" --parallel "$(build_jobs)" ${1:+--target "$@"} >&2
  ((SECONDS - started < 10)) || say "Built in $((SECONDS - started)) s"
}

# What the program needs, and no more; tests stay configured where they are.
set_up_program() {
  install_packages "${program_packages[@]}"
  [[ -f $build_dir/build.ninja || -f $build_dir/Makefile ]] || configure -D SIGHTLINE_TESTS=OFF
  build sightline
}

set_up_tests() {
  install_packages "${test_packages[@]}"
  configure -D SIGHTLINE_TESTS=ON
  build
}
