#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Open3D 0.16.1 (Debian 12) and binary PCD whose coordinates are of type double, as clouds in a national system need.
# Guess before it was run: they are read; a point cloud of Open3D has doubles.
# Seen: every point is at 0, 0, 0, without a word. The same point in a PCD as text is where it belongs.
# What vantage does: SIZE and TYPE of every field hold, in text and binary.
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
LD_LIBRARY_PATH="$libraries" PYTHONHOME="$PWD/usr" PYTHONPATH="$PWD/usr/lib/python3/dist-packages" usr/bin/python3.11 - <<'PY'
import struct
import sys
import open3d
HEADER = """# .PCD v0.7 - Point Cloud Data file format
VERSION 0.7
FIELDS x y z
SIZE 8 8 8
TYPE F F F
COUNT 1 1 1
WIDTH 1
HEIGHT 1
VIEWPOINT 0 0 0 1 0 0 0
POINTS 1
DATA %s
"""
point = (500000.025, 5400000.025, 300.0)
with open("binary.pcd", "wb") as file:
    file.write((HEADER % "binary").encode() + struct.pack("<3d", *point))
with open("text.pcd", "w") as file:
    file.write(HEADER % "ascii" + "%.3f %.3f %.3f\n" % point)
binary, text = (tuple(map(float, open3d.io.read_point_cloud(name).points[0])) for name in ("binary.pcd", "text.pcd"))
print("Open3D", open3d.__version__, "reads", point, "as", binary, "in binary and as", text, "in text")
sys.exit(not (binary == (0, 0, 0) and text == point))
PY
