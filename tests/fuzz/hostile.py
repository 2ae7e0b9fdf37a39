#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Scenes, pictures and tables of somebody who means harm: small files that stand for a great deal.

    hostile.py PROGRAM [NAME...]   makes each file and gives it to the program, which may take --memory and no more
    hostile.py --write FOLDER      only makes them

Each ends within the memory, ten seconds of processor time and an address space somewhat above the memory: refused by
one error, or read where it does no harm.
"""
import base64
import json
import os
import re
import resource
import struct
import subprocess
import sys
import tempfile
import zlib

MEMORY = 512 << 20  # of --memory
SLACK = 1 << 30  # of the address space besides: libraries, stacks and heaps of two threads, which are hardly touched
SECONDS = 10

FLOAT, UINT, UBYTE = 5126, 5125, 5121


class Scene:
    """A GLB in the making. The triangle of mesh 0 makes it one that can be surveyed."""

    def __init__(self):
        self.binary = b""
        self.json = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
                     "meshes": [], "accessors": [], "bufferViews": []}
        self.mesh({"attributes": {"POSITION": self.positions([(0, 0, 0), (4, 0, 0), (0, 0, 4)])}})

    def view(self, data):
        self.json["bufferViews"].append({"buffer": 0, "byteOffset": len(self.binary), "byteLength": len(data)})
        self.binary += data + b"\0" * (-len(data) % 4)
        return len(self.json["bufferViews"]) - 1

    def accessor(self, count, component, kind, view=None):
        self.json["accessors"].append({"count": count, "componentType": component, "type": kind})
        if view is not None:
            self.json["accessors"][-1]["bufferView"] = view
        return len(self.json["accessors"]) - 1

    def positions(self, points):
        return self.accessor(len(points), FLOAT, "VEC3",
                             self.view(b"".join(struct.pack("<3f", *p) for p in points)))

    def indices(self, values):
        return self.accessor(len(values), UINT, "SCALAR", self.view(struct.pack(f"<{len(values)}I", *values)))

    def mesh(self, *primitives):
        self.json["meshes"].append({"primitives": list(primitives)})
        return len(self.json["meshes"]) - 1

    def node(self, **members):
        self.json["nodes"].append(members)
        self.json["scenes"][0]["nodes"].append(len(self.json["nodes"]) - 1)

    def textures(self, images):
        """Each on a triangle of its own."""
        texcoord = self.accessor(3, FLOAT, "VEC2", self.view(struct.pack("<6f", 0, 0, 1, 0, 0, 1)))
        position = self.json["meshes"][0]["primitives"][0]["attributes"]["POSITION"]
        self.json["images"] = images
        self.json["textures"] = [{"source": k} for k in range(len(images))]
        self.json["materials"] = [{"pbrMetallicRoughness": {"baseColorTexture": {"index": k}}} for k in range(len(images))]
        for k in range(len(images)):
            self.node(translation=[0, k, 0], mesh=self.mesh(
                {"attributes": {"POSITION": position, "TEXCOORD_0": texcoord}, "material": k}))

    def glb(self):
        self.json.setdefault("buffers", [{"byteLength": len(self.binary)}])
        text = json.dumps(self.json, separators=(",", ":")).encode()
        return container(text, self.binary)


def container(text, binary=b""):
    text += b" " * (-len(text) % 4)
    chunks = struct.pack("<II", len(text), 0x4E4F534A) + text
    if binary:
        chunks += struct.pack("<II", len(binary), 0x004E4942) + binary
    return struct.pack("<III", 0x46546C67, 2, 12 + len(chunks)) + chunks


def png(width, height, bits, colour, rows):
    def chunk(name, data):
        return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, bits, colour, 0, 0, 0)) +
            chunk(b"IDAT", rows) + chunk(b"IEND", b""))


def zeros(count):
    """So many zeros, deflated, and made in less time than they take to inflate."""
    block = zlib.compressobj(9)
    once = block.compress(b"\0" * (1 << 20)) + block.flush(zlib.Z_FULL_FLUSH)
    again = zlib.compressobj(9, zlib.DEFLATED, -15)
    more = again.compress(b"\0" * (1 << 20)) + again.flush(zlib.Z_FULL_FLUSH)
    last = zlib.compressobj(9, zlib.DEFLATED, -15)
    rest = last.compress(b"\0" * (count % (1 << 20))) + last.flush()
    assert count >= 1 << 20
    # Adler-32 of zeros: the sum stays 1, and the sum of sums grows by it.
    return once + more * (count // (1 << 20) - 1) + rest + struct.pack(">HH", count % 65521, 1)


def jpeg(side, scans, progressive=True):
    """A grey picture of that many empty scans, or as many of its first coefficients."""
    def segment(mark, data):
        return bytes([0xFF, mark]) + struct.pack(">H", len(data) + 2) + data
    out = b"\xff\xd8" + segment(0xDB, b"\0" + b"\1" * 64)
    out += segment(0xC2 if progressive else 0xC0, struct.pack(">BHHB", 8, side, side, 1) + b"\1\x11\0")
    out += segment(0xC4, b"\0" + b"\1" + b"\0" * 15 + b"\0")  # one code, of one bit: no difference
    out += segment(0xC4, b"\x10" + b"\1" + b"\0" * 15 + b"\xe0")  # one code: the next 2^14 blocks and more are empty
    blocks = (side // 8) ** 2
    out += segment(0xDA, b"\1\1\0\0\0\1") + b"\0" * (blocks // 8 + 1)
    for scan in range(scans):
        out += segment(0xDA, b"\1\1\0\1\x3f\0") + b"\0\0" * (blocks // (1 << 14) + 1)
    return out + b"\xff\xd9"


LARGE = png(16384, 16384, 1, 0, zeros(16384 * 2049))


def one_view_many_images():
    scene = Scene()
    view = scene.view(LARGE)
    scene.textures([{"bufferView": view, "mimeType": "image/png"}] * 30)
    return scene.glb()


def many_images():
    scene = Scene()
    picture = png(4096, 4096, 1, 0, zeros(4096 * 513))
    scene.textures([{"bufferView": scene.view(picture), "mimeType": "image/png"} for _ in range(30)])
    return scene.glb()


def picture(data):
    def make():
        scene = Scene()
        scene.textures([{"bufferView": scene.view(data()), "mimeType": "image/png"}])
        return scene.glb()
    return make


def instances_without_view():
    scene = Scene()
    mesh = scene.mesh({"attributes": {"POSITION": 0}, "indices": scene.indices([0, 1, 2] * 1000)})
    scene.node(mesh=mesh, extensions={"EXT_mesh_gpu_instancing": {
        "attributes": {"TRANSLATION": scene.accessor(1 << 20, FLOAT, "VEC3")}}})
    return scene.glb()


def vertices_without_view():
    scene = Scene()
    scene.node(mesh=scene.mesh({"attributes": {"POSITION": scene.accessor(1 << 26, FLOAT, "VEC3")}}))
    return scene.glb()


def indices_without_view():
    scene = Scene()
    strip = {"attributes": {"POSITION": 0}, "indices": scene.accessor(1 << 26, UBYTE, "SCALAR"), "mode": 5}
    for k in range(100):
        scene.node(mesh=scene.mesh(strip), name=f"strip {k}")
    return scene.glb()


def nodes_times_primitives():
    scene = Scene()
    mesh = scene.mesh(*[{"attributes": {"POSITION": 0}}] * 5000)
    for _ in range(20000):
        scene.node(mesh=mesh)
    return scene.glb()


def one_mesh_many_times():
    scene = Scene()
    mesh = scene.mesh({"attributes": {"POSITION": 0}, "indices": scene.indices([0, 1, 2] * 3000)})
    for _ in range(20000):
        scene.node(mesh=mesh)
    return scene.glb()


def deep_tree():
    """A chain of nodes, each with instances; the last has the mesh."""
    scene = Scene()
    first = len(scene.json["nodes"])
    for k in range(20000):
        scene.json["nodes"].append({"children": [first + k + 1], "translation": [0, 0.001, 0]})
    scene.json["nodes"].append({"mesh": 0, "name": "deepest"})
    scene.json["scenes"][0]["nodes"].append(first)
    return scene.glb()


def nested_json():
    return container(b'{"asset":{"version":"2.0","extras":' + b"[" * 200000 + b"]" * 200000 + b"}}")


def small_values(text, count):
    return lambda: container(b'{"asset":{"version":"2.0"},"extras":[' + b",".join([text] * count) + b"]}")


def empty_elements(array):
    return lambda: container(b'{"asset":{"version":"2.0"},"' + array + b'":[' + b",".join([b"{}"] * 1000000) + b"]}")


def long_names():
    scene = Scene()
    scene.json["nodes"][0]["name"] = "\u00e4" * 500000
    mesh = scene.mesh(*[{"attributes": {"POSITION": 0}}] * 1000)
    scene.node(mesh=mesh, name="n" * 1000000, translation=[0, 1, 0])
    return scene.glb()


def names_for_others():
    scene = Scene()
    scene.json["nodes"][0]["name"] = "\x1b]0;owned\x07\x1b[2J\u009b31m\u202egnp"
    scene.node(mesh=0, name='=HYPERLINK("http://example.org")', translation=[0, 1, 0])
    scene.node(mesh=0, name="</script><script>alert(1)</script>{{data}}", translation=[0, 2, 0])
    scene.json["extensionsRequired"] = ["\x1b[2J\u202e"]
    return scene.glb()


def same_file_many_times(folder):
    with open(os.path.join(folder, "large.bin"), "wb") as file:
        file.truncate(64 << 20)  # of no blocks
    scene = Scene()
    scene.json["buffers"] = [{"byteLength": 64 << 20, "uri": "large.bin"}] * 100
    return json.dumps(scene.json).encode()


def data_uris():
    scene = Scene()
    uri = "data:application/octet-stream;base64," + base64.b64encode(b"\0" * (3 << 20)).decode()
    scene.json["buffers"] = [{"byteLength": 3 << 20, "uri": uri}] * 10
    return json.dumps(scene.json).encode()


def marked(scene, role, corners):
    mesh = scene.mesh({"attributes": {"POSITION": scene.positions(corners)}})
    scene.node(mesh=mesh, extras={"vantage": {"role": role}})


def overlaps_in_a_plane():
    """Each of these surveyed triangles overlaps each of those blocking ones."""
    scene = Scene()
    for role in ("surveyed", "blocking"):
        marked(scene, role, [c for k in range(6000) for c in ((0, 0, 0), (4 + 0.001 * k, 0, 0), (0, 0, 4 + 0.001 * k))])
    return scene.glb()


def grid_in_a_plane():
    """Slits that leave of two blocking triangles as many squares as they are, squared."""
    scene = Scene()
    slits = []
    for k in range(1, 4000):
        at, wide = 0.01 * k, 0.002
        for x0, z0, x1, z1 in ((at, 0, at + wide, 40), (0, at, 40, at + wide)):
            slits += [(x0, 0, z0), (x0, 0, z1), (x1, 0, z1), (x0, 0, z0), (x1, 0, z1), (x1, 0, z0)]
    marked(scene, "surveyed", slits)
    marked(scene, "blocking", [(0, 0, 0), (0, 0, 40), (40, 0, 40), (0, 0, 0), (40, 0, 40), (40, 0, 0)])
    return scene.glb()


def sparse_file(folder, path):
    with open(path, "wb") as file:
        file.truncate(1 << 40)


def fifo(folder, path):
    os.mkfifo(path)


def device(folder, path):
    os.symlink("/dev/zero", path)


STATION = ["--station", "1,-1,1.5"]
# name: what makes it, whether it may be read
FILES = {
    "one_view_many_images.glb": (one_view_many_images, False),
    "many_images.glb": (many_images, False),
    "inflates.glb": (picture(lambda: png(64, 64, 8, 6, zeros(1 << 30))), True),
    "jpeg_claims.glb": (picture(lambda: jpeg(16384, 0)[:2000]), False),
    "jpeg_scans.glb": (picture(lambda: jpeg(4096, 400)), True),
    "instances_without_view.glb": (instances_without_view, False),
    "vertices_without_view.glb": (vertices_without_view, False),
    "indices_without_view.glb": (indices_without_view, False),
    "nodes_times_primitives.glb": (nodes_times_primitives, False),
    "one_mesh_many_times.glb": (one_mesh_many_times, False),
    "deep_tree.glb": (deep_tree, True),
    "nested.glb": (nested_json, False),
    "empty_lists.glb": (small_values(b"[]", 5000000), False),
    "empty_nodes.glb": (empty_elements(b"nodes"), False),
    "empty_textures.glb": (empty_elements(b"textures"), False),
    "long_names.glb": (long_names, True),
    "names_for_others.glb": (names_for_others, False),
    "same_file_many_times.gltf": (same_file_many_times, False),
    "data_uris.gltf": (data_uris, False),
    "overlaps_in_a_plane.glb": (overlaps_in_a_plane, True),
    "grid_in_a_plane.glb": (grid_in_a_plane, False),
    "sparse.glb": (sparse_file, False),
    "fifo.glb": (fifo, False),
    "device.glb": (device, False),
    "sparse.csv": (sparse_file, False),
    "fifo.csv": (fifo, False),
    "device.csv": (device, False),
    "sparse.json": (sparse_file, False),
    "fifo.json": (fifo, False),
    "device.json": (device, False),
}


def write(folder, name):
    make, _ = FILES[name]
    path = os.path.join(folder, name)
    wanted = make.__code__.co_varnames[:make.__code__.co_argcount]
    content = make(**{key: value for key, value in (("folder", folder), ("path", path)) if key in wanted})
    if content is not None:
        with open(path, "wb") as file:
            file.write(content)
    return path


def arguments(folder, path):
    site = os.path.join(folder, "site.glb")
    if path.endswith(".csv"):
        return [site, "--stations", path]
    if path.endswith(".json"):
        return [site, "--config", path] + STATION
    return [path] + STATION


def limit():
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY + SLACK, MEMORY + SLACK))
    resource.setrlimit(resource.RLIMIT_CPU, (SECONDS, SECONDS))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))


def complaints(program, folder, name):
    path = write(folder, name)
    command = [program, "evaluate"] + arguments(folder, path) + [
        "--engine", "embree", "--step", "2", "--memory", str(MEMORY), "--json"]
    process = subprocess.Popen(command, cwd=folder, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                               stderr=subprocess.STDOUT, preexec_fn=limit)
    text = process.stdout.read().decode(errors="replace")
    process.stdout.close()
    _, status, usage = os.wait4(process.pid, 0)
    code = os.waitstatus_to_exitcode(status)
    process.returncode = code
    errors = text.count("error: ")
    out = []
    if usage.ru_maxrss * 1024 > MEMORY:
        out.append(f"took {usage.ru_maxrss // 1024} MiB")
    may_be_read = FILES[name][1]
    if code not in ((0,) if may_be_read else (1, 2)) or errors != (0 if may_be_read else 1):
        out.append(f"ended with {code} and {errors} errors")
    if re.search("[\x00-\x08\x0b-\x1f\x7f-\x9f\u202a-\u202e\u2066-\u2069]", text):
        out.append("sent the terminal what it obeys")
    last = text.strip().splitlines()[-1][:150] if text.strip() else ""
    seconds = usage.ru_utime + usage.ru_stime
    print(f"{name}: {os.stat(path).st_size} bytes, exit {code}, {usage.ru_maxrss // 1024} MiB, {seconds:.1f} s: {last}")
    os.remove(path)
    return [f"{name} {each}: {text[:2000]}" for each in out]


def main():
    if sys.argv[1] == "--write":
        os.makedirs(sys.argv[2], exist_ok=True)
        for name in FILES:
            write(sys.argv[2], name)
        return 0
    os.sched_setaffinity(0, sorted(os.sched_getaffinity(0))[:2])  # stacks and heaps are by thread
    found = []
    with tempfile.TemporaryDirectory() as folder:
        with open(os.path.join(folder, "site.glb"), "wb") as file:
            file.write(Scene().glb())
        for name in sys.argv[2:] or FILES:
            found += complaints(os.path.abspath(sys.argv[1]), folder, name)
    for each in found:
        print("FAILED:", each)
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
