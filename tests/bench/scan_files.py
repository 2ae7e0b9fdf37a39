# SPDX-License-Identifier: Apache-2.0
"""Scans of other people's scanners as arrays, for measure_noise.py: points in metres about the scanner, where each ray
began, and intensities and numbers of beams if the file has them."""
import dataclasses
import json
import pathlib
import re

import numpy as np


@dataclasses.dataclass
class Scan:
    points: np.ndarray  # n x 3, about the scanner
    origins: np.ndarray  # n x 3; zero if all rays begin in one place
    intensity: np.ndarray | None = None
    row: np.ndarray | None = None  # number of the beam

    def rays(self):
        """Ranges and unit directions."""
        along = self.points - self.origins
        ranges = np.linalg.norm(along, axis=1)
        return ranges, along / np.maximum(ranges, 1e-9)[:, None]

    def subset(self, which):
        return Scan(self.points[which], self.origins[which], None if self.intensity is None else self.intensity[which],
                    None if self.row is None else self.row[which])


def read(path, origin=(0, 0, 0), sensor=None):
    """`sensor` is the description beside packets of an Ouster."""
    end = pathlib.Path(path).suffix.lower()
    if end == ".pcap":
        return read_ouster(path, sensor)
    fields = {".pcd": read_pcd, ".ply": read_ply}.get(end, read_text)(path)
    points = np.column_stack([fields[axis] for axis in "xyz"]).astype(float) - origin
    intensity, row = (next((fields[name] for name in names if name in fields), None)
                      for names in (("intensity", "reflectivity"), ("ring", "channel")))
    return Scan(points, np.zeros_like(points), intensity, row)


def read_pcd(path):
    content = pathlib.Path(path).read_bytes()
    at = content.index(b"\nDATA ") + 1
    end = content.index(b"\n", at)
    head = dict(line.split(None, 1) for line in content[:at].decode().splitlines() if line and line[0] != "#")
    names, kind = head["FIELDS"].split(), content[at + 5:end].decode().strip()
    if kind == "ascii":
        return dict(zip(names, np.loadtxt(content[end:].decode().splitlines(), ndmin=2).T))
    if kind != "binary":
        raise SystemExit(f"{path}: PCD of the kind {kind} is not read")
    types = ["<" + letter.lower() + size for letter, size in zip(head["TYPE"].split(), head["SIZE"].split())]
    return columns(content, end + 1, names, types, int(head["POINTS"]))


def read_ply(path):
    content = pathlib.Path(path).read_bytes()
    end = content.index(b"end_header")
    head = content[:end].decode()
    if "binary_little_endian" not in head:
        raise SystemExit(f"{path}: PLY other than binary_little_endian is not read")
    letters = {"float": "<f4", "double": "<f8", "uchar": "u1", "ushort": "<u2", "uint": "<u4", "int": "<i4"}
    kinds, names = zip(*re.findall(r"^property (\w+) (\w+)", head, re.M))
    return columns(content, content.index(b"\n", end) + 1, names, [letters[kind] for kind in kinds],
                   int(re.search(r"^element vertex (\d+)", head, re.M)[1]))


def columns(content, start, names, types, count):
    records = np.frombuffer(content, np.dtype(list(zip(names, types))), count, start)
    return {name: records[name].astype(float) for name in names}


def read_text(path):
    """Columns x y z, and intensity as the last one if there are more."""
    table = np.loadtxt(path, comments=("#", "//"), ndmin=2)
    return dict(zip("xyz", table.T)) | ({"intensity": table[:, -1]} if table.shape[1] > 3 else {})


def read_ouster(path, sensor):
    """The fullest turn in UDP packets of an Ouster, of its profiles LEGACY and RNG15_RFL8_NIR8."""
    about = json.loads(pathlib.Path(sensor).read_text(encoding="utf-8"))
    elevation, offset = (np.radians(about[name]) for name in ("beam_altitude_angles", "beam_azimuth_angles"))
    arm, turn = about.get("lidar_origin_to_beam_origin_mm", 15.806) / 1000, int(about["lidar_mode"].split("x")[0])
    pixel = [("range", "<u4"), ("reflectivity", "<u2"), ("signal", "<u2"), ("ambient", "<u2"), ("none", "<u2")]
    legacy = np.dtype([("time", "<u8"), ("column", "<u2"), ("frame", "<u2"), ("encoder", "<u4"),
                       ("pixel", pixel, len(elevation)), ("status", "<u4")])
    pixel = [("range", "<u2"), ("reflectivity", "u1"), ("ambient", "u1")]
    low_rate = np.dtype([("time", "<u8"), ("column", "<u2"), ("status", "<u2"), ("pixel", pixel, len(elevation))])

    content, at, turns = pathlib.Path(path).read_bytes(), 24, {}
    while at + 16 <= len(content):
        size = int.from_bytes(content[at + 8:at + 12], "little")
        payload = content[at + 16 + 42:at + 16 + size]  # behind Ethernet, IP and UDP
        at += 16 + size
        if len(payload) == 16 * legacy.itemsize:
            block, unit = np.frombuffer(payload, legacy), 0.001
            frame, ranges = block["frame"][0], unit * (block["pixel"]["range"] & 0xFFFFF)
        elif len(payload) == 64 + 16 * low_rate.itemsize:
            block, unit = np.frombuffer(payload, low_rate, 16, 32), 0.008
            frame, ranges = int.from_bytes(payload[2:4], "little"), unit * (block["pixel"]["range"] & 0x7FFF)
        else:
            continue
        good = block["status"] & 1 == 1
        turns.setdefault(frame, []).append((block["column"][good], ranges[good], block["pixel"]["reflectivity"][good]))
    if not turns:
        raise SystemExit(f"{path} holds no packet of {len(elevation)} beams in the profiles LEGACY and RNG15_RFL8_NIR8")
    column, ranges, reflectivity = (np.concatenate(part) for part in zip(*max(turns.values(), key=len)))

    ahead = -2 * np.pi * column[:, None] / turn + np.zeros(ranges.shape)
    azimuth, level = ahead - offset, np.zeros(ranges.shape)
    centre = arm * np.stack([np.cos(ahead), np.sin(ahead), level], axis=-1)
    flat = np.cos(elevation)
    ray = np.stack([flat * np.cos(azimuth), flat * np.sin(azimuth), np.sin(elevation) + level], axis=-1)
    met = ranges > 0
    return Scan((centre + (ranges - arm)[..., None] * ray)[met], centre[met], reflectivity[met].astype(float),
                np.broadcast_to(np.arange(len(elevation)), met.shape)[met])
