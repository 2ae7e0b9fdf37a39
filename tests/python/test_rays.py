# SPDX-License-Identifier: Apache-2.0
"""Rays of a caller's own, sights of arrays, counts by mesh."""
import pickle
import threading
import time
import unittest

import numpy as np
import vantage

from sites import BEFORE_EACH_WALL, FOUR_WALLS, four_walls, four_walls_site, wall


def one_wall():
    corners, triangles = wall()
    return vantage.Scene.from_triangles(corners, triangles)


class Rays(unittest.TestCase):
    def test_hits_are_those_of_a_wall(self):
        tracer = vantage.RayTracer(one_wall())
        directions = np.array([[0.5, 1, 0], [0.5, 1, 0.125], [0, -1, 0], [1, 1, 0]]) * [[1e-9], [1], [1], [1e9]]
        hits = tracer.nearest((0, 0, 0), directions)
        self.assertEqual(len(hits), 4)
        np.testing.assert_allclose(hits.range_m, [np.hypot(3, 1.5), np.hypot(3, np.hypot(1.5, 0.375)), np.inf, np.inf])
        np.testing.assert_allclose(hits.position[:2], [[1.5, 3, 0], [1.5, 3, 0.375]], atol=1e-12)
        self.assertTrue(np.isnan(hits.position[2:]).all())
        np.testing.assert_allclose(hits.normal[:2], [[0, -1, 0]] * 2, atol=1e-7)
        np.testing.assert_allclose(hits.reflectivity[:2], 0.5 * 3 / hits.range_m[:2], rtol=1e-6)
        np.testing.assert_array_equal(hits.diffuse, np.float32([0.5, 0.5, 0, 0]))
        np.testing.assert_array_equal(hits.mesh, [0, 0, -1, -1])
        self.assertEqual(hits.primitive[2], 2**32 - 1)
        np.testing.assert_array_equal(tracer.blocked((0, 0, 0), directions), [True, True, False, False])
        np.testing.assert_array_equal(tracer.count((0, 0, 0), directions, ranges_m=[3, 9, 9, 9]), [0, 1, 0, 0])
        self.assertFalse(tracer.blocked((0, 0, 0), (0, 1, 0), ranges_m=2.9)[0])
        self.assertFalse(tracer.blocked((0, 0, 0), (0, 1, 0), from_m=3.001)[0])
        with self.assertRaises(ValueError):
            hits.range_m[0] = 1
        again = pickle.loads(pickle.dumps(hits))
        np.testing.assert_array_equal(again.primitive, hits.primitive)
        self.assertRaises(TypeError, pickle.dumps, tracer)

    def test_a_million_rays_meet_what_a_scan_meets(self):
        simulator = four_walls(noise=False)
        scan = simulator.scan((8, 0, 1.5), ["position", "mesh", "primitive"], grid=True)
        to = scan.position[np.isfinite(scan.range_m)]
        hits = vantage.RayTracer(simulator.scene).nearest((8, 0, 1.5), np.repeat(to - [8, 0, 1.5], 6, axis=0))
        self.assertGreater(len(hits), 1_000_000)
        same = hits.primitive[::6] == scan.primitive[np.isfinite(scan.range_m)]
        self.assertGreater(same.mean(), 0.999)
        self.assertLess(np.abs(hits.range_m[::6] - scan.range_m[np.isfinite(scan.range_m)])[same].max(), 1e-3)

    def test_every_engine_gives_the_same_answers(self):
        scene = vantage.Scene.load(FOUR_WALLS)
        processor = vantage.RayTracer(scene)
        self.assertEqual(processor.engine.engine, "embree")
        random = np.random.default_rng(2)
        origins, directions = random.uniform(-9, 9, (200_000, 3)), random.normal(size=(200_000, 3))
        expected = processor.nearest(origins, directions, from_m=0.01)
        for info in vantage.list_engines():
            if not info.usable:
                continue
            tracer = vantage.RayTracer(scene, engine=info.engine, device_index=info.device_index)
            self.assertEqual(tracer.engine.engine, info.engine)
            hits = tracer.nearest(origins, directions, from_m=0.01)
            for name in ("range_m", "position", "normal", "reflectivity", "diffuse", "mesh", "primitive"):
                np.testing.assert_array_equal(getattr(hits, name), getattr(expected, name))
            np.testing.assert_array_equal(tracer.count(origins, directions), processor.count(origins, directions))
            np.testing.assert_array_equal(tracer.blocked(origins, directions, ranges_m=3),
                                          processor.blocked(origins, directions, ranges_m=3))
        with self.assertRaisesRegex(vantage.Error, "no Vulkan device can run"):
            vantage.RayTracer(scene, engine="compute_bvh", device_index=99)

    def test_what_is_no_ray_is_refused_by_its_row(self):
        tracer = vantage.RayTracer(one_wall())
        origins, directions = np.zeros((5, 3)), np.ones((5, 3))
        origins[3, 1] = np.nan
        with self.assertRaisesRegex(vantage.Error, "origin in row 3, counted from 0"):
            tracer.nearest(origins, directions)
        with self.assertRaisesRegex(vantage.Error, "direction in row 0, counted from 0"):
            tracer.count((0, 0, 0), (0, 0, 0))
        with self.assertRaisesRegex(vantage.Error, "5 origins and 4 directions"):
            tracer.blocked(np.zeros((5, 3)), directions[:4])
        with self.assertRaisesRegex(vantage.Error, r"directions: an array of shape \(n, 3\)"):
            tracer.blocked((0, 0, 0), np.zeros((5, 2)))
        with self.assertRaisesRegex(vantage.Error, "ranges_m"):
            tracer.blocked((0, 0, 0), directions, ranges_m=[])
        with self.assertRaises(TypeError):
            tracer.blocked("here", directions)
        self.assertEqual(len(tracer.nearest(np.zeros((0, 3)), np.zeros((0, 3)))), 0)

    def test_other_threads_run_meanwhile_and_progress_stops(self):
        tracer = vantage.RayTracer(vantage.Scene.load(FOUR_WALLS))
        directions = np.random.default_rng(1).normal(size=(2_000_000, 3))
        ticks, done = [], threading.Event()

        def tick():
            while not done.wait(0.001):
                ticks.append(time.perf_counter())

        thread = threading.Thread(target=tick)
        thread.start()
        begin = time.perf_counter()
        tracer.nearest((8, 0, 1.5), directions)
        end = time.perf_counter()
        done.set()
        thread.join()
        self.assertGreater(sum(begin < t < end for t in ticks), 5)
        told = []
        stopped = tracer.nearest((8, 0, 1.5), directions, progress=lambda part: told.append(part) or False)
        self.assertEqual(len(stopped), 0)
        self.assertEqual(len(told), 1)


class Sights(unittest.TestCase):
    def test_sights_of_arrays_are_those_of_their_rows(self):
        clash = vantage.ClashChecker(one_wall())
        a = np.column_stack([np.linspace(-4, 4, 50), np.zeros(50), np.zeros(50)])
        b = a + [0, 5, 0]
        sees = clash.sees(a, b)
        self.assertEqual(sees.dtype, bool)
        self.assertEqual(sees.tolist(), [clash.sees(tuple(p), tuple(q)) for p, q in zip(a, b)])
        self.assertEqual(set(sees.tolist()), {True, False})
        self.assertEqual(clash.sees(a[0], b).tolist(), [clash.sees(tuple(a[0]), tuple(q)) for q in b])
        self.assertIs(clash.sees((0, 0, 0), (0, 5, 0)), False)
        with self.assertRaisesRegex(vantage.Error, "row 1, counted from 0, of b"):
            clash.sees((0, 0, 0), [[0, 1, 0], [np.inf, 0, 0]])


class Parts(unittest.TestCase):
    def test_objectives_and_requirements_see_counts_by_mesh(self):
        site = four_walls_site(step=0.5, spacing=0.1)
        names = [mesh.name for mesh in site.scene.meshes if mesh.role == "surveyed"]
        seen = []

        def part(network):
            seen.append([network.captured(name) for name in names] + [network.captured("*")])
            return network.captured(names[0])

        first = vantage.Objective("first", part, vantage.maximise(1, 0), meshes=True)
        problem = vantage.SurveyProblem(stations_min=2, stations_max=2, objectives=["coverage"],
                                        requirements=[vantage.Requirement(first, ">=", 0.2)])
        result = site.plan(problem, population=8, iterations=3, sample=500)
        entry = result.front[0]
        self.assertGreaterEqual(entry.value("first"), 0.2)
        self.assertTrue(all(0 <= value <= 1 for row in seen for value in row))
        # The same by the voxels that the answer leaves open.
        found = site.simulator.evaluate(entry.stations, field=True)
        open_voxels = vantage.uncovered(site.simulator, found)
        self.assertEqual(len(open_voxels), np.count_nonzero(found.voxel_points < site.simulator.goal_densities()))
        np.testing.assert_array_equal(open_voxels.centres, site.simulator.voxel_centres()[open_voxels.voxels])
        np.testing.assert_array_equal(open_voxels.points, found.voxel_points[open_voxels.voxels])
        whole = 1 - len(open_voxels) / site.simulator.voxel_count
        self.assertTrue(any(abs(row[-1] - whole) < 1e-12 for row in seen))
        self.assertLessEqual(set(open_voxels.meshes.tolist()), set(range(len(site.scene.meshes))))
        np.testing.assert_array_equal(pickle.loads(pickle.dumps(open_voxels)).voxels, open_voxels.voxels)

    def test_names_that_are_near_are_suggested(self):
        simulator = four_walls()
        found = simulator.evaluate(BEFORE_EACH_WALL)
        self.assertEqual(found.value("coverage"), found.coverage)
        with self.assertRaisesRegex(vantage.Error, "did you mean coverage"):
            found.value("covrage")
        with self.assertRaisesRegex(vantage.Error, "keep the field"):
            vantage.uncovered(simulator, found)

    def test_a_part_that_is_not_there_is_refused(self):
        site = four_walls_site(step=0.5, spacing=0.1)
        for needs, message in ((True, "no surveyed mesh is named like"), (False, "has to need counts and meshes")):
            none = vantage.Objective("none", lambda m: m.captured("roof*"), vantage.maximise(1, 0), meshes=needs)
            problem = vantage.SurveyProblem(stations_min=2, stations_max=2, objectives=[none])
            with self.assertRaisesRegex(vantage.Error, message):
                site.plan(problem, population=4, iterations=1, sample=200)


if __name__ == "__main__":
    unittest.main()
