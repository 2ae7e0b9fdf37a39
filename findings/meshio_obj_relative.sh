#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# python3-meshio 7.0.0-3 (Debian 12; it calls itself 5.0.0) and OBJ faces that count back from the last vertex, as some exporters of CAD write them.
# Guess before it was run: -1 is the last vertex.
# Seen: -1 becomes -2, an index that numpy takes for the last but one: each corner is the vertex before. A triangle of 8 m2
# becomes one of 10 m2 that no face has, without a word.
# What vantage does: relative indices count back from the line they stand in.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
# With all that it needs, as if nothing were installed.
mkdir -p debs/partial
touch status
apt-get -qq -y -o Dir::State::status="$PWD/status" -o Dir::Cache::archives="$PWD/debs" -o Debug::NoLocking=1 -o APT::Sandbox::User=root \
  --no-install-recommends --download-only install python3-meshio=7.0.0-3 python3-numpy >/dev/null
for package in debs/*.deb; do dpkg-deb -x "$package" .; done
libraries=$(find "$PWD/usr/lib" "$PWD/lib" -name '*.so*' -printf '%h\n' | sort -u | paste -sd:)
printf 'v 0 5 0\nv 20 0 0\nv 24 0 0\nv 20 4 0\nf -3 -2 -1\n' >relative.obj
printf 'v 0 5 0\nv 20 0 0\nv 24 0 0\nv 20 4 0\nf 2 3 4\n' >absolute.obj
LD_LIBRARY_PATH="$libraries" PYTHONHOME="$PWD/usr" PYTHONPATH="$PWD/usr/lib/python3/dist-packages" usr/bin/python3.11 - <<'PY'
import meshio, numpy, sys
def seen(name):
    mesh = meshio.read(name)
    corners = mesh.points[mesh.cells[0].data[0]]
    return corners.tolist(), 0.5 * float(numpy.linalg.norm(numpy.cross(corners[1] - corners[0], corners[2] - corners[0])))
print("meshio", meshio.__version__)
for name in ("absolute.obj", "relative.obj"):
    print(name, "corners %s, %g m2" % seen(name))
sys.exit(seen("absolute.obj") == seen("relative.obj"))
PY
