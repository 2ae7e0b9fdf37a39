# SPDX-License-Identifier: Apache-2.0
import gc
import pickle
import tempfile
import unittest
from pathlib import Path

import numpy as np
import vantage
from sites import wall

DIFFUSE = 0.6


def scan_of_wall(offset=(0.0, 0.0, 0.0), **options):
    scene = vantage.Scene.from_triangles(*wall(offset), diffuse=DIFFUSE)
    scanner = vantage.Scanner(azimuth_step_deg=0.5, zenith_step_deg=0.5)
    return scanner, vantage.Simulator(scene, scanner, engine="embree").scan(offset, **options)


def pattern(scanner):
    """Directions in the scanner's frame: (rows, columns, 3)."""
    zenith = np.radians((np.arange(scanner.rows) + 0.5) * scanner.zenith_step_deg)[:, None]
    azimuth = np.radians(-180 + (np.arange(scanner.columns) + 0.5) * scanner.azimuth_step_deg)[None, :]
    return np.stack(np.broadcast_arrays(
        np.sin(zenith) * np.cos(azimuth), np.sin(zenith) * np.sin(azimuth), np.cos(zenith)), axis=-1)


class Scans(unittest.TestCase):
    def test_a_wall_has_the_points_of_the_pattern(self):
        """Against the closed form: ray (i, j) hits the plane y = 3 at 3 / (sin zenith sin azimuth)."""
        outputs = ["position", "normal", "reflectivity", "mesh", "primitive", "colour", "voxel"]
        scanner, scan = scan_of_wall(outputs=outputs)
        rays = pattern(scanner)
        with np.errstate(divide="ignore"):
            at = 3 / rays[..., 1]
        points = rays * at[..., None]
        expected = (at > 0) & (np.abs(points[..., 0]) <= 2) & (np.abs(points[..., 2]) <= 1)

        self.assertEqual(scan.rays, scanner.rays)
        self.assertEqual(scan.points, expected.sum())
        self.assertEqual(len(scan), scan.points)
        row, column = np.nonzero(expected)
        np.testing.assert_array_equal(scan.row, row)
        np.testing.assert_array_equal(scan.column, column)
        np.testing.assert_allclose(scan.range_m, at[expected], rtol=1e-5)
        np.testing.assert_allclose(scan.position, points[expected], atol=1e-5)
        np.testing.assert_allclose(scan.normal, np.tile([0, -1, 0], (len(scan), 1)), atol=1e-6)
        np.testing.assert_allclose(scan.reflectivity, DIFFUSE * rays[expected][:, 1], atol=1e-5)
        np.testing.assert_array_equal(scan.mesh, 0)
        np.testing.assert_array_equal(np.unique(scan.primitive), [0, 1])
        self.assertEqual(scan.colour.view("u1").reshape(-1, 4).shape, (len(scan), 4))

    def test_a_grid_has_the_same_points(self):
        scanner, points = scan_of_wall()
        _, grid = scan_of_wall(grid=True)
        self.assertEqual(grid.position.shape, (scanner.rows, scanner.columns, 3))
        self.assertEqual(grid.range_m.shape, (scanner.rows, scanner.columns))
        hit = np.isfinite(grid.range_m)
        np.testing.assert_array_equal(grid.row[hit], points.row)
        np.testing.assert_array_equal(grid.column[hit], points.column)
        np.testing.assert_array_equal(grid.position[hit], points.position)
        self.assertTrue(np.isnan(grid.position[~hit]).all())

    def test_a_beam_with_a_width_has_returns(self):
        """A wall before another: at its edges rays have two returns, and a short step makes points in between."""
        corners, triangles = wall()
        back = np.array(corners) * 4 - (0, 5, 0)
        scene = vantage.Scene.from_triangles(np.vstack([corners, back]), np.vstack([triangles, np.array(triangles) + 4]))
        scanner = vantage.Scanner(azimuth_step_deg=0.5, zenith_step_deg=0.5, beam_divergence_mrad=4, exit_diameter_mm=5)
        simulator = vantage.Simulator(scene, scanner, engine="embree")
        beam = vantage.BeamOptions(returns="all", sub_rays=19)
        self.assertEqual((beam.returns, beam.sub_rays, beam.pulse_m), ("all", 19, 1))
        scan = simulator.scan((0, 0, 0), ["position", "returns", "voxel", "ghost"], beam=beam)
        self.assertTrue((scan.return_number <= scan.returns).all())
        self.assertGreater((scan.return_number == 2).sum(), 50)
        self.assertEqual((scan.return_number == 2).sum(), ((scan.return_number == 1) & (scan.returns == 2)).sum())
        self.assertEqual(scan.ghost.sum(), 0)
        y = scan.position[:, 1]  # of half a footprint on a wall that is not met squarely, the middle lies elsewhere
        off = (np.abs(y - 3) > 0.005) & (np.abs(y - 7) > 0.005)
        self.assertEqual(scan.mixed[0], off.sum())
        self.assertLess(np.abs(y[off] - 7).max(), 0.02)
        merged = vantage.BeamOptions(pulse_m=10)
        scan = simulator.scan((0, 0, 0), ["position", "voxel"], beam=merged)
        between = (scan.position[:, 1] > 3.005) & (scan.position[:, 1] < 6.995)
        self.assertEqual(scan.mixed[0], between.sum())
        self.assertGreater(scan.mixed[0], 20)
        found = simulator.evaluate([(0, 0, 0)], beam=merged)
        np.testing.assert_array_equal(found.mixed, [scan.mixed])
        self.assertEqual(found.points_on_surveyed[0], (scan.voxel != 2**32 - 1).sum())
        self.assertEqual(found.to_dict()["mixed"]["points"], scan.mixed[0])
        with self.assertRaisesRegex(vantage.Error, "beam=BeamOptions"):
            simulator.evaluate([(0, 0, 0)]).mixed
        with self.assertRaisesRegex(vantage.Error, "grid"):
            simulator.scan((0, 0, 0), grid=True, beam=beam)

    def test_a_turned_scanner_of_its_own_has_its_pattern_turned(self):
        """Against the closed form once more, with the rotation made from its definition, Rz(heading) Ry(tilt)."""
        coarse, fine = vantage.Scanner(), vantage.Scanner(azimuth_step_deg=0.4, zenith_step_deg=0.5)
        coarse.azimuth_step_deg = coarse.zenith_step_deg = 1
        scene = vantage.Scene.from_triangles(*wall())
        simulator = vantage.Simulator(scene, [coarse, fine], engine="embree")
        self.assertEqual([s.azimuth_step_deg for s in simulator.scanners], [1, 0.4])
        setup = vantage.StationSetup(heading_deg=25, tilt_deg=70, scanner=1)
        scan = simulator.scan((0, 0, 0), setup=setup, grid=True)
        heading, tilt = np.radians([25, 70])
        about_z = [[np.cos(heading), -np.sin(heading), 0], [np.sin(heading), np.cos(heading), 0], [0, 0, 1]]
        about_y = [[np.cos(tilt), 0, np.sin(tilt)], [0, 1, 0], [-np.sin(tilt), 0, np.cos(tilt)]]
        turn = np.array(about_z) @ about_y
        np.testing.assert_allclose(setup.survey_from_scanner(), turn, atol=1e-12)
        rays = pattern(fine) @ turn.T
        self.assertEqual(scan.range_m.shape, rays.shape[:2])
        with np.errstate(divide="ignore"):
            at = 3 / rays[..., 1]
        points = rays * at[..., None]
        margin = np.maximum(np.abs(points[..., 0]) - 2, np.abs(points[..., 2]) - 1)
        inside, outside = (at > 0) & (margin < -1e-4), (at < 0) | (margin > 1e-4)
        self.assertGreater(inside.sum(), 1000)
        np.testing.assert_allclose(scan.range_m[inside], at[inside], rtol=1e-5)
        np.testing.assert_allclose(scan.position[inside], points[inside], atol=1e-5)
        self.assertTrue(np.isinf(scan.range_m[outside]).all())
        with self.assertRaisesRegex(vantage.Error, "scanner number 2"):
            simulator.scan((0, 0, 0), setup=vantage.StationSetup(scanner=2))

    def test_georeferenced_positions_keep_their_digits(self):
        utm = (389_123.25, 5_820_456.5, 35.0)
        _, near = scan_of_wall()
        _, far = scan_of_wall(utm)
        self.assertEqual(far.position.dtype, np.float64)
        np.testing.assert_allclose(far.position - utm, near.position, atol=1e-5)

    def test_arrays_are_no_copies_and_outlive_the_scan(self):
        _, scan = scan_of_wall()
        positions, ranges = scan.position, scan.range_m
        self.assertFalse(positions.flags.writeable or positions.flags.owndata)
        self.assertTrue(np.shares_memory(positions, scan.position))
        before = positions.copy(), ranges.copy()
        del scan
        gc.collect()
        np.testing.assert_array_equal(positions, before[0])
        np.testing.assert_array_equal(ranges, before[1])

    def test_what_was_not_asked_for_says_so(self):
        _, scan = scan_of_wall(outputs=[])
        self.assertGreater(len(scan.range_m), 0)
        with self.assertRaisesRegex(vantage.Error, "position: was not asked for"):
            scan.position
        with self.assertRaisesRegex(vantage.Error, "outputs: there is no 'colur'; there are position, normal"):
            scan_of_wall(outputs=["colur"])
        simulator = vantage.Simulator(vantage.Scene.from_triangles(*wall()), vantage.Scanner(), engine="embree")
        with self.assertRaises(vantage.Error) as raised:
            simulator.scan((np.nan, 0, 0))
        self.assertEqual(raised.exception.code, "invalid_argument")


class OwnPatterns(unittest.TestCase):
    def scan(self, **members):
        scene = vantage.Scene.from_triangles(*wall(), diffuse=DIFFUSE)
        scanner = vantage.Scanner(**members)
        return scanner, vantage.Simulator(scene, scanner, engine="embree").scan([0, 0, 0], ["position"])

    def check(self, azimuth, zenith, scan):
        """Against the closed form: a ray hits the plane y = 3 at 3 / (sin zenith sin azimuth)."""
        rays = np.column_stack([np.sin(zenith) * np.cos(azimuth), np.sin(zenith) * np.sin(azimuth), np.cos(zenith)])
        with np.errstate(divide="ignore"):
            at = 3 / rays[:, 1]
        points = rays * at[:, None]
        hits = (at > 0) & (np.abs(points[:, 0]) <= 2) & (np.abs(points[:, 2]) <= 1)
        self.assertGreater(hits.sum(), 20)
        np.testing.assert_allclose(scan.position, points[hits], atol=1e-5)
        return np.nonzero(hits)[0]

    def test_uneven_rows(self):
        zeniths = [71.3, 72, 77, 88.9, 89, 89.2, 104, 130]
        scanner, scan = self.scan(azimuth_step_deg=0.5, row_zeniths_deg=zeniths)
        self.assertEqual((scanner.rows, scanner.columns), (8, 720))
        self.assertAlmostEqual(scanner.zenith_start_deg, 71.3)
        self.assertAlmostEqual(scanner.zenith_step_deg, 58.7 / 7)
        np.testing.assert_allclose(scanner.row_zeniths_deg, zeniths)
        azimuth, zenith = np.meshgrid(np.radians(-180 + (np.arange(720) + 0.5) * 0.5), np.radians(zeniths))
        rays = self.check(azimuth.ravel(), zenith.ravel(), scan)
        np.testing.assert_array_equal(scan.row, rays // 720)
        with self.assertRaisesRegex(vantage.Error, "above the zenith before it"):
            vantage.Scanner(row_zeniths_deg=[3, 2]).check()

    def test_directions_in_their_order(self):
        angle = 0.37 * np.arange(5000)
        directions = np.column_stack([90 + 40 * np.sin(angle), 30 * np.sin(0.713 * angle)])
        times = 1e-5 * np.arange(5000)
        scanner, scan = self.scan(directions_deg=directions, times_s=times)
        self.assertEqual((scanner.rows, scanner.columns), (5000, 1))
        np.testing.assert_allclose(scanner.directions_deg, directions)
        rays = self.check(np.radians(directions[:, 0]), np.radians(90 - directions[:, 1]), scan)
        np.testing.assert_array_equal(scan.row, rays)
        copy = pickle.loads(pickle.dumps(scanner))
        np.testing.assert_array_equal(copy.times_s, times)
        np.testing.assert_allclose(copy.directions_deg, directions)
        for wrong, says in [({"directions_deg": [1, 2]}, "shape"), ({"times_s": [1.0]}, "without directions"),
                            ({"directions_deg": [[0, 91]]}, "zenith in degrees is -1")]:
            with self.assertRaisesRegex(vantage.Error, says):
                vantage.Scanner(**wrong).check()

    def test_a_file_of_directions(self):
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "rosette.csv"
            file.write_text("azimuth_deg,elevation_deg,time_s\n1,2,0\n3,-4,0.5\n")
            directions, times = vantage.load_directions(file)
            np.testing.assert_allclose(directions, [[1, 2], [3, -4]])
            np.testing.assert_array_equal(times, [0, 0.5])
            file.write_text("azimuth_deg,elevation_deg\n1,2\n")
            self.assertIsNone(vantage.load_directions(file)[1])


class Scanners(unittest.TestCase):
    def test_members_go_in_and_come_out(self):
        scanner = vantage.Scanner(azimuth_step_deg=0.2, max_range_m=40)
        self.assertEqual((scanner.azimuth_step_deg, scanner.max_range_m), (0.2, 40))
        scanner.zenith_step_deg = 0.3
        self.assertEqual((scanner.rows, scanner.columns, scanner.rays), (500, 1800, 900_000))
        self.assertEqual(scanner.to_dict()["max_range_m"], 40)
        noise = {"distances_m": [10, 50], "reflectivities": [0.1, 0.5, 0.9], "sigma_m": np.full((3, 2), 1e-3)}
        scanner.noise = noise
        np.testing.assert_array_equal(scanner.noise["sigma_m"], noise["sigma_m"])
        scanner.noise = None
        self.assertIsNone(scanner.noise)
        scanner.max_range_m = -1
        with self.assertRaisesRegex(vantage.Error, "-1"):
            scanner.check()

    def test_presets_are_found_by_name(self):
        self.assertIn("rtc360", dict(vantage.scanners()))
        self.assertLess(vantage.Scanner.load("rtc360@3mm").azimuth_step_deg,
                        vantage.Scanner.load("rtc360@6mm").azimuth_step_deg)
        with self.assertRaises(vantage.Error):
            vantage.Scanner.load("nobodys")

    def test_engines_are_listed(self):
        engines = {info.engine: info for info in vantage.list_engines()}
        self.assertTrue(engines["embree"].usable)


if __name__ == "__main__":
    unittest.main()
