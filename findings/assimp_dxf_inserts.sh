#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# assimp 5.2.5 (Debian 12), DXF: does an INSERT place the faces of its block where the DXF reference says: turned by
# group 50, as often as groups 70 and 71 say, also from within another block?
# Guess before it was run: it turns them; perhaps it does not repeat them.
# Seen: a triangle from 0 to 2 along x that is turned by 90 degrees still lies along x; of a row of three one is read;
# of a block within a block nothing is, which is told as a file without 3d data.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
apt-get download -qq assimp-utils=5.2.5~ds0-1+b1 libassimp5=5.2.5~ds0-1+b1 libdraco7 libminizip1 >/dev/null
for package in *.deb; do dpkg-deb -x "$package" .; done
export LD_LIBRARY_PATH
LD_LIBRARY_PATH=$(dirname "$(find "$PWD" -name 'libassimp.so.5' | head -1)")
face='0 3DFACE 8 0 10 0 20 0 30 0 11 2 21 0 31 0 12 0 22 0 32 3 13 0 23 0 33 3'
block() { echo "0 BLOCK 8 0 2 $1 70 0 10 0 20 0 30 0 3 $1 $2 0 ENDBLK 8 0"; }
insert() { echo "0 INSERT 8 0 2 $1 10 0 20 0 30 0 $2"; }
# A drawing of blocks b, the face, and c, which places b; `$2` is what it places.
drawing() {
  echo "0 SECTION 2 BLOCKS $(block b "$face") $(block c "$(insert b '')") 0 ENDSEC 0 SECTION 2 ENTITIES $2 0 ENDSEC 0 EOF" |
    tr -s ' ' '\n' >"$1.dxf"
}
# assimp turns the model so that y points up: y of the drawing is -z.
info() { usr/bin/assimp info "$1.dxf" 2>&1 || true; }
drawing turned "$(insert b '50 90')"
drawing row "$(insert b '70 3 71 1 44 5 45 5')"
drawing nested "$(insert c '')"
echo "assimp 5.2.5~ds0-1+b1"
turned=$(info turned | sed -n 's/^Maximum point *(\(.*\))$/\1/p')
row=$(info row | sed -n 's/^Faces: *\([0-9]*\)$/\1/p')
nested=$(info nested | grep -ci 'no 3d data' || true)
echo "turned: maximum ${turned:-unknown}, and should be 0 along x; row: ${row:-no} faces of 3; nested: $([ "$nested" = 0 ] && echo read || echo none)"
[[ $turned == 2.0* ]] && [ "$row" -le 2 ] && [ "$nested" != 0 ]
