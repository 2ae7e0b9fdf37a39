#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# PROJ writes a system with axes south and west as well-known text of version 1, and reads its own text back.
#
# Expected: the text tells the axes (AXIS["Southing",SOUTH]), or PROJ refuses to write it, as
# version 1 has words for both; a place transformed by the code and by the text comes out the same.
#
# Seen with PROJ 9.1.1: `projinfo -o WKT1:GDAL EPSG:5513` writes no AXIS at all and says nothing. Read back, the same text
# has axes east and north. 1144000 south, 544000 west is 17.33 E 49.40 N by the code, and a place some 2600 km away by the
# text, without a warning. The code at the text's end, AUTHORITY["EPSG","5513"], is not asked.
# What vantage does: src/core/coordinate_reference.cpp asks the registry for the axes of a text that names its code, and
# refuses axes other than east and north (tests/unit/formats/coordinate_system_test.cpp, HasTheAxesOfTheSurvey).
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
chmod 755 .
apt-get download -qq proj-bin=9.1.1-1+b1 libproj25=9.1.1-1+b1 proj-data=9.1.1-1 >/dev/null 2>&1
for package in *.deb; do dpkg -x "$package" .; done
export LD_LIBRARY_PATH="$folder/usr/lib/$(dpkg-architecture -qDEB_HOST_MULTIARCH)" PROJ_DATA="$folder/usr/share/proj" PROJ_NETWORK=OFF
PATH="$folder/usr/bin:$PATH"
projinfo 2>&1 | head -n 1 || true
text=$(projinfo -q -o WKT1:GDAL --single-line EPSG:5513)
echo "text: $text"
by_code=$(echo 1144000 544000 | cs2cs -f %.4f EPSG:5513 EPSG:4326)
by_text=$(echo 1144000 544000 | cs2cs -f %.4f "$text" EPSG:4326)
echo "by its code: $by_code"
echo "by its text: $by_text"
case "$text" in *AXIS*) echo "changed: the text tells its axes"; exit 1 ;; esac
case "$by_code" in 49.3*17.3*) ;; *) echo "changed: another place by the code"; exit 1 ;; esac
case "$by_text" in 49.3*17.3*) echo "changed: the text means the same place"; exit 1 ;; esac
echo "the text lost the axes of its system"
