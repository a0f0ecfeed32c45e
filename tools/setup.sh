# Sourced by demo.sh, test.sh, fuzz.sh and tsan.sh: installs what is missing (Debian packages) and builds. Not run by itself.
set -euo pipefail
root="$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)"
build="${PLUMB_BUILD:-$root/build}"

build_packages=(g++ cmake ninja-build ccache pkg-config libeigen3-dev libyaml-cpp-dev libtbb-dev nlohmann-json3-dev
  libcli11-dev libspdlog-dev libfmt-dev libxxhash-dev libceres-dev libnanoflann-dev
  libsqlite3-dev libbz2-dev zlib1g-dev libpng-dev)
test_packages=(libpcl-dev libflann-dev libcgal-dev libgtest-dev libgmock-dev librapidcheck-dev libbenchmark-dev
  python3 python3-jsonschema python3-numpy python3-scipy python3-yaml slurm-wlm munge clang-format clang-tidy)

fuzz_packages=(clang libclang-rt-14-dev)
build_targets=()  # all of them

# install_packages NAME...: those that are not there yet.
install_packages() {
  local missing=() package
  for package in "$@"; do
    dpkg-query -W -f='${Status}' "$package" 2>/dev/null | grep -q 'ok installed' || missing+=("$package")
  done
  [ ${#missing[@]} -eq 0 ] && return 0
  echo "installing: ${missing[*]}"
  local as_root=()
  if [ "$(id -u)" -ne 0 ]; then as_root=(sudo); fi
  "${as_root[@]}" apt-get -o DPkg::Lock::Timeout=300 update -q >/dev/null
  DEBIAN_FRONTEND=noninteractive "${as_root[@]}" apt-get -o DPkg::Lock::Timeout=300 install -y -q --no-install-recommends "${missing[@]}" >/dev/null
}

# build_all CMAKE-OPTION...: configures and builds; what the compiler says is kept in build.log and shown when it fails.
build_all() {
  mkdir -p "$build"
  echo "building in $build (on two cores a first build takes about six minutes, with the tests twenty-two)"
  if ! { cmake -S "$root" -B "$build" -G Ninja "$@" && ninja -C "$build" "${build_targets[@]}"; } >"$build/build.log" 2>&1; then
    tail -n 60 "$build/build.log"
    echo "the build failed; all of it is in $build/build.log" >&2
    exit 1
  fi
}
