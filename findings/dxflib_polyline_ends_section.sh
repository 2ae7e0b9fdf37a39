#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# dxflib (Debian 12: 3.26.4-1+b1) calls endSection() amid a section: for SECTION and ENTITIES, and after the head of a
# POLYLINE and each VERTEX.
#
# Guess, written down before the first run: a file of one section with a closed POLYLINE of three vertices calls
# endSection() once, at its ENDSEC, and endSequence() once, at its SEQEND.
# Seen: eight calls of endSection(), one behind addPolyline() and one behind each addVertex(). A reader that closes in
# endSection() what is open loses the vertices of each polyline.
set -euo pipefail
version=3.26.4-1+b1
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
chmod 755 "$folder"
cd "$folder"
apt-get download -qq "libdxflib3=$version" "libdxflib-dev=$version"
for package in *.deb; do dpkg -x "$package" packages; done
library=$(dirname "$(find packages -name 'libdxflib.so*' | head -1)")

cat >calls.cpp <<'CODE'
#include <dxflib/dl_creationadapter.h>
#include <dxflib/dl_dxf.h>

#include <cstdio>

struct Calls : DL_CreationAdapter {
  void addPolyline(const DL_PolylineData&) override { std::puts("addPolyline"); }
  void addVertex(const DL_VertexData& v) override { std::printf("addVertex %g %g\n", v.x, v.y); }
  void endSequence() override { std::puts("endSequence"); }
  void endSection() override { std::puts("endSection"); }
};

int main(int, char** argv) {
  Calls calls;
  DL_Dxf dxf;
  return dxf.in(argv[1], &calls) ? 0 : 1;
}
CODE
g++ -std=c++17 -Ipackages/usr/include calls.cpp -L"$library" -ldxflib -Wl,-rpath,"$folder/$library" -o calls

printf '%s\n' 0 SECTION 2 ENTITIES \
  0 POLYLINE 8 walls 66 1 70 1 10 0 20 0 30 0 \
  0 VERTEX 8 walls 10 0 20 0 30 0 0 VERTEX 8 walls 10 4 20 0 30 0 0 VERTEX 8 walls 10 4 20 3 30 0 \
  0 SEQEND 8 walls 0 ENDSEC 0 EOF >triangle.dxf
./calls triangle.dxf | tee seen
printf '%s\n' endSection endSection addPolyline endSection 'addVertex 0 0' endSection 'addVertex 4 0' endSection \
  'addVertex 4 3' endSection endSequence endSection endSection >known
diff known seen && echo "as found"
