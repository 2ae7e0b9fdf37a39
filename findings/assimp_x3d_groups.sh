#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# assimp 5.2.5 (Debian 12), X3D: does a shape that a Collision or an Anchor node groups become a mesh, as in a Group
# (ISO/IEC 19775-1: both are grouping nodes)?
# Guess before it was run: yes; an unknown node is at least told.
# Seen: the shape below Group is read, and those below Collision and Anchor are gone, without a word and with success.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
apt-get download -qq assimp-utils=5.2.5~ds0-1+b1 libassimp5=5.2.5~ds0-1+b1 libdraco7 libminizip1 >/dev/null
for package in *.deb; do dpkg-deb -x "$package" .; done
export LD_LIBRARY_PATH
LD_LIBRARY_PATH=$(dirname "$(find "$PWD" -name 'libassimp.so.5' | head -1)")
shape() {
  echo "<Shape><IndexedFaceSet coordIndex=\"0 1 2 -1\"><Coordinate point=\"$1 0 0 $1 0 1 $1 1 0\"/></IndexedFaceSet></Shape>"
}
# A triangle in a Group, and another in a node of a kind.
meshes() {
  printf '<?xml version="1.0" encoding="UTF-8"?>\n<X3D profile="Immersive" version="3.3"><Scene><Group>%s</Group><%s>%s</%s></Scene></X3D>\n' \
    "$(shape 0)" "$1" "$(shape 5)" "$1" >"$1.x3d"
  usr/bin/assimp info "$1.x3d" 2>&1 | sed -n 's/^Meshes: *\([0-9][0-9]*\)$/\1/p'
}
echo "assimp 5.2.5~ds0-1+b1"
as_seen=true
for node in Group Collision Anchor; do
  count=$(meshes $node)
  echo "$node: ${count:-no} of 2 meshes"
  case $node in
    Group) [ "$count" = 2 ] || as_seen=false ;;
    *) [ "$count" = 1 ] || as_seen=false ;;
  esac
done
$as_seen
