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
SECONDS_OF_IMPORTER = 25  # of a file below a megabyte (src/import/import.cpp)

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


def needles():
    """Triangles without area to speak of, each through as many voxels as the site is long, and none where another is."""
    scene, side, corners = Scene(), 200, []
    for k in range(600):
        y, z = side * (k * 0.618034 % 1), side * (k * 0.754878 % 1)
        corners += [(0, y, z), (side, side - y, side - z), (side, side - y + 1e-4, side - z)]
    marked(scene, "surveyed", corners)
    scene.json["asset"]["extras"] = {"vantage": {"user-size": 0.002, "spacing": 0.001}}
    return scene.glb()


def sparse_file(folder, path):
    with open(path, "wb") as file:
        file.truncate(1 << 40)


def fifo(folder, path):
    os.mkfifo(path)


def device(folder, path):
    os.symlink("/dev/zero", path)


DOUBLINGS = 40  # of what holds twice what holds twice …


def dae(nodes, root):
    return f"""<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit name="meter" meter="1"/><up_axis>Z_UP</up_axis></asset>
<library_geometries><geometry id="g"><mesh><source id="p"><float_array id="pa" count="9">0 0 0 4 0 0 0 4 0</float_array>
<technique_common><accessor source="#pa" count="3" stride="3"><param name="X" type="float"/>
<param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="1"><input semantic="VERTEX" source="#v" offset="0"/><p>0 1 2</p></triangles></mesh></geometry>
</library_geometries><library_nodes>{nodes}</library_nodes>
<library_visual_scenes><visual_scene id="s">{root}</visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene></COLLADA>""".encode()


def collada_doubles():
    nodes = '<node id="n0"><instance_geometry url="#g"/></node>' + "".join(
        f'<node id="n{k + 1}">' + f'<instance_node url="#n{k}"/>' * 2 + "</node>" for k in range(DOUBLINGS))
    return dae(nodes, f'<node id="top"><instance_node url="#n{DOUBLINGS}"/></node>')


def collada_holds_itself():
    return dae('<node id="n0"><instance_geometry url="#g"/><instance_node url="#n0"/></node>',
               '<node id="top"><instance_node url="#n0"/></node>')


def collada_deep():
    return dae("", "<node>" * 100000 + '<instance_geometry url="#g"/>' + "</node>" * 100000)


def x3d(text, doctype=""):
    return (f'<?xml version="1.0" encoding="UTF-8"?>{doctype}\n<X3D version="3.0" profile="Interchange"><Scene>{text}'
            "</Scene></X3D>").encode()


X3D_SHAPE = ('<Shape><IndexedFaceSet coordIndex="0 1 2 -1" solid="false"><Coordinate point="0 0 0 4 0 0 0 0 4"/>'
             "</IndexedFaceSet></Shape>")


def x3d_doubles():
    return x3d(f'<Group DEF="g0">{X3D_SHAPE}</Group>' + "".join(
        f'<Group DEF="g{k + 1}">' + f'<Group USE="g{k}"/>' * 2 + "</Group>" for k in range(DOUBLINGS)))


def x3d_entities():
    """Text that stands for twice the text that stands for twice …"""
    entities = "".join(f'<!ENTITY e{k + 1} "&e{k};&e{k};">' for k in range(DOUBLINGS))
    return x3d(f"{X3D_SHAPE}&e{DOUBLINGS};", f'<!DOCTYPE X3D [<!ENTITY e0 "0 0 0 ">{entities}]>')


def dxf_doubles():
    def block(name, content):
        return f"0\nBLOCK\n8\n0\n2\n{name}\n70\n0\n10\n0\n20\n0\n30\n0\n3\n{name}\n{content}0\nENDBLK\n8\n0\n"

    def insert(name):
        return f"0\nINSERT\n8\n0\n2\n{name}\n10\n0\n20\n0\n30\n0\n"
    face = "0\n3DFACE\n8\n0\n10\n0\n20\n0\n30\n0\n11\n4\n21\n0\n31\n0\n12\n0\n22\n4\n32\n0\n13\n0\n23\n4\n33\n0\n"
    blocks = block("b0", face) + "".join(block(f"b{k + 1}", insert(f"b{k}") * 2) for k in range(DOUBLINGS))
    return (f"0\nSECTION\n2\nBLOCKS\n{blocks}0\nENDSEC\n0\nSECTION\n2\nENTITIES\n{insert(f'b{DOUBLINGS}')}"
            "0\nENDSEC\n0\nEOF\n").encode()


def fbx(objects, connections):
    return (f"; FBX 7.3.0 project file\nFBXHeaderExtension:  {{\n\tFBXHeaderVersion: 1003\n\tFBXVersion: 7300\n}}\n"
            f"Objects:  {{\n{objects}}}\nConnections:  {{\n{connections}}}\n").encode()


FBX_SHAPE = ('\tGeometry: 10, "Geometry::g", "Mesh" {\n\t\tVertices: *9 {\n\t\t\ta: 0,0,0,4,0,0,0,0,4\n\t\t}\n'
             "\t\tPolygonVertexIndex: *3 {\n\t\t\ta: 0,1,-3\n\t\t}\n\t\tGeometryVersion: 124\n\t}\n")


def fbx_doubles():
    """Each model below the next one, twice."""
    models = "".join(f'\tModel: {100 + k}, "Model::m{k}", "Mesh" {{\n\t\tVersion: 232\n\t}}\n' for k in range(DOUBLINGS + 1))
    below = "".join(f'\tC: "OO",{100 + k},{101 + k}\n' * 2 for k in range(DOUBLINGS))
    return fbx(FBX_SHAPE + models, f'\tC: "OO",10,100\n{below}\tC: "OO",{100 + DOUBLINGS},0\n')


def fbx_claims():
    return fbx(FBX_SHAPE.replace("*9 {", "*4000000000 {"), '\tC: "OO",10,0\n')


def ply_claims():
    return (b"ply\nformat binary_little_endian 1.0\nelement vertex 4000000000\nproperty float x\nproperty float y\n"
            b"property float z\nelement face 4000000000\nproperty list uint int vertex_indices\nend_header\n" + b"\xff" * 1000)


def obj_long_face():
    return b"v 0 0 0\nv 4 0 0\nv 0 0 4\nf" + b" 1 2 3" * 20000 + b"\n"


def ifc_doubles():
    """A shape that is mapped twice in a shape that is mapped twice …"""
    lines = ["IFCCARTESIANPOINT((0.,0.,0.))", "IFCAXIS2PLACEMENT3D(#1,$,$)",
             "IFCGEOMETRICREPRESENTATIONCONTEXT($,'Model',3,1.E-05,#2,$)", "IFCSIUNIT(*,.LENGTHUNIT.,$,.METRE.)",
             "IFCUNITASSIGNMENT((#4))", "IFCPROJECT('0Vantage00000000000001',$,'p',$,$,$,$,(#3),#5)",
             "IFCLOCALPLACEMENT($,#2)", "IFCSITE('0Vantage00000000000002',$,'s',$,$,#7,$,$,.ELEMENT.,$,$,$,$,$)",
             "IFCRELAGGREGATES('0Vantage00000000000003',$,$,$,#6,(#8))", "IFCDIRECTION((0.,0.,1.))",
             "IFCCARTESIANPOINT((2.,2.))", "IFCAXIS2PLACEMENT2D(#11,$)", "IFCRECTANGLEPROFILEDEF(.AREA.,$,#12,4.,4.)",
             "IFCEXTRUDEDAREASOLID(#13,#2,#10,1.)", "IFCCARTESIANTRANSFORMATIONOPERATOR3D($,$,#1,$,$)",
             "IFCSHAPEREPRESENTATION(#3,'Body','SweptSolid',(#14))"]
    for _ in range(DOUBLINGS):
        last = len(lines)
        lines += [f"IFCREPRESENTATIONMAP(#2,#{last})", f"IFCMAPPEDITEM(#{last + 1},#15)", f"IFCMAPPEDITEM(#{last + 1},#15)",
                  f"IFCSHAPEREPRESENTATION(#3,'Body','MappedRepresentation',(#{last + 2},#{last + 3}))"]
    last = len(lines)
    lines += [f"IFCPRODUCTDEFINITIONSHAPE($,$,(#{last}))",
              f"IFCBUILDINGELEMENTPROXY('0Vantage00000000000004',$,'x',$,$,#7,#{last + 1},$,$)",
              f"IFCRELCONTAINEDINSPATIALSTRUCTURE('0Vantage00000000000005',$,$,$,(#{last + 2}),#8)"]
    data = "".join(f"#{k + 1}={line};\n" for k, line in enumerate(lines))
    return ("ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION((''),'2;1');\nFILE_NAME('','',(''),(''),'','','');\n"
            f"FILE_SCHEMA(('IFC2X3'));\nENDSEC;\nDATA;\n{data}ENDSEC;\nEND-ISO-10303-21;\n").encode()


def meshopt_claims():
    scene = Scene()
    scene.json["bufferViews"].append({"buffer": 0, "byteLength": 3 << 30, "extensions": {"EXT_meshopt_compression": {
        "buffer": 0, "byteOffset": 0, "byteLength": 36, "byteStride": 12, "count": 1 << 28, "mode": "ATTRIBUTES"}}})
    scene.json["extensionsUsed"] = scene.json["extensionsRequired"] = ["EXT_meshopt_compression"]
    scene.node(mesh=scene.mesh({"attributes": {"POSITION": scene.accessor(
        1 << 28, FLOAT, "VEC3", len(scene.json["bufferViews"]) - 1)}}))
    return scene.glb()


def draco_claims():
    """The header of a mesh that says to have four thousand million faces."""
    scene = Scene()
    packed = b"DRACO\2\2\1\0\0\0" + b"\xff\xff\xff\xff\x0f" * 2 + b"\1\0" + b"\xff" * 64
    scene.node(mesh=scene.mesh({
        "attributes": {"POSITION": scene.accessor(3, FLOAT, "VEC3")}, "indices": scene.accessor(3, UINT, "SCALAR"),
        "extensions": {"KHR_draco_mesh_compression": {"bufferView": scene.view(packed), "attributes": {"POSITION": 0}}}}))
    scene.json["extensionsUsed"] = scene.json["extensionsRequired"] = ["KHR_draco_mesh_compression"]
    return scene.glb()


def gzip_bomb():
    """Blanks, deflated, before a scene."""
    packer = zlib.compressobj(9, zlib.DEFLATED, 31)
    return packer.compress(b" " * (1 << 30)) + packer.compress(b"{}") + packer.flush()


def table(text):
    return lambda: text.encode(errors="surrogateescape")


NAME_FOR_OTHERS = "\x1b]0;owned\x07\x1b[2J\u202egnp"


def scanners():
    with open(os.path.join(os.path.dirname(__file__), "../../data/scanners.json"), encoding="utf-8") as file:
        document = json.load(file)
    document["scanners"] = {"mine": {**document["scanners"]["rtc360"], "name": NAME_FOR_OTHERS + "n" * 1000000}}
    return json.dumps(document).encode()


STATION = ["--station", "1,-1,1.5"]
# name: what makes it, whether it may be read
FILES = {
    "one_view_many_images.glb": (one_view_many_images, True),
    "many_images.glb": (many_images, True),
    "inflates.glb": (picture(lambda: png(64, 64, 8, 6, zeros(1 << 30))), True),
    "jpeg_claims.glb": (picture(lambda: jpeg(16384, 0)[:2000]), True),
    "jpeg_scans.glb": (picture(lambda: jpeg(4096, 400)), True),
    "instances_without_view.glb": (instances_without_view, False),
    "vertices_without_view.glb": (vertices_without_view, False),
    "indices_without_view.glb": (indices_without_view, False),
    "nodes_times_primitives.glb": (nodes_times_primitives, False),
    "one_mesh_many_times.glb": (one_mesh_many_times, True),
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
    "needles.glb": (needles, False),
    "doubles.dae": (collada_doubles, False),
    "holds_itself.dae": (collada_holds_itself, False),
    "deep.dae": (collada_deep, False),
    "doubles.x3d": (x3d_doubles, False),
    "entities.x3d": (x3d_entities, False),
    "doubles.dxf": (dxf_doubles, False),
    "doubles.fbx": (fbx_doubles, False),
    "claims.fbx": (fbx_claims, False),
    "claims.ply": (ply_claims, False),
    "long_face.obj": (obj_long_face, True),
    "doubles.ifc": (ifc_doubles, False),
    "meshopt_claims.glb": (meshopt_claims, False),
    "draco_claims.glb": (draco_claims, False),
    "gzip_bomb.gltf.gz": (gzip_bomb, False),
    "many_fields.csv": (table("x,y,z" + ",name" * 2000000 + "\n1,2,3\n"), False),
    "name_for_others.csv": (table(f"x,y,z,name\n1,-1,1.5,{NAME_FOR_OTHERS}\n"), True),
    "scanner_for_others.csv": (table(f"x,y,z,scanner\n1,-1,1.5,{NAME_FOR_OTHERS}\n"), False),
    "column_for_others.csv": (table(f"x,y,z,{NAME_FOR_OTHERS}\n1,-1,1.5,1\n"), False),
    "scanners.json": (scanners, True),
    "system.prj": (table('PROJCS["' + NAME_FOR_OTHERS + '",' * 100000), False),
    "deep.prj": (table("GEOGCS[" * 200000), False),
    "sparse.prj": (sparse_file, False),
    "fifo.prj": (fifo, False),
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
    if path.endswith(".prj"):
        return [site, "--crs", path] + STATION
    if path.endswith("scanners.json"):
        return [site, "--scanner", "mine"] + STATION
    if path.endswith(".json"):
        return [site, "--config", path] + STATION
    return [path] + STATION


FOREIGN = (".dae", ".x3d", ".dxf", ".fbx", ".ply", ".obj", ".ifc", ".gz", "meshopt_claims.glb", "draco_claims.glb")


def limit(foreign):
    """An importer has limits of its own, by which the program sets it; node reserves address space that it never uses."""
    def set_limits():
        seconds = SECONDS_OF_IMPORTER if foreign else SECONDS
        if not foreign:
            resource.setrlimit(resource.RLIMIT_AS, (MEMORY + SLACK, MEMORY + SLACK))
        resource.setrlimit(resource.RLIMIT_CPU, (seconds, seconds))
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    return set_limits


def complaints(program, folder, name):
    path = write(folder, name)
    command = [program, "evaluate"] + arguments(folder, path) + [
        "--engine", "embree", "--step", "2", "--memory", str(MEMORY), "--json"]
    process = subprocess.Popen(command, cwd=folder, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                               stderr=subprocess.STDOUT, preexec_fn=limit(name.endswith(FOREIGN)),
                               env={**os.environ, "XDG_CACHE_HOME": os.path.join(folder, "cache"),
                                    "VANTAGE_DATA": folder if name == "scanners.json" else ""})
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
