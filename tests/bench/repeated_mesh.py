#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes a hall of machines that share one mesh, as plant and building models do: repeated_mesh.py OUT.glb
[--nodes N] [--triangles T]. The machines stand in a square grid, each turned its own way, on a floor."""
import argparse
import array
import json
import math
import struct


def machine(triangles):
    """A closed, bumpy body of about `triangles` triangles, 1.6 m wide and 2.1 m high, Y up, standing on y = 0.02."""
    rows = max(3, round(math.sqrt(triangles / 4)))
    columns = 2 * rows
    positions, indices = array.array("f"), array.array("I")
    for j in range(rows + 1):
        zenith = math.pi * j / rows
        for i in range(columns):
            azimuth = 2 * math.pi * i / columns
            bump = 1 + 0.04 * math.sin(23 * azimuth) * math.sin(17 * zenith) ** 2
            ring = 0.8 * math.sin(zenith) ** 0.5 * bump if 0 < j < rows else 0
            positions.extend((ring * math.cos(azimuth), 1.07 + 1.05 * math.cos(zenith), ring * math.sin(azimuth)))
    for j in range(rows):
        for i in range(columns):
            a, b = j * columns + i, j * columns + (i + 1) % columns
            c, d = a + columns, b + columns
            if j > 0:
                indices.extend((a, b, c))
            if j < rows - 1:
                indices.extend((b, d, c))
    return positions, indices


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("out")
    parser.add_argument("--nodes", type=int, default=400)
    parser.add_argument("--triangles", type=int, default=300_000)
    options = parser.parse_args()

    binary = bytearray()
    views, accessors = [], []

    def add(values, component_type, kind, limits=None):
        views.append({"buffer": 0, "byteOffset": len(binary), "byteLength": len(values) * values.itemsize})
        binary.extend(values.tobytes())
        parts = 3 if kind == "VEC3" else 1
        accessors.append({"bufferView": len(views) - 1, "componentType": component_type, "count": len(values) // parts,
                          "type": kind, **(limits or {})})
        return len(accessors) - 1

    def mesh(positions, indices):
        limits = {"min": [min(positions[k::3]) for k in range(3)], "max": [max(positions[k::3]) for k in range(3)]}
        return {"primitives": [{"attributes": {"POSITION": add(positions, 5126, "VEC3", limits)},
                                "indices": add(indices, 5125, "SCALAR")}]}

    side = math.ceil(math.sqrt(options.nodes))
    apart, wide = 4.0, 4.0 * side
    floor = array.array("f", (-4, 0, -4, -4, 0, wide, wide, 0, wide, wide, 0, -4))
    meshes = [mesh(*machine(options.triangles)), mesh(floor, array.array("I", (0, 1, 2, 0, 2, 3)))]
    nodes = [{"name": "floor", "mesh": 1}]
    for n in range(options.nodes):
        half = 0.5 * (0.37 * n % (2 * math.pi))
        nodes.append({"name": f"machine {n}", "mesh": 0,
                      "translation": [apart * (n % side), 0, apart * (n // side)],
                      "rotation": [0, math.sin(half), 0, math.cos(half)]})
    document = {"asset": {"version": "2.0", "extras": {"vantage": {}}}, "scene": 0,
                "scenes": [{"nodes": list(range(len(nodes)))}], "nodes": nodes, "meshes": meshes,
                "accessors": accessors, "bufferViews": views, "buffers": [{"byteLength": len(binary)}]}
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    binary.extend(b"\0" * (-len(binary) % 4))
    with open(options.out, "wb") as file:
        file.write(struct.pack("<4sIIII", b"glTF", 2, 28 + len(text) + len(binary), len(text), 0x4E4F534A) + text)
        file.write(struct.pack("<II", len(binary), 0x004E4942) + binary)


main()
