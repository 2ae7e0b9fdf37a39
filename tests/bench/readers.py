#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""readers.py BUILD [--against BUILD] [--points N] [--triangles N] [--products N] [--repeats R] [--laz FILE] [KIND...]

Writes a file of each kind and prints the processor time, in microseconds for each point, triangle or product, and the memory that its
reader takes; of two builds in turn. Of several times each it is the least. Kinds: las e57 ply xyz pcd obj stl ply-faces dae x3d ifc. LAZ is
read if a file of version 1.4 is given, since nothing here writes it; its memory is that of the larger of two processes."""
import argparse
import array
import math
import multiprocessing
import os
import random
import shutil
import struct
import subprocess
import sys
import tempfile

POINTS = ("las", "e57", "ply", "xyz", "pcd", "laz")


def points_of_rooms(count):
    """Rooms of 6 x 5 x 2.8 m side by side, seen from their middles, with 2 mm of noise."""
    random.seed(1)
    out, rooms = array.array("d"), 12
    for k in range(count):
        room, azimuth = k * rooms // count, 2 * math.pi * k * rooms / count
        height = -1.2 + 2.4 * (k * 0.618034 % 1)
        x, y, z = math.cos(azimuth) * math.cos(height), math.sin(azimuth) * math.cos(height), math.sin(height)
        far = min(3 / max(abs(x), 1e-9), 2.5 / max(abs(y), 1e-9), (1.2 if z > 0 else 1.6) / max(abs(z), 1e-9))
        far += 0.004 * (random.random() + random.random() - 1)
        out.extend((room % 4 * 6.2 + 3 + far * x, room // 4 * 5.2 + 2.5 + far * y, 1.6 + far * z))
    return out


def write_las(path, points):
    count = len(points) // 3
    scaled = [round(1000 * value) for value in points]
    header = bytearray(375)
    header[0:4] = b"LASF"
    header[24:26] = bytes((1, 4))
    struct.pack_into("<HII", header, 94, 375, 375, 0)
    struct.pack_into("<BH", header, 104, 6, 30)
    struct.pack_into("<3d", header, 131, 0.001, 0.001, 0.001)
    for axis in range(3):
        struct.pack_into("<2d", header, 179 + 16 * axis, max(points[axis::3]), min(points[axis::3]))
    struct.pack_into("<Q", header, 247, count)
    body, rest = bytearray(30 * count), struct.pack("<HBBBBhHd", 900, 0x11, 0, 1, 0, 0, 1, 0.0)
    for k in range(count):
        struct.pack_into("<3i", body, 30 * k, *scaled[3 * k:3 * k + 3])
        body[30 * k + 12:30 * k + 30] = rest
    with open(path, "wb") as file:
        file.write(header + body)


def write_points_ply(path, points):
    with open(path, "wb") as file:
        file.write(f"ply\nformat binary_little_endian 1.0\ncomment crs none\nelement vertex {len(points) // 3}\nproperty double x\n"
                   "property double y\nproperty double z\nend_header\n".encode() + points.tobytes())


def write_pcd(path, points):
    count = len(points) // 3
    with open(path, "wb") as file:
        file.write(f"# .PCD v0.7\nVERSION 0.7\nFIELDS x y z\nSIZE 8 8 8\nTYPE F F F\nCOUNT 1 1 1\nWIDTH {count}\nHEIGHT 1\n"
                   f"VIEWPOINT 0 0 0 1 0 0 0\nPOINTS {count}\nDATA binary\n".encode() + points.tobytes())


def write_xyz(path, points):
    with open(path, "w", encoding="ascii") as file:
        for k in range(0, len(points), 3):
            file.write("%.3f %.3f %.3f\n" % (points[k], points[k + 1], points[k + 2]))


def write_e57(path, count, build):
    """A simulated scan: nothing else here writes E57."""
    site = os.path.join(os.path.dirname(path), "office.glb")
    run([os.path.join(build, "vantage"), "generate", "office", "-o", site])
    step = math.degrees(math.sqrt(2 * math.pi * 2.6 / count))
    run([os.path.join(build, "vantage"), "scan", site, "--station", "6,3,1.7", "--step", f"{step:.4f}", "--engine", "embree", "-o", path])


def hills(triangles):
    """A grid of about so many triangles: corners, and the corners of each triangle."""
    side = round(math.sqrt(triangles / 2))
    corners = [(0.1 * i, 0.1 * j, 0.5 * math.sin(0.05 * i) * math.cos(0.07 * j)) for j in range(side + 1) for i in range(side + 1)]
    faces = []
    for j in range(side):
        for i in range(side):
            a = j * (side + 1) + i
            faces += [(a, a + 1, a + side + 2), (a, a + side + 2, a + side + 1)]
    return corners, faces


def write_obj(path, corners, faces):
    with open(path, "w", encoding="ascii") as file:
        file.writelines("v %.4f %.4f %.4f\n" % corner for corner in corners)
        file.writelines("f %d %d %d\n" % (a + 1, b + 1, c + 1) for a, b, c in faces)


def write_stl(path, corners, faces):
    with open(path, "wb") as file:
        file.write(b" " * 80 + struct.pack("<I", len(faces)))
        for face in faces:
            file.write(struct.pack("<12fH", 0, 0, 1, *corners[face[0]], *corners[face[1]], *corners[face[2]], 0))


def write_faces_ply(path, corners, faces):
    with open(path, "wb") as file:
        file.write(f"ply\nformat binary_little_endian 1.0\nelement vertex {len(corners)}\nproperty float x\nproperty float y\nproperty float z\n"
                   f"element face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n".encode())
        file.writelines(struct.pack("<3f", *corner) for corner in corners)
        file.writelines(struct.pack("<B3i", 3, *face) for face in faces)


def write_dae(path, corners, faces):
    values = " ".join("%.4f %.4f %.4f" % corner for corner in corners)
    indices = " ".join("%d %d %d" % face for face in faces)
    with open(path, "w", encoding="ascii") as file:
        file.write(
            '<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1"><asset><unit meter="1"/><up_axis>Z_UP</up_axis></asset>'
            f'<library_geometries><geometry id="g"><mesh><source id="p"><float_array id="f" count="{3 * len(corners)}">{values}</float_array>'
            f'<technique_common><accessor source="#f" count="{len(corners)}" stride="3"><param name="X" type="float"/><param name="Y" type="float"/>'
            '<param name="Z" type="float"/></accessor></technique_common></source><vertices id="v"><input semantic="POSITION" source="#p"/></vertices>'
            f'<triangles count="{len(faces)}"><input semantic="VERTEX" source="#v" offset="0"/><p>{indices}</p></triangles></mesh></geometry>'
            '</library_geometries><library_visual_scenes><visual_scene id="s"><node><instance_geometry url="#g"/></node></visual_scene>'
            '</library_visual_scenes><scene><instance_visual_scene url="#s"/></scene></COLLADA>')


def write_x3d(path, corners, faces):
    values = ", ".join("%.4f %.4f %.4f" % corner for corner in corners)
    indices = " ".join("%d %d %d -1" % face for face in faces)
    with open(path, "w", encoding="ascii") as file:
        file.write(f"<X3D version='3.3'><Scene><Shape><IndexedFaceSet coordIndex='{indices}'><Coordinate point='{values}'/></IndexedFaceSet>"
                   "</Shape></Scene></X3D>")


def write_ifc(path, products):
    """Walls in rows, one in four with an opening."""
    lines = ["#1=IFCSIUNIT(*,.LENGTHUNIT.,$,.METRE.);", "#2=IFCUNITASSIGNMENT((#1));", "#3=IFCCARTESIANPOINT((0.,0.,0.));",
             "#4=IFCAXIS2PLACEMENT3D(#3,$,$);", "#5=IFCGEOMETRICREPRESENTATIONCONTEXT($,'Model',3,1.E-05,#4,$);",
             "#6=IFCPROJECT('0000000000000000000001',$,'p',$,$,$,$,(#5),#2);", "#7=IFCDIRECTION((0.,0.,1.));",
             "#8=IFCCARTESIANPOINT((0.,0.));", "#9=IFCAXIS2PLACEMENT2D(#8,$);", "#10=IFCRECTANGLEPROFILEDEF(.AREA.,$,#9,4.,0.2);",
             "#11=IFCRECTANGLEPROFILEDEF(.AREA.,$,#9,1.,0.5);", "#12=IFCLOCALPLACEMENT($,#4);"]
    at = 20

    def product(kind, number, profile, height, below, x, y):
        nonlocal at
        n, at = at, at + 8
        lines.extend((f"#{n}=IFCCARTESIANPOINT(({x:.1f},{y:.1f},0.));", f"#{n + 1}=IFCAXIS2PLACEMENT3D(#{n},$,$);",
                      f"#{n + 2}=IFCLOCALPLACEMENT({below},#{n + 1});", f"#{n + 3}=IFCEXTRUDEDAREASOLID(#{profile},#4,#7,{height:.1f});",
                      f"#{n + 4}=IFCSHAPEREPRESENTATION(#5,'Body','SweptSolid',(#{n + 3}));",
                      f"#{n + 5}=IFCPRODUCTDEFINITIONSHAPE($,$,(#{n + 4}));",
                      f"#{n + 6}={kind}('{number:022d}',$,'{kind} {number}',$,$,#{n + 2},#{n + 5},$,$);"))
        return n + 6, n + 2

    for k in range(products):
        wall, place = product("IFCWALL", 2 * k + 10, 10, 3, "#12", 5 * (k % 60), 3 * (k // 60))
        if k % 4 == 0:
            hole, _ = product("IFCOPENINGELEMENT", 2 * k + 11, 11, 2, f"#{place}", 0, 0)
            lines.append(f"#{at}=IFCRELVOIDSELEMENT('{3 * products + k + 20:022d}',$,$,$,#{wall},#{hole});")
            at += 1
    with open(path, "w", encoding="ascii") as file:
        file.write("ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION((''),'2;1');\nFILE_NAME('','',(''),(''),'','','');\nFILE_SCHEMA(('IFC4'));\nENDSEC;\n"
                   "DATA;\n" + "\n".join(lines) + "\nENDSEC;\nEND-ISO-10303-21;\n")


def write(files, options):
    points = points_of_rooms(options.points) if set(files) & {"las", "ply", "xyz", "pcd"} else None
    mesh = hills(options.triangles) if set(files) - set(POINTS) - {"ifc"} else None
    writers = {"las": write_las, "ply": write_points_ply, "xyz": write_xyz, "pcd": write_pcd, "obj": write_obj, "stl": write_stl,
               "ply-faces": write_faces_ply, "dae": write_dae, "x3d": write_x3d}
    for kind, file in files.items():
        if kind == "e57":
            write_e57(file, options.points, options.build)
        elif kind == "ifc":
            write_ifc(file, options.products)
        elif kind != "laz":
            writers[kind](file, *((points,) if kind in POINTS else mesh))


def run(command):
    """Processor seconds, and the largest memory of one of its processes in MB."""
    with open(os.devnull, "wb") as nothing:
        process = subprocess.Popen(command, stdout=nothing, stderr=subprocess.PIPE)
        said = process.stderr.read()
        _, status, used = os.wait4(process.pid, 0)
    if status != 0:
        sys.exit(f"readers.py: {' '.join(command)} ended with {os.waitstatus_to_exitcode(status)}: {said.decode(errors='replace')[-500:]}")
    return used.ru_utime + used.ru_stime, used.ru_maxrss / 1000


def command_of(build, kind, file):
    if kind == "ifc":
        return ["node", os.path.join(build, "vantage-import-ifc", "import.mjs"), file]
    cloud = kind in POINTS
    return [os.path.join(build, "vantage-import-cloud" if cloud else "vantage-import-mesh"),
            {"ply-faces": "ply", "laz": "las"}.get(kind, kind), file]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build")
    parser.add_argument("kinds", nargs="*", default=[])
    parser.add_argument("--against")
    parser.add_argument("--laz")
    for name, value in (("points", 2_000_000), ("triangles", 500_000), ("products", 2000), ("repeats", 5)):
        parser.add_argument("--" + name, type=int, default=value)
    options = parser.parse_intermixed_args()
    kinds = options.kinds or ["las", "e57", "ply", "xyz", "pcd", "obj", "stl", "ply-faces", "dae", "x3d", "ifc"]
    if options.laz and "laz" not in kinds:
        kinds.append("laz")
    builds = [options.build] + ([options.against] if options.against else [])
    folder = tempfile.mkdtemp(prefix="vantage-readers-")
    files = {kind: options.laz if kind == "laz" else os.path.join(folder, "site." + kind.replace("ply-", "faces.")) for kind in kinds}
    try:
        # A process of its own, since memory of the process that starts one counts as its own.
        writing = multiprocessing.Process(target=write, args=(files, options))
        writing.start()
        writing.join()
        if writing.exitcode != 0:
            sys.exit("readers.py: the files could not be written")
        print("kind        of each      " + "  ".join("      µs     MB" for _ in builds))
        for kind, file in files.items():
            each = options.points if kind in POINTS else options.products if kind == "ifc" else 2 * round(math.sqrt(options.triangles / 2)) ** 2
            if kind == "laz":
                with open(file, "rb") as laz:
                    each = struct.unpack_from("<Q", laz.read(375), 247)[0]
            seen = [[] for _ in builds]
            for _ in range(options.repeats):
                for k, build in enumerate(builds):
                    seen[k].append(run(command_of(build, kind, file)))
            best = [(min(one for one, _ in all_of), max(memory for _, memory in all_of)) for all_of in seen]
            print(f"{kind:11} {each:>9}    " + "  ".join(f"{1e6 * seconds / each:8.3f} {memory:6.0f}" for seconds, memory in best) +
                  (f"  {best[0][0] / best[1][0]:6.3f} of it" if len(best) == 2 else ""), flush=True)
    finally:
        shutil.rmtree(folder)


main()
