#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""measure_noise.py gives the noise that simulated scans were made with."""
import json
import os
import struct
import tempfile
import unittest

import numpy as np

import measure_noise
import scan_files

WALLS = np.array([4.0, 3.0, 1.8])  # half the length, width and height of a room, the scanner in its middle


def room(sigma, seed=1, offsets=0.0, correlation=0.0, step=0.0, rows=24, columns=900, reflectivity=None, walls=WALLS):
    """A scan of 24 rows by default; `sigma` is a function of range and reflectivity of each ray, in metres."""
    random = np.random.default_rng(seed)
    elevation = np.radians(np.linspace(-20, 20, rows))[:, None] + np.zeros(columns)
    azimuth = 2 * np.pi * (np.arange(columns) + 0.5)[None] / columns + np.zeros((rows, 1))
    rays = np.stack([np.cos(azimuth) * np.cos(elevation), np.sin(azimuth) * np.cos(elevation), np.sin(elevation)], -1)
    ranges = (walls / np.abs(rays)).min(axis=-1)
    bright = np.ones_like(ranges) if reflectivity is None else reflectivity(azimuth)
    white = random.standard_normal((rows, columns))
    noise = white.copy()
    for column in range(1, columns):
        noise[:, column] = correlation * noise[:, column - 1] + np.sqrt(1 - correlation ** 2) * white[:, column]
    measured = ranges + sigma(ranges, bright) * noise + offsets * random.standard_normal((rows, 1))
    if step:
        measured = step * np.round(measured / step)
    points = (measured[..., None] * rays).reshape(-1, 3)
    return scan_files.Scan(points, np.zeros_like(points), bright.ravel(), np.repeat(np.arange(rows), columns))


def measured(*scans, **changes):
    settings = measure_noise.parse(["-"])
    for name, value in changes.items():
        setattr(settings, name, value)
    return measure_noise.measure(scans, settings)


def middle(patches, name):
    return measure_noise.median_and_error([getattr(patch, name) for patch in patches])[0]


class MeasureNoise(unittest.TestCase):
    def test_white_noise(self):
        for sigma in (0.0005, 0.02):
            patches = measured(room(lambda r, i, s=sigma: s))
            self.assertGreater(len(patches), 200)
            self.assertAlmostEqual(middle(patches, "sigma") / sigma, 1, delta=0.04)
            self.assertAlmostEqual(middle(patches, "neighbours") / sigma, 1, delta=0.04)
            self.assertAlmostEqual(middle(patches, "correlation"), 0, delta=0.07)
            self.assertAlmostEqual(middle(patches, "blocks"), 1, delta=0.05)
            offsets, by_noise, _ = measure_noise.repeated_offsets(patches)
            self.assertLess(offsets, by_noise)

    def test_powers_of_range_and_intensity(self):
        scan = room(lambda r, i: 0.001 * r ** 0.8 * i ** -0.5, columns=1800, walls=np.array([8, 3, 1.8]),
                    reflectivity=lambda azimuth: np.where(np.sin(8 * azimuth) > 0, 0.9, 0.1))
        powers = measure_noise.exponents(measured(scan))
        self.assertAlmostEqual(powers["range"][0], 0.8, delta=0.15)
        self.assertAlmostEqual(powers["intensity"][0], -0.5, delta=0.05)
        self.assertLess(abs(powers["range"][0] - 0.8), 4 * powers["range"][1])

    def test_power_of_equal_ranges_is_not_known(self):
        self.assertIsNone(measure_noise.exponents(measured(room(lambda r, i: 0.001)))["intensity"])

    def test_correlated_neighbours(self):
        patches = measured(room(lambda r, i: 0.003, correlation=0.6), points=200)
        self.assertAlmostEqual(middle(patches, "correlation"), 0.6, delta=0.1)
        self.assertLess(middle(patches, "neighbours"), 0.75 * middle(patches, "sigma"))
        self.assertGreater(middle(patches, "blocks"), 1.2)

    def test_offsets_of_beams(self):
        patches = measured(room(lambda r, i: 0.002, offsets=0.006), points=200)
        offsets, by_noise, beams = measure_noise.repeated_offsets(patches)
        self.assertAlmostEqual(offsets / 0.006, 1, delta=0.25)
        self.assertLess(by_noise, 0.002)
        self.assertEqual(beams, 24)
        self.assertAlmostEqual(middle(patches, "neighbours") / 0.002, 1, delta=0.1)
        self.assertGreater(middle(patches, "sigma"), 0.003)

    def test_steps_of_ranges(self):
        self.assertEqual(measure_noise.step_of_ranges(room(lambda r, i: 0.003, step=0.004)), "ranges in steps of 4 mm")
        self.assertEqual(measure_noise.step_of_ranges(room(lambda r, i: 0.003)), "no step of ranges shows")
        scan = room(lambda r, i: 0.003)
        scan.points = np.round(scan.points, 3)
        self.assertEqual(measure_noise.step_of_ranges(scan), "coordinates in steps of 1 mm")

    def test_leaves_and_stray_points_are_left_out(self):
        scan, random = room(lambda r, i: 0.002), np.random.default_rng(2)
        leaves = np.arctan2(scan.points[:, 1], scan.points[:, 0]) > 1
        scan.points[leaves] *= random.uniform(0.5, 0.9, leaves.sum())[:, None]
        stray = random.random(len(scan.points)) < 0.01
        scan.points[stray] *= 0.8
        patches = measured(scan)
        self.assertGreater(len(patches), 80)
        self.assertAlmostEqual(middle(patches, "sigma") / 0.002, 1, delta=0.05)

    def test_curves_are_left_out(self):
        scan = room(lambda r, i: 0.0005)
        ranges, rays = scan.rays()
        scan.points = rays * (3 + (ranges - (WALLS / np.abs(rays)).min(axis=1)))[:, None]  # a sphere
        self.assertEqual(len(measured(scan, points=200)), 0)

    def test_bends_are_told_from_offsets_of_beams(self):
        random = np.random.default_rng(3)
        row = np.repeat(np.arange(4), 15)
        angles = np.column_stack([np.tile(np.linspace(-1, 1, 15), 4), row])

        def bent(curve, offsets):
            surface = curve * angles[:, 0] ** 2 + offsets * row ** 2
            tried = (surface + random.standard_normal(60) for _ in range(100))
            return np.mean([measure_noise.is_bent(e, angles, row) for e in tried])

        self.assertLess(bent(0, 0), 0.08)
        self.assertLess(bent(0, 3), 0.08)
        self.assertGreater(bent(3, 0), 0.9)
        self.assertTrue(measure_noise.is_bent(random.standard_normal(12), angles[::5], None))

    def test_rays_from_an_arm(self):
        """The ranges of an Ouster begin on a circle about its axis."""
        scan = room(lambda r, i: 0.003)
        ranges, rays = scan.rays()
        noise = ranges - (WALLS / np.abs(rays)).min(axis=1)
        scan.origins = 0.03 * rays * [1, 1, 0]
        reach = ((WALLS - scan.origins * np.sign(rays)) / np.abs(rays)).min(axis=1)
        scan.points = scan.origins + rays * (reach + noise)[:, None]
        self.assertAlmostEqual(middle(measured(scan), "sigma") / 0.003, 1, delta=0.04)


class Files(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.points = np.array([[1, 2, 3, 10], [-4, 5.5, 6, 20], [0.25, 0, 9, 30]])

    def check(self, name, content, **options):
        path = os.path.join(self.folder.name, name)
        with open(path, "wb") as file:
            file.write(content)
        scan = scan_files.read(path, **options)
        np.testing.assert_array_equal(scan.points, self.points[:, :3])
        np.testing.assert_array_equal(scan.intensity, self.points[:, 3])

    def test_pcd_ply_text(self):
        text = "\n".join(" ".join(map(str, line)) for line in self.points)
        binary = self.points.astype("<f4").tobytes()
        # Some drivers write a width and a height of 0.
        pcd = ("# .PCD v0.7\nVERSION 0.7\nFIELDS x y z intensity\nSIZE 4 4 4 4\nTYPE F F F F\nCOUNT 1 1 1 1\n"
               "WIDTH 0\nHEIGHT 0\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS 3\nDATA ")
        self.check("a.pcd", (pcd + "ascii\n" + text).encode())
        self.check("b.pcd", (pcd + "binary\n").encode() + binary)
        ply = "".join(f"property float {name}\n" for name in ("x", "y", "z", "intensity"))
        head = f"ply\nformat binary_little_endian 1.0\nelement vertex 3\n{ply}end_header\n"
        self.check("c.ply", head.encode() + binary)
        self.check("d.txt", ("//X Y Z R G B Intensity\n" + text).encode())

    def test_packets_of_an_ouster(self):
        """One column ahead, of two beams 30 degrees up and down: 10 m from the axis, of which the arm is 1 m."""
        sensor = os.path.join(self.folder.name, "sensor.json")
        with open(sensor, "w", encoding="utf-8") as file:
            json.dump({"beam_altitude_angles": [30, -30], "beam_azimuth_angles": [0, 90], "lidar_mode": "1024x10",
                       "lidar_origin_to_beam_origin_mm": 1000}, file)
        legacy = b"".join(struct.pack("<QHHI", 0, 0, 7, 0) + struct.pack("<IHHHH", 10000, 5, 0, 0, 0) * 2
                          + struct.pack("<I", 0xFFFFFFFF if k == 0 else 0) for k in range(16))
        low_rate = b"".join(struct.pack("<QHH", 0, 0, 1 if k == 0 else 0) + struct.pack("<HBB", 1250, 5, 0) * 2
                            for k in range(16))
        for payload in (legacy, bytes(32) + low_rate + bytes(32)):
            path, size = os.path.join(self.folder.name, "a.pcap"), 42 + len(payload)
            with open(path, "wb") as file:
                file.write(bytes(24) + struct.pack("<IIII", 0, 0, size, size) + bytes(42) + payload)
            scan = scan_files.read(path, sensor=sensor)
            high = 9 * np.sqrt(3) / 2
            np.testing.assert_allclose(scan.points, [[1 + high, 0, 4.5], [1, -high, -4.5]], atol=1e-12)
            np.testing.assert_allclose(scan.rays()[0], [9, 9])
            np.testing.assert_array_equal(scan.intensity, [5, 5])


if __name__ == "__main__":
    unittest.main()
