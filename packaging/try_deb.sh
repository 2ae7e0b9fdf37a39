#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# packaging/try_deb.sh [FOLDER [program]]
# Installs the packages of FOLDER, or build/packages, where nothing else is: in a root of its own, made from this machine's mirror of Debian.
# There the program plans, the module plans, and a program of somebody else's is built with the library, by CMake and by pkg-config; `program`
# tries the first alone. Needs root, a mirror, and mmdebstrap or debootstrap.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
folder=${1:-build/packages}
wanted=(vantage libvantage-dev python3-vantage)
[ "${2-}" != program ] || wanted=(vantage)
me=try_deb
. packaging/root.sh
for package in "${wanted[@]}"; do
  ls "$folder/${package}"_*.deb >/dev/null || { say "there is no package $package in $folder: run packaging/deb.sh"; exit 1; }
done
make_root
cp "$folder"/*.deb data/industrial_20k.glb packaging/install_debs.sh tests/consumer/consumer.cpp "$root/tmp"
install() { inside sh -ec 'cd /tmp && apt-get install -qq -o Dpkg::Use-Pty=0 --no-install-recommends "$@" >/dev/null' sh "$@"; }
have() { # FILE...: each is there in the root, and not empty
  local file
  for file in "$@"; do
    [ -s "$root/$file" ] || { say "there is no /$file"; exit 1; }
  done
}
names() { (cd "$folder" && printf './%s\n' "$1"_*.deb); }

say "the program alone"
install "$(names vantage)"
inside vantage info
inside vantage plan /tmp/industrial_20k.glb --stations 4 --problem coverage-overlap-fix --population 8 --iterations 3 --step 1 --user-size 0.2 \
  --spacing 0.1 -o /tmp/plan
have tmp/plan/{stations.csv,front.json,report.html,report.pdf}
have usr/share/man/man1/vantage{,-plan}.1.gz usr/share/zsh/vendor-completions/_vantage
have usr/share/vantage/schemas/{config,front,stations,targets,rooms,missed,next}.schema.json
inside bash -ec '. /usr/share/bash-completion/completions/vantage
  COMP_WORDS=(vantage plan --cheap) COMP_CWORD=2
  complete -p vantage >/dev/null'
if [ ${#wanted[@]} = 1 ]; then
  say "installed, planned"
  exit 0
fi

say "the steps of the container: program, module, Vulkan"
inside /tmp/install_debs.sh /tmp
inside sh -ec 'vantage info --json >/tmp/info.json'
inside python3 -c '
import json
with open("/tmp/info.json") as file:
    assert any(e["usable"] and "llvmpipe" in e["device"] for e in json.load(file)["engines"]), "no engine takes Vulkan in software"
import vantage
site = vantage.Site.open("/tmp/industrial_20k.glb", engine="embree", step=1, user_size=0.2, spacing=0.1)
plan = site.plan(problem="coverage-overlap-fix", stations=4, population=8, iterations=3)
plan.write("/tmp/from_python")
print("vantage", vantage.__version__, plan.summary.splitlines()[0])'
have tmp/from_python/{stations.csv,front.json}

say "the library"
inside apt-get update -qq
install "$(names libvantage-dev)" g++ cmake make
cat >"$root/tmp/CMakeLists.txt" <<'CMAKE'
cmake_minimum_required(VERSION 3.25)
project(somebody LANGUAGES CXX)
find_package(vantage 1.0 REQUIRED)
add_executable(by_cmake consumer.cpp)
target_link_libraries(by_cmake PRIVATE vantage::vantage)
CMAKE
inside sh -ec 'cd /tmp && cmake -S . -B built >/dev/null && cmake --build built >/dev/null && built/by_cmake'
inside sh -ec 'cd /tmp && g++ -std=c++20 consumer.cpp -o by_pkg_config $(pkg-config --cflags --libs --static vantage) && ./by_pkg_config'

inside sh -ec 'apt-get purge -qq -o Dpkg::Use-Pty=0 vantage >/dev/null && ! command -v vantage'
say "installed, planned, linked, removed"
