#!/usr/bin/env bash
# Prepares a machine for vantage and builds it: packages, a Mesa whose software Vulkan device has ray queries, configure, build.
# Safe to run again: what is already there is left alone, and an up-to-date build takes seconds.
#
#   ./setup.sh            the program `vantage` and its library, in build/release
#   ./setup.sh --tests    the same, with the tests, the benchmarks and the examples
#   ./setup.sh --packages what the packages and the Python module are built with; nothing is built
#   ./setup.sh --ifc      what reading IFC takes: node, and web-ifc by npm
#   ./setup.sh --laz      what reading LAZ takes: node, and laz-perf by npm
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"

readonly mesa_minimum=24.1 # the first release whose lavapipe has VK_KHR_ray_query
readonly packages=(
  g++ cmake ninja-build pkgconf git ca-certificates
  libvulkan-dev libvulkan-volk-dev libvulkan1 glslang-tools spirv-tools spirv-headers
  libembree-dev libtbb-dev libeigen3-dev libglm-dev libtinygltf-dev nlohmann-json3-dev
  libpng-dev libseccomp-dev libturbojpeg0-dev libcli11-dev libspdlog-dev libcairo2-dev coinor-libclp-dev coinor-libcbc-dev libproj-dev
  libminizip-dev libassimp-dev libdraco-dev libexpat1-dev libgeos-dev libjs-three libmeshoptimizer-dev zlib1g-dev libboost-dev
)
readonly test_packages=(libgtest-dev libgmock-dev librapidcheck-dev libbenchmark-dev vulkan-validationlayers clang-format proj-bin poppler-utils gdal-bin dpkg-dev file mmdebstrap
  pybind11-dev python3-dev python3-pip python3-numpy python3-matplotlib python3-jsonschema libopenmpi-dev openmpi-bin)
readonly packaging_packages=(dpkg-dev file patchelf pybind11-dev python3-dev python3-pip python3-numpy python3-wheel)

mode=program
case "${1-}" in
  "") ;;
  --tests) mode=tests ;;
  --packages) mode=packages ;;
  --ifc) mode=ifc ;;
  --laz) mode=laz ;;
  *) echo "usage: $0 [--tests | --packages | --ifc | --laz]" >&2; exit 2 ;;
esac

say() { printf 'setup: %s\n' "$*" >&2; }
installed() { [ "$(dpkg-query -W -f '${db:Status-Status}' "$1" 2>/dev/null)" = installed ]; }
version_of() { dpkg-query -W -f '${Version}' "$1" 2>/dev/null || true; }
candidate_of() { apt-cache policy "$1" 2>/dev/null | sed -n 's/^ *Candidate: //p'; }
# Debian's suite of newer packages, added where apt does not know it yet; its name is left in `backports`.
add_backports() {
  . /etc/os-release
  backports="${VERSION_CODENAME}-backports"
  if apt-get indextargets --format '$(CODENAME) $(SUITE)' 'Created-By: Packages' | grep -qwF "$backports"; then return; fi
  local mirror keyring signed=""
  mirror=$(apt-get indextargets --format '$(REPO_URI)' 'Created-By: Packages' "Codename: $VERSION_CODENAME" | head -n 1)
  if [ -z "$mirror" ]; then
    say "cannot read the mirror of $VERSION_CODENAME from apt's configuration; add the suite $backports by hand and run $0 again"
    exit 1
  fi
  keyring=/usr/share/keyrings/debian-archive-keyring.gpg
  [ -f "$keyring" ] && signed="[signed-by=$keyring] "
  say "adding the suite $backports"
  echo "deb $signed$mirror $backports main" >/etc/apt/sources.list.d/vantage-backports.list
  apt-get update -qq
}

if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then
  say "this script installs packages with apt, which this system lacks."
  say "Install a C++20 compiler, CMake 3.25, Ninja, glslang and the -dev packages listed in $0, then: cmake --preset release"
  exit 1
fi

wanted=()
[ "$mode" = ifc ] || [ "$mode" = laz ] || wanted+=("${packages[@]}")
# Whoever has these from elsewhere keeps those.
if [ "$mode" != program ]; then
  command -v node >/dev/null || wanted+=(nodejs)
  command -v npm >/dev/null || wanted+=(npm)
fi
if [ "$mode" = tests ]; then
  wanted+=("${test_packages[@]}")
  command -v chromium >/dev/null || wanted+=(chromium)
fi
[ "$mode" != packages ] || wanted+=("${packaging_packages[@]}")
missing=()
for package in "${wanted[@]}"; do installed "$package" || missing+=("$package"); done

builder=python3-scikit-build-core # of the Python module; Debian 12 has it in backports
builder_needed=no
if { [ "$mode" = tests ] || [ "$mode" = packages ]; } && ! installed "$builder"; then builder_needed=yes; fi
mesa=$(version_of mesa-vulkan-drivers)
mesa_needed=no
if [ "$mode" = ifc ] || [ "$mode" = laz ]; then
  mesa_needed=no
elif ! installed mesa-vulkan-drivers || dpkg --compare-versions "$mesa" lt "$mesa_minimum"; then mesa_needed=yes; fi

if [ ${#missing[@]} -gt 0 ] || [ "$builder_needed" = yes ] || [ "$mesa_needed" = yes ]; then
  if [ "$(id -u)" -ne 0 ]; then
    say "root is needed to install what is missing:"
    [ ${#missing[@]} -eq 0 ] || say "  packages: ${missing[*]}"
    [ "$builder_needed" = no ] || say "  $builder; Debian 12 has it in backports"
    [ "$mesa_needed" = no ] || say "  mesa-vulkan-drivers >= $mesa_minimum (here: ${mesa:-none}); Debian 12 has it in backports"
    say "Run this script once as root (sudo $0), then again as yourself."
    exit 1
  fi
  export DEBIAN_FRONTEND=noninteractive
  say "updating the package lists"
  apt-get update -qq
  if [ ${#missing[@]} -gt 0 ]; then
    say "installing ${missing[*]}"
    apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null
  fi
  if [ "$builder_needed" = yes ]; then
    say "installing $builder"
    target=()
    if ! apt-get install -s -qq --no-install-recommends "$builder" >/dev/null 2>&1; then
      add_backports
      target=(-t "$backports")
    fi
    apt-get install -y -qq --no-install-recommends "${target[@]}" "$builder" >/dev/null
  fi
  if [ "$mesa_needed" = yes ]; then
    target=()
    candidate=$(candidate_of mesa-vulkan-drivers)
    if dpkg --compare-versions "${candidate:-0}" lt "$mesa_minimum"; then
      add_backports
      target=(-t "$backports")
    fi
    say "installing mesa-vulkan-drivers >= $mesa_minimum"
    apt-get install -y -qq --no-install-recommends "${target[@]}" mesa-vulkan-drivers >/dev/null
    mesa=$(version_of mesa-vulkan-drivers)
    if dpkg --compare-versions "$mesa" lt "$mesa_minimum"; then
      say "mesa-vulkan-drivers is $mesa, but $mesa_minimum is needed for ray queries in software"
      exit 1
    fi
  fi
fi

# npm_ci FOLDER WHAT: what the folder's lock file lists, unless it is there.
npm_ci() {
  if ! [ "$1/node_modules/.package-lock.json" -nt "$1/package-lock.json" ]; then
    say "installing $2 (npm ci in $1)"
    (cd "$1" && npm ci --silent)
  fi
}

several=(-DCMAKE_UNITY_BUILD=ON -DCMAKE_UNITY_BUILD_BATCH_SIZE=12) # sources at a time: a third of the time
case "$mode" in
  program)
    cmake --preset release "${several[@]}" -DVANTAGE_BUILD_TESTS=OFF -DVANTAGE_BUILD_EXAMPLES=OFF >/dev/null
    cmake --build --preset release
    ;;
  tests)
    cmake --preset release "${several[@]}" -DVANTAGE_BUILD_TESTS=ON -DVANTAGE_BUILD_EXAMPLES=ON >/dev/null
    cmake --build --preset release
    npm_ci tests/clients "the programs that read back what vantage writes"
    npm_ci src/import/ifc "the reader of IFC"
    npm_ci src/import/laz "the reader of LAZ"
    ;;
  ifc) npm_ci src/import/ifc "the reader of IFC" ;;
  laz) npm_ci src/import/laz "the reader of LAZ" ;;
esac
