#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Open3D 0.16.1 and CloudCompare 2.11.3 (Debian 12), which surveyors convert point clouds with: does PLY as text keep
# the millimetres of points at national coordinates?
# Guess before it was run: a property of type double has the digits of its points.
# Seen: six digits, so that 5400000.025 is 5.4e+06. Binary PLY keeps all of them.
# What vantage does: it tells that the coordinates have too few digits for surfaces, and to how much they are told.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
# With all that they need, as if nothing were installed.
mkdir -p debs/partial
touch status
apt-get -qq -y -o Dir::State::status="$PWD/status" -o Dir::Cache::archives="$PWD/debs" -o Debug::NoLocking=1 -o APT::Sandbox::User=root \
  --no-install-recommends --download-only install cloudcompare=2.11.3-7.1 python3-open3d=0.16.1+ds-2+b4 >/dev/null
for package in debs/*.deb; do dpkg-deb -x "$package" .; done
libraries=$(find "$PWD/usr/lib" "$PWD/lib" -name '*.so*' -printf '%h\n' | sort -u | paste -sd:)
export QT_QPA_PLATFORM=offscreen QT_QPA_PLATFORM_PLUGIN_PATH="$PWD/usr/lib/x86_64-linux-gnu/qt5/plugins/platforms"
printf '500000.025 5400000.025 300.000\n500001.025 5400001.025 301.000\n' >given.xyz
LD_LIBRARY_PATH="$libraries" PYTHONHOME="$PWD/usr" PYTHONPATH="$PWD/usr/lib/python3/dist-packages" usr/bin/python3.11 -c 'import open3d
print("Open3D", open3d.__version__)
open3d.io.write_point_cloud("open3d.ply", open3d.io.read_point_cloud("given.xyz"), write_ascii=True)'
LD_LIBRARY_PATH="$libraries" usr/bin/CloudCompare -SILENT -NO_TIMESTAMP -AUTO_SAVE OFF -C_EXPORT_FMT PLY -PLY_EXPORT_FMT ASCII \
  -O -GLOBAL_SHIFT AUTO given.xyz -SAVE_CLOUDS >/dev/null 2>&1
for file in open3d.ply given.ply; do
  grep -a -E '^comment Created by|^property double x' "$file"
  sed '1,/end_header/d' "$file"
  sed '1,/end_header/d' "$file" | grep -q '5\.4e+06'
done
