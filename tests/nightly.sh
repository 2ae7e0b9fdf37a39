#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# tests/nightly.sh [part...]
# What takes too long for `ctest --preset release` and `.ci/run`, after `./setup.sh --tests`; without arguments, all parts, one after the other:
#
#   sites      conformance and stress on every engine, with every case of the suite's own; plans of a street and a plant; more random sites, 200 of them walked; random drawings and clouds;
#              the sweep of docs/evidence/sweep.md
#   faults     every n of the faults of device, disk and process, and every number for every option
#   address, thread
#              every suite under these sanitizers (tests/sanitizers/check.sh)
#   machine    all tests under each instruction set of Embree and each width of lavapipe's vectors
#   packages   builds the Debian packages, has lintian look at them, and installs them, the container's steps and the wheel where nothing else is
#              (needs root, a mirror, lintian and mmdebstrap)
#   docs       the site of docs with the reference (needs mkdocs, mkdocs-material and doxygen), and the commands of docs that take long
#   readers    point clouds in PLY as the Point Cloud Library, CloudCompare and Open3D read them (needs pcl-tools, cloudcompare and python3-open3d);
#              PLY, GLB and the system of LAS as three.js and proj4 do
#   writers    models as gltf-transform, gltfpack, gltf-pipeline, obj2gltf and three.js write them; floor plans as GDAL (needs gdal-bin), dxf-writer and
#              @tarikjabiri/dxf do; point clouds as CloudCompare, the Point Cloud Library, Open3D (needs the same packages), three.js and web-e57 do;
#              200 random files of meshes
#   fuzz       ten minutes of libFuzzer a reader; needs clang
#   mutation   200 lines broken at random, and which of them no test notices: build/mutation/found/found.md
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
tests=build/release/tests
export VANTAGE_VALIDATION=1

# run COMMAND...: which must succeed, and the validation layer must be silent.
run() {
  echo "nightly: $*"
  "$@" 2>&1 | tee build/nightly.log
  ! grep -q "validation layer reports" build/nightly.log
}

sites() {
  run "$tests/conformance/conformance_test" --gtest_brief=1
  VANTAGE_WHOLE_SITES=1 run "$tests/stress/stress_test" --gtest_brief=1
  VANTAGE_WHOLE_SITES=1 run "$tests/sites/sites_test" --gtest_brief=1 --gtest_filter='*Plans*'
  VANTAGE_SEEDS=1..200 run "$tests/sites/sites_test" --gtest_brief=1 --gtest_filter='RandomSites.*'
  VANTAGE_SEEDS=1..400 run "$tests/unit/import/import_test" --gtest_brief=1 --gtest_filter='FloorPlanRandomTest.*'
  VANTAGE_SEEDS=1..200 run node --test tests/unit/import/ifc/random_test.mjs
  VANTAGE_SEEDS=1..200 run "$tests/unit/import/cloud/cloud_test" --gtest_brief=1 --gtest_filter='RandomClouds.*'
  run build/release/vantage-bench sweep office house street plant 1..40 -o build/sweep --by-hand tests/sites/by_hand --step 0.4 --user-size 0.3 --spacing 0.1
  VANTAGE_SEEDS=5..20 run "$tests/conformance/conformance_test" --gtest_brief=1 --gtest_filter='*RandomSites*'
}

faults() {
  for engine in ray_query compute_bvh; do run "$tests/faults/vantage-device-faults" $engine; done
  VANTAGE_FAULTS=1000 run "$tests/disk/program_faults_test" --gtest_brief=1
  VANTAGE_NUMBERS=all run "$tests/unit/cli/cli_numbers_test" --gtest_brief=1
}

address() { tests/sanitizers/check.sh address; }
thread() { tests/sanitizers/check.sh thread; }
machine() { tests/machine/every_machine.sh build/release; }
packages() {
  for program in lintian mmdebstrap; do
    command -v $program >/dev/null || { echo "nightly: $program is not installed"; return 1; }
  done
  packaging/deb.sh
  run lintian --fail-on error build/packages/*.deb
  packaging/wheel.sh
  local tried
  for package in deb wheel; do
    tried=0
    packaging/try_$package.sh || tried=$?
    [ $tried = 0 ] || [ $tried = 77 ] || return 1 # 77: it has said what is missing
  done
}
docs() {
  command -v mkdocs >/dev/null || { echo "nightly: mkdocs is not installed"; return 1; }
  run mkdocs build
  run tests/docs/check_commands.py build/release . --night
}
cloud_programs() {
  local program
  for program in pcl_ply2pcd:pcl-tools CloudCompare:cloudcompare; do
    command -v ${program%:*} >/dev/null || { echo "nightly: ${program%:*} is not installed (Debian: ${program#*:})"; return 1; }
  done
  /usr/bin/python3 -c 'import open3d' || { echo "nightly: Open3D is not installed (Debian: python3-open3d)"; return 1; }
}
readers() {
  cloud_programs || return 1
  run node tests/clients/pcl.mjs "$PWD/build/release/vantage"
  run node tests/clients/cloudcompare.mjs "$PWD/build/release/vantage"
  npm ci --prefix tests/writers >/dev/null
  run node --no-warnings tests/writers/readers.mjs "$PWD/build/release/vantage"
}
writers() {
  cloud_programs || return 1
  npm ci --prefix tests/writers >/dev/null
  run node --no-warnings tests/writers/meshes.mjs "$PWD/build/release/vantage"
  run node tests/writers/plans.mjs "$PWD/build/release/vantage"
  run node --experimental-wasm-modules --no-warnings tests/writers/clouds.mjs "$PWD/build/release/vantage"
  VANTAGE_SEEDS=1..200 run "$tests/unit/import/import_test" --gtest_brief=1 --gtest_filter='RandomMeshTest.*'
}
fuzz() { cmake --preset fuzz >/dev/null && cmake --build --preset fuzz && tests/fuzz/run.sh 600; }
mutation() {
  cmake -G Ninja -S . -B build/mutation -DCMAKE_BUILD_TYPE=Release -DBUILD_SHARED_LIBS=ON -DCMAKE_LINK_DEPENDS_NO_SHARED=ON \
    -DCMAKE_CXX_FLAGS=-D_GLIBCXX_ASSERTIONS >/dev/null
  ninja -C build/mutation
  tests/mutation/mutate.py build/mutation --lines 200 -o build/mutation/found
}

parts=("$@")
[ $# -gt 0 ] || parts=(sites faults address thread machine packages docs readers writers fuzz mutation)
for part in "${parts[@]}"; do
  case $part in
    sites | faults | address | thread | machine | packages | docs | readers | writers | fuzz | mutation) "$part" ;;
    *) sed -n '3,/^set /p' "$0" | sed '$d' >&2; exit 2 ;;
  esac
done
