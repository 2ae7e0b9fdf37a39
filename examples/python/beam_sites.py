#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Three sites that a beam meets otherwise than a thin ray on matt walls does: an office behind glass, a street under
leaves, a plant of polished steel and black insulation. They are the built-in models of `vantage generate` with other materials,
and trees with leaves from a texture. The same models give the same bytes.

    beam_sites.py FOLDER

reads office.glb, street.glb and plant.glb there, and writes glass.glb, leaves.glb and steel.glb. leaves-solid.glb is the
street whose leaves have no holes, as programs see it that do not look into textures.
"""
import json
import math
import random
import struct
import sys
import zlib
from fnmatch import fnmatch
from pathlib import Path


class Glb:
    """A GLB file whose meshes have positions and indices, as the built-in models have."""

    def __init__(self, file):
        data = file.read_bytes()
        size = struct.unpack_from("<I", data, 12)[0]
        self.json, self.bytes = json.loads(data[20:20 + size]), bytearray(data[28 + size:])

    def write(self, file):
        self.json["buffers"][0]["byteLength"] = len(self.bytes)
        text = json.dumps(self.json, separators=(",", ":")).encode()
        text += b" " * (-len(text) % 4)
        self.bytes += b"\0" * (-len(self.bytes) % 4)
        file.write_bytes(struct.pack("<III", 0x46546C67, 2, 28 + len(text) + len(self.bytes)) +
                         struct.pack("<II", len(text), 0x4E4F534A) + text +
                         struct.pack("<II", len(self.bytes), 0x004E4942) + bytes(self.bytes))

    def view(self, data):
        self.bytes += b"\0" * (-len(self.bytes) % 4)
        self.json["bufferViews"].append({"buffer": 0, "byteOffset": len(self.bytes), "byteLength": len(data)})
        self.bytes += data
        return len(self.json["bufferViews"]) - 1

    def accessor(self, numbers, kind, component):
        width = {"SCALAR": 1, "VEC2": 2, "VEC3": 3}[kind]
        rows = [numbers[k:k + width] for k in range(0, len(numbers), width)]
        one = {"bufferView": self.view(struct.pack(f"<{len(numbers)}{'f' if component == 5126 else 'I'}", *numbers)),
               "componentType": component, "count": len(rows), "type": kind}
        if kind == "VEC3":
            one["min"], one["max"] = [min(r[i] for r in rows) for i in range(3)], [max(r[i] for r in rows)
                                                                                  for i in range(3)]
        self.json["accessors"].append(one)
        return len(self.json["accessors"]) - 1

    def material(self, **material):
        self.json["materials"].append(material)
        return len(self.json["materials"]) - 1

    def give(self, material, names):
        """Gives the nodes of these names this material; * is any text."""
        for node in self.json["nodes"]:
            if any(fnmatch(node["name"], name) for name in names):
                for primitive in self.json["meshes"][node["mesh"]]["primitives"]:
                    primitive["material"] = material

    def box_of(self, name):
        node = next(n for n in self.json["nodes"] if n["name"] == name)
        positions = self.json["meshes"][node["mesh"]]["primitives"][0]["attributes"]["POSITION"]
        return self.json["accessors"][positions]["min"], self.json["accessors"][positions]["max"]

    def quads(self, name, corners, material, mesh=None):
        """Replaces a node's mesh, or adds a node. corners: four of each quad, counter-clockwise, Y up."""
        flat = [float(x) for corner in corners for x in corner]
        uv = [0., 1., 1., 1., 1., 0., 0., 0.] * (len(corners) // 4)
        indices = [4 * q + k for q in range(len(corners) // 4) for k in (0, 1, 2, 0, 2, 3)]
        primitive = {"attributes": {"POSITION": self.accessor(flat, "VEC3", 5126),
                                    "TEXCOORD_0": self.accessor(uv, "VEC2", 5126)},
                     "indices": self.accessor(indices, "SCALAR", 5125), "material": material}
        if mesh is not None:
            self.json["meshes"][mesh]["primitives"] = [primitive]
            return
        self.json["meshes"].append({"primitives": [primitive]})
        self.json["nodes"].append({"name": name, "mesh": len(self.json["meshes"]) - 1})
        self.json["scenes"][0]["nodes"].append(len(self.json["nodes"]) - 1)


def png_of_leaves(size, leaves, radius, seed):
    """RGBA texture of round leaves on nothing, which repeats."""
    at = random.Random(seed)
    alpha = [bytearray(size) for _ in range(size)]
    for _ in range(leaves):
        x, y = at.uniform(0, size), at.uniform(0, size)
        for j in range(int(y - radius), int(y + radius) + 1):
            for i in range(int(x - radius), int(x + radius) + 1):
                if (i - x) ** 2 + (j - y) ** 2 <= radius ** 2:
                    alpha[j % size][i % size] = 255
    rows = b"".join(b"\0" + b"".join(bytes((60, 110, 30, a)) for a in row) for row in alpha)

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">2I5B", size, size, 8, 6, 0, 0, 0)) +
            chunk(b"IDAT", zlib.compress(rows, 9)) + chunk(b"IEND", b""))


def glass_office(glb):
    """Partitions of glass, and panes in all windows of the facade."""
    glass = glb.material(name="glass", doubleSided=True, pbrMetallicRoughness={"baseColorFactor": [.9, .95, .95, 1],
                                                                               "metallicFactor": 0},
                         extensions={"KHR_materials_transmission": {"transmissionFactor": 1}})
    glb.json.setdefault("extensionsUsed", []).append("KHR_materials_transmission")
    glb.give(glass, ["inner_walls"])
    panes = []
    for south, rooms in ((True, ((.3, 5.94), (6.06, 11.94), (12.06, 17.94), (18.06, 23.7))),
                         (False, ((.3, 4.94), (5.06, 14.94), (15.06, 19.94), (20.06, 23.7)))):
        z = -.15 if south else -14.85
        for x0, x1 in rooms:
            x = x0 + .8
            while x + 1.6 < x1:
                panes += [(x, .9, z), (x + 1.6, .9, z), (x + 1.6, 2.1, z), (x, 2.1, z)]
                x += 2.4
    glb.quads("panes", panes, glass)


def leafy_street(glb):
    """Crowns of leaves, a quad for each twig, which fill the boxes of the solid ones."""
    png = png_of_leaves(64, 40, 5, 1)
    glb.json["images"] = [{"bufferView": glb.view(png), "mimeType": "image/png"}]
    glb.json["samplers"] = [{}]
    glb.json["textures"] = [{"source": 0, "sampler": 0}]
    leaves = glb.material(name="leaves", doubleSided=True, alphaMode="MASK", alphaCutoff=.5,
                          pbrMetallicRoughness={"baseColorTexture": {"index": 0}, "metallicFactor": 0})
    at = random.Random(2)
    for node in glb.json["nodes"]:
        if not node["name"].endswith("_crown"):
            continue
        low, high = glb.box_of(node["name"])
        middle, half = [(a + b) / 2 for a, b in zip(low, high)], [(b - a) / 2 for a, b in zip(low, high)]
        corners = []
        while len(corners) < 4 * 60:
            p = [at.uniform(-1, 1) for _ in range(3)]
            if not .2 < sum(x * x for x in p) < .8:
                continue
            centre = [m + h * x for m, h, x in zip(middle, half, p)]
            turn, tilt, size = at.uniform(0, math.pi), at.uniform(-.6, .6), .45
            u = (math.cos(turn), 0, math.sin(turn))
            v = (-math.sin(turn) * math.sin(tilt), math.cos(tilt), math.cos(turn) * math.sin(tilt))
            corners += [[c + size * (a * x + b * y) for c, x, y in zip(centre, u, v)]
                        for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
        glb.quads(node["name"], corners, leaves, node["mesh"])


def steel_plant(glb):
    """Vessel and pumps of polished steel; tanks and pipes in black insulation."""
    glb.give(glb.material(name="stainless", pbrMetallicRoughness={"baseColorFactor": [.6, .6, .6, 1],
                                                                 "metallicFactor": 1, "roughnessFactor": .03}),
             ["vessel", "pump_?"])
    glb.give(glb.material(name="insulation", pbrMetallicRoughness={"baseColorFactor": [.03, .03, .03, 1],
                                                                   "metallicFactor": 0}), ["pipe_?", "pipe_??", "tank_?"])


def main():
    folder = Path(sys.argv[1])
    for name, made, change in (("office", "glass", glass_office), ("street", "leaves", leafy_street),
                               ("plant", "steel", steel_plant)):
        glb = Glb(folder / f"{name}.glb")
        change(glb)
        glb.write(folder / f"{made}.glb")
        for material in glb.json["materials"]:
            if material.pop("alphaMode", None):
                del material["alphaCutoff"]
                glb.write(folder / f"{made}-solid.glb")


if __name__ == "__main__":
    main()
