#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# assimp 5.2.5 (Debian 12), OBJ: an object that is opened again by its name (floor, roof, floor) has the faces behind
# either line; a program writes so that sorts faces by materials. Do its meshes?
# Guess before it was run: either two meshes "floor", or one with both faces.
# Seen: neither. The faces behind the second line go to the object that was open before it: "roof" has two faces and
# "floor" one, without a word.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
apt-get download -qq assimp-utils=5.2.5~ds0-1+b1 libassimp5=5.2.5~ds0-1+b1 libdraco7 libminizip1 >/dev/null
for package in *.deb; do dpkg-deb -x "$package" .; done
export LD_LIBRARY_PATH
LD_LIBRARY_PATH=$(dirname "$(find "$PWD" -name 'libassimp.so.5' | head -1)")
cat >site.obj <<'MODEL'
v 0 0 0
v 1 0 0
v 1 0 1
v 0 0 1
v 0 2 0
v 1 2 0
v 1 2 1
o floor
f 1 3 2
o roof
f 5 7 6
o floor
f 1 4 3
MODEL
echo "assimp 5.2.5~ds0-1+b1: meshes [vertices / bones / faces | types]"
meshes=$(usr/bin/assimp info site.obj | grep -E '^ +[0-9]+ \((floor|roof)\)')
echo "$meshes"
[ "$(wc -l <<<"$meshes")" = 2 ] && grep -q '(floor): \[3 / 0 / 1 ' <<<"$meshes" && grep -q '(roof): \[6 / 0 / 2 ' <<<"$meshes"
