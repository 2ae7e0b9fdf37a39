# SPDX-License-Identifier: Apache-2.0
"""Why points are missed, what a round takes, and clouds in files."""
import os
import pickle
import struct
import tempfile
import unittest

import numpy as np
import vantage
from sites import BEFORE_EACH_WALL, four_walls_site


class AfterASearch(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.site = four_walls_site()
        cls.simulator = cls.site.simulator

    def test_missed_voxels_have_a_reason(self):
        seen = self.simulator.evaluate(BEFORE_EACH_WALL[:2], field=True)  # the walls in the north and south are not
        missed = vantage.why_missed(self.site, seen)
        self.assertEqual(missed.reasons,
                         ["captured", "hidden", "out_of_range", "too_flat", "too_dark", "too_sparse", "not_chosen"])
        np.testing.assert_array_equal(missed.points, seen.voxel_points[missed.voxels])
        np.testing.assert_array_equal(missed.why == 0, missed.points >= seen.goal_density)
        self.assertAlmostEqual(missed.shares[""]["captured"], seen.coverage, delta=1e-9)
        for name, shares in missed.shares.items():
            self.assertAlmostEqual(sum(shares.values()), 1, delta=1e-6, msg=name)
        self.assertEqual(set(missed.shares), {""} | {mesh.name for mesh in self.simulator.scene.meshes})
        self.assertGreater(missed.shares[""]["not_chosen"], 0.3)
        self.assertEqual(missed.candidates, 256)
        with self.assertRaisesRegex(vantage.Error, "evaluate with field=True"):
            vantage.why_missed(self.site, self.simulator.evaluate(BEFORE_EACH_WALL))

    def test_a_round_adds_up(self):
        options = vantage.OnSiteOptions(set_up_min=5, walking_m_per_s=1, entrance=(0, 0, 0))
        on_site = vantage.OnSite(self.site, options)
        visit = on_site.visit(BEFORE_EACH_WALL)
        self.assertEqual(sorted(visit.order), [0, 1, 2, 3])
        self.assertEqual(len(visit.legs_m), 5)
        self.assertAlmostEqual(sum(visit.legs_m), visit.walk_m)
        self.assertAlmostEqual(visit.walk_min, visit.walk_m / 60)
        self.assertAlmostEqual(visit.set_up_min, 4 * 5)
        self.assertAlmostEqual(visit.minutes, visit.scan_min + visit.set_up_min + visit.walk_min)
        straight = np.linalg.norm(np.subtract(BEFORE_EACH_WALL[0], BEFORE_EACH_WALL[2]))
        self.assertGreaterEqual(on_site.way_m((8, 0, 0), (0, 8, 0)), straight - 0.5)
        way = np.array(on_site.way((8, 0, 0), (0, 8, 0)))
        self.assertEqual((way[0].tolist(), way[-1].tolist()), ([8, 0, 0], [0, 8, 0]))
        self.assertAlmostEqual(np.linalg.norm(np.diff(way, axis=0), axis=1).sum(), on_site.way_m((8, 0, 0), (0, 8, 0)), delta=0.5)
        self.assertEqual((visit.day_min, visit.sessions), (0, []))
        day = visit.minutes * 0.7
        split = vantage.OnSite(self.site, vantage.OnSiteOptions(set_up_min=5, walking_m_per_s=1, entrance=(0, 0, 0), day_min=day, crews=2)).visit(BEFORE_EACH_WALL)
        self.assertEqual([(s.day, s.crew, s.parts, s.linked) for s in split.sessions], [(1, 1, 1, True), (1, 2, 1, True)])
        self.assertEqual(sum((s.order for s in split.sessions), []), split.order)
        self.assertTrue(all(s.minutes <= day for s in split.sessions))
        self.assertEqual(len(split.sessions[1].paths), len(split.sessions[1].order) + 1)
        with self.assertRaisesRegex(vantage.Error, "too short for one station"):
            vantage.OnSite(self.site, vantage.OnSiteOptions(day_min=1))
        with self.assertRaisesRegex(vantage.Error, "the model names none"):
            vantage.OnSite(self.site, vantage.OnSiteOptions(day_min=480, windows=["Hall*=06:00-08:00"]))
        with self.assertRaisesRegex(vantage.Error, "OnSiteOptions: windows: 'Hall' is no pattern"):
            vantage.OnSiteOptions(day_min=480, windows=["Hall"])
        at_six = vantage.OnSite(self.site, vantage.OnSiteOptions(set_up_min=5, day_min=480, day_start_min=360)).visit(BEFORE_EACH_WALL)
        self.assertEqual([(s.start_min, s.waiting_min) for s in at_six.sessions], [(360, 0)])
        self.assertEqual((at_six.bound, at_six.closed), (0, []))
        self.assertEqual((visit.batteries, split.batteries), ([], []))
        powered = vantage.Site(self.simulator.scene, scanners=[vantage.Scanner(azimuth_step_deg=2, zenith_step_deg=2, battery_scans=3)], user_size=0.5, engine="embree")
        for days, batteries, a_day in ((None, 2, 2), (day, 2, 2)):
            round = vantage.OnSite(powered, vantage.OnSiteOptions(set_up_min=5, walking_m_per_s=1, entrance=(0, 0, 0), day_min=days, crews=2 if days else 1)).visit(BEFORE_EACH_WALL)
            use, = pickle.loads(pickle.dumps(round)).batteries
            self.assertEqual((use.instrument, use.scans, use.battery_scans, use.batteries, use.in_a_day), ("custom", 4, 3, batteries, a_day))
        problem = vantage.SurveyProblem(objectives=["time"], on_site=options)
        self.assertEqual(problem.on_site.set_up_min, 5)

    def test_points_are_written_to_files(self):
        stations = [vantage.Station(BEFORE_EACH_WALL[0]), vantage.Station(BEFORE_EACH_WALL[2], active=False),
                    vantage.Station(BEFORE_EACH_WALL[3], vantage.StationSetup(heading_deg=40))]
        scans = [self.simulator.scan(station.position, setup=station.setup, place=place)
                 for place, station in enumerate(stations) if station.active]
        expected = np.concatenate([scan.position for scan in scans])
        with tempfile.TemporaryDirectory() as folder:
            ply, las, e57 = (os.path.join(folder, "cloud." + kind) for kind in ("ply", "las", "e57"))
            self.assertEqual(vantage.write_point_cloud(ply, self.simulator, stations, outputs=[]), len(expected))
            with open(ply, "rb") as file:
                header, body = file.read().split(b"end_header\n", 1)
            self.assertIn(f"element vertex {len(expected)}\n".encode(), header)
            row = len(body) // len(expected)
            self.assertIn(b"\ncomment origin 0 0 0\n", header)
            first = struct.unpack_from("<3f", body)
            last = struct.unpack_from("<3f", body, row * (len(expected) - 1))
            np.testing.assert_allclose([first, last], [expected[0], expected[-1]], atol=1e-4)
            vantage.write_point_cloud(ply, self.simulator, stations, outputs=[], doubles=True)
            with open(ply, "rb") as file:
                header, body = file.read().split(b"end_header\n", 1)
            self.assertIn(b"\nproperty double x\n", header)
            np.testing.assert_allclose(struct.unpack_from("<3d", body), expected[0], atol=1e-4)
            for file in (las, e57):
                count = vantage.write_point_cloud(file, self.simulator, stations, crs="EPSG:25832")
                self.assertEqual(count, len(expected))
            with open(las, "rb") as file:
                head = file.read(375)
            self.assertEqual(head[:4], b"LASF")
            self.assertEqual(struct.unpack_from("<Q", head, 247)[0], len(expected))
            with open(e57, "rb") as file:
                self.assertEqual(file.read(8), b"ASTM-E57")
            stopped = os.path.join(folder, "stopped.las")
            self.assertEqual(
                vantage.write_point_cloud(stopped, self.simulator, stations, progress=lambda done: False), 0)
            self.assertFalse(os.path.exists(stopped))
            with self.assertRaisesRegex(vantage.Error, "extension"):
                vantage.write_point_cloud(os.path.join(folder, "cloud.xyz"), self.simulator, stations)


if __name__ == "__main__":
    unittest.main()
