#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Open3D and CloudCompare, which surveyors convert point clouds with, write PLY as text (Debian: python3-open3d, cloudcompare).
#
# Expected: a property of type double has the digits of the points, which are at national coordinates, to the millimetre.
#
# Seen with Open3D 0.16.1 and CloudCompare 2.11.3: six digits, so that 5400000.025 is 5.4e+06. Binary PLY keeps all of them.
# What vantage does: it tells that the coordinates have too few digits for surfaces, and to how much they are told.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export QT_QPA_PLATFORM=offscreen
printf '500000.025 5400000.025 300.000\n500001.025 5400001.025 301.000\n' >given.xyz
/usr/bin/python3 -c 'import open3d
print("Open3D", open3d.__version__)
open3d.io.write_point_cloud("open3d.ply", open3d.io.read_point_cloud("given.xyz"), write_ascii=True)'
CloudCompare -SILENT -NO_TIMESTAMP -AUTO_SAVE OFF -C_EXPORT_FMT PLY -PLY_EXPORT_FMT ASCII -O -GLOBAL_SHIFT AUTO given.xyz -SAVE_CLOUDS >/dev/null 2>&1
same=0
for file in open3d.ply given.ply; do
  grep -a -E '^comment Created by|^property double x' "$file"
  sed '1,/end_header/d' "$file"
  sed '1,/end_header/d' "$file" | grep -q '5\.4e+06' || same=1
done
exit $same
