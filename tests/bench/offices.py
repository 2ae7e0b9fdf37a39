#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes a large site: rows of buildings whose floors are all the built-in office, on a lawn.

    vantage generate office -o office.glb
    python3 tests/bench/offices.py office.glb offices.glb --across 6 --deep 6
    python3 tests/bench/offices.py office.glb storeys.glb --across 6 --deep 6 --storeys 5

Each floor is a node whose children share the office's meshes, so the file stays small. Storeys are linked by stairs
outside the entrances: two flights of eleven rises of 17.3 cm each, with landings. The same arguments give the same
bytes. Node names end in the building's column, its row and the storey.
"""

import argparse
import json
import struct

STOREY = 3.8  # m, from floor to floor: the office with its parapet
EAST = 24.0  # m, outer face of the wall with the entrance, which spans y from 7 to 8 m
RISES, GOING, WIDTH = 22, 0.27, 1.3  # of a storey's stairs, both flights together; m
LAWN, MARGIN = -0.1, 5.0  # m, height, and extent beyond the buildings


def box(x0, x1, y0, y1, z0, z1):
    return (x0, x1, y0, y1, z0, z1)


def landing():
    """The landing at an entrance, with guards on both sides."""
    x0, x1 = EAST, EAST + 1.6
    guards = [box(x0, x1, y, y + 0.05, 0, 1.0) for y in (6.0, 8.95)]
    return [box(x0, x1, 6.0, 9.0, -0.12, 0)] + guards


def stairs():
    """Both flights up from a landing, and the landing between them."""
    rise, half = STOREY / RISES, RISES // 2
    west = EAST + 1.6
    east = west + (half - 1) * GOING
    boxes = []
    for k in range(1, half):
        top = k * rise
        boxes.append(box(west + (k - 1) * GOING, west + k * GOING, 7.6, 7.6 + WIDTH, top - 0.25, top))
        top += half * rise
        boxes.append(box(east - k * GOING, east - (k - 1) * GOING, 6.1, 6.1 + WIDTH, top - 0.25, top))
    level, end = half * rise, east + 1.5
    boxes.append(box(east, end, 6.1, 8.9, level - 0.12, level))
    boxes += [box(east, end, y, y + 0.05, level, level + 1.0) for y in (6.1, 8.85)]
    boxes.append(box(end - 0.05, end, 6.15, 8.85, level, level + 1.0))
    return boxes


class Model:
    """A GLB file to which meshes and nodes are added; glTF's y is up."""

    def __init__(self, path):
        data = open(path, "rb").read()
        length = struct.unpack("<I", data[12:16])[0]
        self.json = json.loads(data[20 : 20 + length])
        rest = data[20 + length :]
        self.bytes = bytearray(rest[8 : 8 + struct.unpack("<I", rest[:4])[0]])

    def view(self, content):
        self.bytes += b"\0" * (-len(self.bytes) % 4)
        self.json["bufferViews"].append({"buffer": 0, "byteOffset": len(self.bytes), "byteLength": len(content)})
        self.bytes += content
        return len(self.json["bufferViews"]) - 1

    def mesh(self, boxes):
        """Returns the number of a new mesh of boxes; one without height is its upper side."""
        points, corners = [], []
        for x0, x1, y0, y1, z0, z1 in boxes:
            first = len(points)
            flat = z0 == z1
            points += [(x, z, -y) for z in ((z1,) if flat else (z0, z1)) for y in (y0, y1) for x in (x0, x1)]
            sides = ((0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5))
            for a, b, c, d in ((0, 1, 3, 2),) if flat else sides:
                corners += [first + k for k in (a, b, c, a, c, d)]
        accessors = self.json["accessors"]
        accessors.append({
            "bufferView": self.view(b"".join(struct.pack("<3f", *p) for p in points)),
            "componentType": 5126, "count": len(points), "type": "VEC3",
            "min": [min(p[k] for p in points) for k in range(3)],
            "max": [max(p[k] for p in points) for k in range(3)],
        })
        accessors.append({
            "bufferView": self.view(struct.pack(f"<{len(corners)}H", *corners)),
            "componentType": 5123, "count": len(corners), "type": "SCALAR",
        })
        attributes = {"POSITION": len(accessors) - 2}
        primitive = {"attributes": attributes, "indices": len(accessors) - 1, "material": 0}
        self.json["meshes"].append({"primitives": [primitive]})
        return len(self.json["meshes"]) - 1

    def write(self, path):
        self.bytes += b"\0" * (-len(self.bytes) % 4)
        self.json["buffers"][0]["byteLength"] = len(self.bytes)
        text = json.dumps(self.json, separators=(",", ":")).encode()
        text += b" " * (-len(text) % 4)
        with open(path, "wb") as file:
            file.write(b"glTF" + struct.pack("<II", 2, 28 + len(text) + len(self.bytes)))
            file.write(struct.pack("<I4s", len(text), b"JSON") + text)
            file.write(struct.pack("<I4s", len(self.bytes), b"BIN\0") + self.bytes)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("office", help="the floor, as `vantage generate office` writes it")
    parser.add_argument("output")
    parser.add_argument("--across", type=int, default=6, help="buildings from west to east")
    parser.add_argument("--deep", type=int, default=6, help="buildings from south to north")
    parser.add_argument("--storeys", type=int, default=1)
    asked = parser.parse_args()

    model = Model(asked.office)
    floor = model.json["nodes"]
    pitch_x, pitch_y = (28.0 if asked.storeys == 1 else 35.0), 19.0
    shared = {}
    if asked.storeys > 1:
        shared = {"landing": model.mesh(landing()), "stairs": model.mesh(stairs())}
    nodes, roots = [], []
    for z in range(asked.storeys):
        for y in range(asked.deep):
            for x in range(asked.across):
                place = f"_{x}_{y}_{z}"
                parts = [dict(part, name=part["name"] + place) for part in floor
                         if part["name"] != "roof_unit" or z + 1 == asked.storeys]
                for name, mesh in shared.items():
                    if name == "landing" or z + 1 < asked.storeys:
                        parts.append({"mesh": mesh, "name": name + place})
                first = len(nodes)
                nodes += parts
                nodes.append({"name": "floor" + place, "translation": [x * pitch_x, z * STOREY, -y * pitch_y],
                              "children": list(range(first, first + len(parts)))})
                roots.append(len(nodes) - 1)
    x1 = (asked.across - 1) * pitch_x + (30 if asked.storeys == 1 else 35)
    y1 = (asked.deep - 1) * pitch_y + 20
    nodes.append({"name": "ground", "mesh": model.mesh([box(-MARGIN, x1, -MARGIN, y1, LAWN, LAWN)])})
    roots.append(len(nodes) - 1)
    model.json["nodes"] = nodes
    model.json["scenes"], model.json["scene"] = [{"nodes": roots}], 0
    model.write(asked.output)


if __name__ == "__main__":
    main()
