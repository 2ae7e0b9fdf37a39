#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# assimp 5.2.5 (Debian 12), binary PLY: is a file read alike whatever the first byte of its data is?
# Guess before it was run: yes, the header's line end is the last that the reader skips.
# Seen: a first byte of 0x0A is taken for another line end. All coordinates then begin a byte late, and the file is
# refused or its numbers are nonsense; the same file with a first byte of 0x0B has its five triangles.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
apt-get download -qq assimp-utils=5.2.5~ds0-1+b1 libassimp5=5.2.5~ds0-1+b1 libdraco7 libminizip1 >/dev/null
for package in *.deb; do dpkg-deb -x "$package" .; done
export LD_LIBRARY_PATH
LD_LIBRARY_PATH=$(dirname "$(find "$PWD" -name 'libassimp.so.5' | head -1)")
# A fan of five triangles; the low byte of the first coordinate is given.
write() {
  python3 - "$1" "$2" <<'CODE'
import struct, sys
first = struct.unpack('<f', struct.pack('<I', 0x3F800000 | int(sys.argv[1], 16)))[0]
points = [(first, 0, 0)] + [(k, 2, 1) for k in range(6)]
faces = [(0, k, k + 1) for k in range(1, 6)]
with open(sys.argv[2], 'wb') as file:
    file.write(b'ply\nformat binary_little_endian 1.0\nelement vertex %d\nproperty float x\nproperty float y\nproperty '
               b'float z\nelement face %d\nproperty list uchar int vertex_indices\nend_header\n' % (len(points), len(faces)))
    for point in points:
        file.write(struct.pack('<3f', *point))
    for face in faces:
        file.write(struct.pack('<B3i', 3, *face))
CODE
}
write 0B other.ply
write 0A line_feed.ply
# Bounds of what assimp reads, or that it reads nothing.
bounds() { usr/bin/assimp info "$1" 2>&1 | grep -E 'Minimum point|Maximum point|Faces:|ERROR' || echo refused; }
echo "assimp 5.2.5~ds0-1+b1"
other=$(bounds other.ply) line_feed=$(bounds line_feed.ply)
echo "first byte 0x0B:" && echo "$other"
echo "first byte 0x0A:" && echo "$line_feed"
grep -qE 'Faces: +5' <<<"$other"
[ "$other" != "$line_feed" ] && ! { grep -qE 'Faces: +5' <<<"$line_feed" && grep -q '(5.000000 2.000000 1.000000)' <<<"$line_feed"; }
