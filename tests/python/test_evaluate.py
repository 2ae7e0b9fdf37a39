# SPDX-License-Identifier: Apache-2.0
import concurrent.futures
import sys
import threading
import time
import unittest

import numpy as np
import vantage
from sites import BEFORE_EACH_WALL, COARSE, FOUR_WALLS, four_walls, program_json

HEADS = [[8, 0, 1.5], [9, 8, 1.5], [0, 12, 1.5]]  # none sees the walls in the south and the west



class Evaluations(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.simulator = four_walls()

    def test_measures_are_those_of_the_counts_in_numpy(self):
        """Coverage (equation 8) and overlaps (equation 11) once more, from the count and the mask of every voxel."""
        found = self.simulator.evaluate(HEADS, field=True)
        share = np.minimum(found.voxel_points / self.simulator.goal_density, 1)
        self.assertAlmostEqual(found.coverage, share.mean(), places=12)
        self.assertTrue(((share > 0) & (share < 1)).any() and (share == 1).any())
        sees = (found.voxel_stations[:, None] >> np.arange(3, dtype=np.uint64)) & np.uint64(1)
        both = sees.T @ sees
        np.testing.assert_array_equal(found.shared, both)
        np.testing.assert_array_equal(found.seen, np.diag(both))
        seen = np.diag(both).astype(float)
        apart = 1 - np.eye(3)
        np.testing.assert_allclose(found.overlap_matrix, apart * both / (seen[:, None] + seen - both), rtol=1e-12)
        self.assertEqual((found.coverage_se, found.overlap_se), (0, 0))
        self.assertEqual(found.connectivity().parts, 1)
        self.assertEqual(found.points_on_surveyed.sum(), found.voxel_points.sum())

    def test_the_program_says_the_same(self):
        found = self.simulator.evaluate(HEADS, skip=False, surroundings=True).to_dict()
        stations = [part for head in HEADS for part in ("--station", ",".join(map(str, head)))]
        told = program_json("evaluate", FOUR_WALLS, *COARSE, *stations)
        for key in ("coverage", "overlap", "overlap_matrix", "scan_overlap_matrix", "voxels", "goal_density", "rays", "dropped"):
            self.assertEqual(found[key], told[key], key)
        self.assertEqual(found["points"], [station["points"] for station in told["stations"]])

    def test_each_station_is_set_up_as_it_says(self):
        fine = vantage.Scanner(azimuth_step_deg=0.2, zenith_step_deg=0.2, height_m=1.5)
        rough = vantage.Scanner(azimuth_step_deg=0.5, zenith_step_deg=0.5, height_m=1.5)
        simulator = vantage.Simulator(self.simulator.scene, [fine, rough], engine="embree", user_size_m=0.2,
                                      point_spacing_m=0.03)
        lying = vantage.StationSetup(heading_deg=30, tilt_deg=90)
        network = [vantage.Station(HEADS[0]), vantage.Station(HEADS[1], lying),
                   vantage.Station(HEADS[2], vantage.StationSetup(scanner=1)),
                   vantage.Station(BEFORE_EACH_WALL[1], lying, active=False)]
        found = simulator.evaluate(network)
        told = program_json("evaluate", FOUR_WALLS, *COARSE, "--station", "8,0,1.5", "--station",
                            "x=9,y=8,z=1.5,heading=30,tilt=90", "--station", "x=0,y=12,z=1.5,step=0.5")
        self.assertEqual(found.coverage, told["coverage"])
        self.assertEqual(found.points_on_surveyed.tolist()[3], 0)
        usual = self.simulator.evaluate(HEADS).points_on_surveyed
        self.assertEqual([int(found.points_on_surveyed[k]) == int(usual[k]) for k in range(3)], [True, False, False])
        placed = vantage.place_heads(vantage.Site(simulator.scene, height=1.5), network[:3])
        self.assertEqual([station.setup for station in placed], [station.setup for station in network[:3]])
        self.assertEqual(simulator.evaluate(placed).coverage, found.coverage)
        sampled, = simulator.evaluate_sampled([network], voxels=simulator.voxel_count)
        self.assertEqual(sampled.coverage, found.coverage)
        with self.assertRaisesRegex(TypeError, "none of the kind"):
            simulator.evaluate([network[0], placed[0]])

    def test_a_sample_of_all_voxels_is_exact(self):
        exact = self.simulator.evaluate(HEADS)
        all_voxels, some = [
            self.simulator.evaluate_sampled([BEFORE_EACH_WALL, HEADS], voxels=voxels)[1]
            for voxels in (self.simulator.voxel_count, 500)]
        self.assertEqual(all_voxels.coverage, exact.coverage)
        np.testing.assert_array_equal(all_voxels.shared, exact.shared)
        self.assertEqual(some.sample, 500)
        self.assertGreater(some.coverage_se, 0)
        self.assertLess(abs(some.coverage - exact.coverage), 5 * some.coverage_se)
        self.assertEqual(some.overlap_matrix_se.shape, (3, 3))

    def test_registration_is_predicted(self):
        found = self.simulator.evaluate(HEADS, registration=vantage.RegistrationOptions())
        error = found.registration
        self.assertEqual(error.station_rms_m.shape, (3,))
        self.assertEqual(error.head_covariance_m2.shape, (3, 3, 3))
        np.testing.assert_allclose(error.head_covariance_m2, error.head_covariance_m2.transpose(0, 2, 1))
        self.assertEqual(error.worst_m, error.station_rms_m.max())
        self.assertEqual(error.worst_station, error.station_rms_m.argmax())
        stations = [part for head in HEADS for part in ("--station", ",".join(map(str, head)))]
        told = program_json("evaluate", FOUR_WALLS, *COARSE, *stations, "--registration")["registration"]
        self.assertEqual(error.rms_m * 1e3, told["error_mm"])

    def test_registration_goes_by_all_surfaces_where_asked(self):
        scene = vantage.Scene.load(FOUR_WALLS, blocking=["wall-south", "wall-east", "wall-west"])
        scanner = vantage.Scanner(azimuth_step_deg=0.2, zenith_step_deg=0.2, height_m=1.5)
        simulator = vantage.Simulator(scene, scanner, engine="embree", user_size_m=0.2, point_spacing_m=0.03)
        inside = [[0, 0, 1.5], [2, 1, 1.5]]
        surveyed, everything = [
            simulator.evaluate(inside, registration=vantage.RegistrationOptions(surfaces=surfaces))
            for surfaces in ("surveyed", "all")]
        self.assertEqual(surveyed.coverage, everything.coverage)
        # One wall leaves the stations free along it and upwards, four leave them free upwards alone.
        self.assertAlmostEqual(everything.registration.rms_m / surveyed.registration.rms_m, np.sqrt(1 / 2), delta=0.05)
        blocking = [part for name in ("south", "east", "west") for part in ("--blocking", "wall-" + name)]
        told = program_json("evaluate", FOUR_WALLS, *COARSE, *blocking, "--station", "0,0,1.5", "--station", "2,1,1.5",
                            "--registration", "--registration-surfaces", "all")["registration"]
        self.assertEqual(everything.registration.rms_m * 1e3, told["error_mm"])
        self.assertEqual(everything.registration_estimate, (everything.registration.rms_m, 0))

    def test_what_was_not_asked_for_says_so(self):
        found = self.simulator.evaluate(HEADS, overlap=False)
        for name in ("overlap", "overlap_matrix", "shared", "seen"):
            with self.assertRaisesRegex(vantage.Error, name + ": was not asked for; evaluate with overlap=True"):
                getattr(found, name)
        with self.assertRaisesRegex(vantage.Error, "field=True"):
            found.voxel_points
        with self.assertRaisesRegex(vantage.Error, "RegistrationOptions"):
            found.registration
        self.assertIsNone(found.to_dict()["overlap"])

    def test_bad_stations_are_refused(self):
        for stations, text in [([[0, 0]], r"stations: .* \(1, 2\)"), ([], "stations"), (np.zeros((1025, 3)), "1024")]:
            with self.assertRaisesRegex(vantage.Error, text):
                self.simulator.evaluate(stations)

    def test_voxels_are_arrays(self):
        centres = self.simulator.voxel_centres()
        self.assertEqual(centres.shape, (self.simulator.voxel_count, 3))
        low, high = self.simulator.scene.bounds
        self.assertTrue(((centres > low - 0.2) & (centres < high + 0.2)).all())
        np.testing.assert_array_equal(self.simulator.voxel_weights(), 1)


class LongCalls(unittest.TestCase):
    def test_progress_is_told_and_may_end_the_call(self):
        simulator = four_walls(max_rays_per_dispatch=50_000)
        told = []
        simulator.evaluate(HEADS, progress=told.append)
        self.assertEqual(told, sorted(told))
        self.assertTrue(told and 0 <= told[0] and told[-1] <= 1)
        cancelled = simulator.evaluate(HEADS, progress=lambda done: False)
        self.assertTrue(cancelled.cancelled)
        self.assertEqual(repr(cancelled), "<vantage.Evaluation: cancelled>")
        with self.assertRaisesRegex(vantage.Error, "cancelled"):
            cancelled.coverage
        scan = simulator.scan(HEADS[0], grid=True, progress=lambda done: False)
        self.assertTrue(scan.cancelled)
        self.assertEqual(scan.position.shape, (len(scan), 3))
        self.assertFalse(simulator.evaluate(HEADS, progress=lambda done: None).cancelled)

    def test_what_progress_raises_ends_the_call(self):
        simulator = four_walls()

        def fail(done):
            raise LookupError("enough")

        with self.assertRaisesRegex(LookupError, "enough"):
            simulator.evaluate(HEADS, progress=fail)
        self.assertGreater(simulator.evaluate(HEADS).coverage, 0)

    def test_other_threads_run_meanwhile(self):
        simulator = four_walls(point_spacing_m=0.01)
        counted, done = 0, threading.Event()

        def count():
            nonlocal counted
            while not done.is_set():
                counted += 1
                time.sleep(0)  # hands the lock on, which nobody takes by force here

        interval = sys.getswitchinterval()
        sys.setswitchinterval(1000)
        thread = threading.Thread(target=count)
        try:
            thread.start()
            before = counted
            simulator.evaluate(BEFORE_EACH_WALL, skip=False)
            after = counted
        finally:
            sys.setswitchinterval(interval)
            done.set()
            thread.join()
        self.assertGreater(after, before)

    def test_what_are_no_stations_is_told(self):
        with self.assertRaisesRegex(TypeError, "stations: 'abc' is no array of numbers"):
            four_walls().evaluate("abc")
        with self.assertRaisesRegex(TypeError, "stations: {'a': 1} is no array of numbers"):
            four_walls().evaluate({"a": 1})
        with self.assertRaisesRegex(vantage.Error, r"stations: an array of shape \(n, 3\) is wanted"):
            four_walls().evaluate([[1, 2]])

    def test_a_simulator_may_have_several_devices_and_a_limit_of_memory(self):
        devices = vantage.all_devices("embree")
        self.assertEqual([engine for engine, _ in devices], ["embree"] * len(devices))
        shared = four_walls(devices=devices)
        self.assertEqual(shared.evaluate(HEADS).coverage, four_walls().evaluate(HEADS).coverage)
        with self.assertRaises(vantage.Error) as raised:
            four_walls(max_memory_bytes=1000)
        self.assertEqual(raised.exception.code, "out_of_memory")

    def test_a_simulator_serves_threads_one_after_another(self):
        simulator = four_walls()
        alone = [simulator.evaluate([head]).coverage for head in HEADS]
        with concurrent.futures.ThreadPoolExecutor(4) as threads:
            together = list(threads.map(lambda head: simulator.evaluate([head]).coverage, HEADS * 4))
        self.assertEqual(together, alone * 4)

    def test_a_callback_cannot_call_its_own_simulator(self):
        simulator = four_walls()
        raised = []

        def again(done):
            try:
                simulator.evaluate(HEADS)
            except vantage.Error as error:
                raised.append(error)

        self.assertFalse(simulator.evaluate(HEADS, progress=again).cancelled)
        self.assertRegex(str(raised[0]), "a callback of a simulator's call")


if __name__ == "__main__":
    unittest.main()
