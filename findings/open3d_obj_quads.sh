#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Open3D 0.16.1 (Debian 12): an OBJ file with a square and a triangle, read by `read_triangle_mesh` and, as a model with
# materials, by `read_triangle_model`.
# Guess before it was run: both make three triangles of it.
# Seen: `read_triangle_mesh` returns an empty mesh; one face that is no triangle takes the rest with it, and a line of the
# level "info" tells that it was skipped. `read_triangle_model` has all three.
# What vantage does: polygons of any number of corners are cut into triangles.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
# With all that it needs, as if nothing were installed.
mkdir -p debs/partial
touch status
apt-get -qq -y -o Dir::State::status="$PWD/status" -o Dir::Cache::archives="$PWD/debs" -o Debug::NoLocking=1 -o APT::Sandbox::User=root \
  --no-install-recommends --download-only install python3-open3d=0.16.1+ds-2+b4 >/dev/null
for package in debs/*.deb; do dpkg-deb -x "$package" .; done
libraries=$(find "$PWD/usr/lib" "$PWD/lib" -name '*.so*' -printf '%h\n' | sort -u | paste -sd:)
printf 'v 0 0 0\nv 4 0 0\nv 4 3 0\nv 0 3 0\nv 9 9 9\nv 10 9 9\nv 9 10 9\nf 1 2 3 4\nf 5 6 7\n' >faces.obj
LD_LIBRARY_PATH="$libraries" PYTHONHOME="$PWD/usr" PYTHONPATH="$PWD/usr/lib/python3/dist-packages" usr/bin/python3.11 - <<'PY'
import sys
import open3d
mesh = open3d.io.read_triangle_mesh("faces.obj")
model = open3d.io.read_triangle_model("faces.obj")
triangles = len(mesh.triangles), sum(len(part.mesh.triangles) for part in model.meshes)
print("Open3D", open3d.__version__, "has %d triangles of the mesh and %d of the model; 3 are there" % triangles)
sys.exit(triangles != (0, 3))
PY
