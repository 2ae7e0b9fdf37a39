#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# dxflib (Debian 12: 3.26.4-1+b1) hands the seed point of a HATCH on as one more edge of its boundary.
#
# Guess, written down before the first run: a HATCH whose boundary is a polyline of four corners has one edge with
# four vertices, whether or not the file gives a seed point (group 98) behind it.
# Seen: with a seed point, the loop gets a second edge, whose one vertex is that point. Who joins the edges of a loop,
# as line edges want it, gets a spike to it. Seed points are valid and common: a hatch of a picked area has one.
set -euo pipefail
version=3.26.4-1+b1
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
chmod 755 "$folder"
cd "$folder"
apt-get download -qq "libdxflib3=$version" "libdxflib-dev=$version"
for package in *.deb; do dpkg -x "$package" packages; done
library=$(dirname "$(find packages -name 'libdxflib.so*' | head -1)")

cat >corners.cpp <<'CODE'
#include <dxflib/dl_creationadapter.h>
#include <dxflib/dl_dxf.h>

#include <cstdio>

struct Corners : DL_CreationAdapter {
  void addHatchEdge(const DL_HatchEdgeData& edge) override {
    for (const auto& v : edge.vertices) std::printf(" %g,%g", v[0], v[1]);
    std::puts("");
  }
};

int main(int, char** argv) {
  Corners corners;
  DL_Dxf dxf;
  return dxf.in(argv[1], &corners) ? 0 : 1;
}
CODE
g++ -std=c++17 -Ipackages/usr/include corners.cpp -L"$library" -ldxflib -Wl,-rpath,"$folder/$library" -o corners

hatch() {  # the groups of its seed points
  printf '%s\n' 0 SECTION 2 HEADER 9 '$ACADVER' 1 AC1015 0 ENDSEC 0 SECTION 2 ENTITIES \
    0 HATCH 100 AcDbEntity 8 walls 100 AcDbHatch 10 0 20 0 30 0 210 0 220 0 230 1 2 SOLID 70 1 71 0 91 1 92 3 72 0 73 1 \
    93 4 10 1 20 1 10 3 20 1 10 3 20 2 10 1 20 2 97 0 75 0 76 1 "$@" 0 ENDSEC 0 EOF
}
hatch 98 0 >none.dxf
hatch 98 1 10 9 20 7 >one.dxf
{
  echo without a seed point
  ./corners none.dxf
  echo with a seed point at 9,7
  ./corners one.dxf
} | tee seen
printf '%s\n' 'without a seed point' ' 1,1 3,1 3,2 1,2' 'with a seed point at 9,7' ' 1,1 3,1 3,2 1,2' ' 9,7' >known
diff known seen && echo "as found"
