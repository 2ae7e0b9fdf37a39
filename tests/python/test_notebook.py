# SPDX-License-Identifier: Apache-2.0
"""What notebooks use: HTML, plans by matplotlib, points as structured arrays, and a site that answers while it plans."""
import html.parser
import os
import sys
import threading
import unittest
from unittest import mock

import numpy as np
import vantage
from sites import BEFORE_EACH_WALL, SOURCE, four_walls, four_walls_site

COARSE = {"step": 0.5, "user_size": 0.3, "spacing": 0.1}


def plan_of(site, **more):
    return site.plan(**{"problem": "coverage-overlap-fix", "stations": 4, "population": 8, "iterations": 4, **more})


class Balanced(html.parser.HTMLParser):
    """Fails for tags that do not close each other."""

    def __init__(self, text):
        super().__init__()
        self.open, self.text = [], ""
        self.feed(text)
        assert not self.open, self.open

    def handle_starttag(self, tag, attrs):
        self.open.append(tag)

    def handle_endtag(self, tag):
        assert self.open.pop() == tag, tag

    def handle_data(self, data):
        self.text += data


class Html(unittest.TestCase):
    def test_tells_what_the_objects_tell(self):
        site = four_walls_site(**COARSE)
        self.assertIn("4 meshes, 400 triangles, 10 x 10 x 5 m", Balanced(site._repr_html_()).text)
        found = site.evaluate(np.array(BEFORE_EACH_WALL, float))
        self.assertIn(found.summary, Balanced(found._repr_html_()).text)
        plan = plan_of(site)
        shown = Balanced(plan._repr_html_()).text
        self.assertIn(plan.summary, shown)
        self.assertEqual(f"{len(plan.front)} networks" in shown, len(plan.front) > 1)

    def test_escapes_names(self):
        corners = np.array([[0, 0, 0], [9, 0, 0], [9, 9, 0], [0, 9, 0]], float)
        scene = vantage.Scene.from_triangles(corners, np.array([[0, 1, 2], [0, 2, 3]]))
        shown = vantage.Site(scene, name="<b>a&b", engine="embree")._repr_html_()
        self.assertNotIn("<b>a", shown)
        self.assertIn("<b>a&b", Balanced(shown).text)


class Plots(unittest.TestCase):
    def test_draw_stations_links_and_ground(self):
        try:
            import matplotlib
        except ImportError:
            self.skipTest("matplotlib is not installed")
        matplotlib.use("Agg")
        site = four_walls_site(**COARSE)
        heads = np.array(BEFORE_EACH_WALL, float)
        found = site.evaluate(heads)
        ax = found.plot(site=site)
        np.testing.assert_array_equal(ax.collections[-1].get_offsets(), heads[:, :2])
        self.assertEqual([text.get_text() for text in ax.texts], ["S1", "S2", "S3", "S4"])
        self.assertEqual(len(ax.lines), np.count_nonzero(np.triu(found.scan_overlap_matrix, 1) >= 0.3))
        self.assertEqual(len(ax.collections[0].get_paths()), len(site.area.triangles))
        every = found.plot(link=0)
        self.assertEqual(len(every.lines), 6)
        self.assertIs(site.plot(ax), ax)
        plan = plan_of(site)
        drawn = plan.plot()
        np.testing.assert_array_equal(drawn.collections[-1].get_offsets(), plan.answer.heads[:, :2])
        self.assertIs(plan.site, site)

    def test_say_what_is_missing(self):
        site = four_walls_site(**COARSE)
        with mock.patch.dict(sys.modules, {"matplotlib": None, "matplotlib.pyplot": None}):
            with self.assertRaisesRegex(ImportError, r"plot needs matplotlib.*pip install 'vantage\[plot\]'"):
                site.plot()


class ScanArrays(unittest.TestCase):
    def test_have_the_points_of_a_scan(self):
        simulator = four_walls()
        names = ["position", "normal", "reflectivity", "mesh", "primitive", "colour", "voxel", "ghost", "returns"]
        scan = simulator.scan((8, 0, 1.5), names)
        rows = simulator.scan_array((8, 0, 1.5), [*names, "row", "column", "range_m"])
        self.assertEqual(rows.shape, (len(scan),))
        for at, axis in enumerate("xyz"):
            np.testing.assert_array_equal(rows[axis], scan.position[:, at])
            np.testing.assert_array_equal(rows["n" + axis], scan.normal[:, at])
        for name in [*names[2:], "return_number", "row", "column", "range_m"]:
            np.testing.assert_array_equal(rows[name], getattr(scan, name), name)

    def test_take_half_of_the_memory_as_floats(self):
        corners, triangles = np.array([[-2, 3, -1], [2, 3, -1], [2, 3, 1], [-2, 3, 1]], float), [[0, 1, 2], [0, 2, 3]]
        far = np.array([500_000.0, 5_800_000.0, 300.0])
        scene = vantage.Scene.from_triangles(corners + far, np.array(triangles))
        scanner = vantage.Scanner(azimuth_step_deg=0.5, zenith_step_deg=0.5)
        simulator = vantage.Simulator(scene, scanner, engine="embree", user_size_m=0.1)
        doubles = simulator.scan_array(tuple(far), ["position"])
        floats = simulator.scan_array(tuple(far), ["position"], float32=True)
        self.assertEqual((doubles.itemsize, floats.itemsize), (24, 12))
        self.assertGreater(len(floats), 100)
        for axis, origin in zip("xyz", simulator.origin):
            np.testing.assert_array_equal(floats[axis].astype(float) + origin, doubles[axis])
        np.testing.assert_allclose(doubles["y"], far[1] + 3, atol=1e-2)  # the wall; floats of it would be off by decimetres

    def test_refuse_what_is_not_there(self):
        simulator = four_walls()
        for outputs, message in ([["depth"], "depth"], [[], "name one at least"]):
            with self.assertRaisesRegex(vantage.Error, message):
                simulator.scan_array((8, 0, 1.5), outputs)


class Changes(unittest.TestCase):
    def test_a_simulator_takes_other_scanners(self):
        scene = vantage.Scene.load(os.path.join(SOURCE, "data", "four_walls.glb"))
        coarse, fine = (vantage.Scanner(azimuth_step_deg=step, zenith_step_deg=step) for step in (2, 1))
        config = {"engine": "embree", "user_size_m": 0.4, "point_spacing_m": 0.1}
        simulator = vantage.Simulator(scene, coarse, **config)
        heads = np.array([[8, 0, 1.8], [0, 8, 1.8]])
        simulator.evaluate(heads, surroundings=True)
        simulator.set_scanners([fine])
        got, wanted = (each.evaluate(heads, surroundings=True)
                       for each in (simulator, vantage.Simulator(scene, fine, **config)))
        self.assertEqual(got.coverage, wanted.coverage)
        np.testing.assert_array_equal(got.scan_overlap_matrix, wanted.scan_overlap_matrix)
        with self.assertRaisesRegex(vantage.Error, "of a site keeps the site's scanners"):
            vantage.Site(scene, engine="embree").simulator.set_scanners([fine])

    def test_a_simulator_takes_a_changed_scene(self):
        scene = vantage.Scene.load(os.path.join(SOURCE, "data", "industrial_20k.glb"))
        scanner = vantage.Scanner(azimuth_step_deg=1, zenith_step_deg=1)
        config = {"engine": "embree", "user_size_m": 0.2, "point_spacing_m": 0.05}
        simulator = vantage.Simulator(scene, scanner, **config)
        heads = np.array([[0, 0, 1.8], [3, -2, 1.8]])
        first = simulator.evaluate(heads, surroundings=True).scan_overlap_matrix
        turned = ((0.4, 0.2, 0), (0, 0, 0.02, 1))
        crate = {"positions": [[1, 1, 0.5], [2, 1, 0.5], [1, 1, 1.5]], "triangles": np.array([[0, 1, 2]]),
                 "role": "blocking", "name": "crate"}
        changed = scene.with_changes(move={"pump-1*": turned, "drum": (0, 0, 0.3)}, remove=["cabinets"], add=[crate])
        self.assertEqual([mesh.name for mesh in changed.meshes],
                         [mesh.name for mesh in scene.meshes if mesh.name != "cabinets"] + ["crate"])
        simulator.set_scene(changed)
        self.assertEqual(simulator.scene.fingerprint, changed.fingerprint)
        fresh = vantage.Simulator(changed, scanner, **config)
        got, wanted = (each.evaluate(heads, field=True, surroundings=True) for each in (simulator, fresh))
        np.testing.assert_array_equal(got.voxel_points, wanted.voxel_points)
        np.testing.assert_array_equal(got.scan_overlap_matrix, wanted.scan_overlap_matrix)
        simulator.set_scene(scene)
        np.testing.assert_array_equal(simulator.evaluate(heads, surroundings=True).scan_overlap_matrix, first)
        self.assertTrue(simulator.set_scene(scene.with_changes(move={"pump-1*": ((0.3, 0.2, 0), (0, 0, 0.1, 1))})))

    def test_say_what_they_cannot_do(self):
        site = four_walls_site(**COARSE)
        with self.assertRaisesRegex(vantage.Error, "the simulator of a site keeps"):
            site.simulator.set_scene(site.scene)
        with self.assertRaisesRegex(vantage.Error, 'no mesh to move matches "crane"; meshes are "wall-south"'):
            site.scene.with_changes(move={"crane": (1, 0, 0)})
        with self.assertRaisesRegex(TypeError, "a translation"):
            site.scene.with_changes(move={"wall-*": 3})
        with self.assertRaisesRegex(TypeError, "triangles is missing"):
            site.scene.with_changes(add=[{"positions": [[0, 0, 0]]}])


class Threads(unittest.TestCase):
    def test_a_site_answers_while_it_plans(self):
        heads = np.array(BEFORE_EACH_WALL[:2], float)
        alone = four_walls_site(**COARSE)
        wanted, plan_alone = alone.evaluate(heads, field=True), plan_of(alone, iterations=12)
        site, plans, started, errors = four_walls_site(**COARSE), [], threading.Event(), []

        def plan():
            try:
                plans.append(plan_of(site, iterations=12, progress=lambda now: started.set()))
            except Exception as error:
                errors.append(error)

        planning = threading.Thread(target=plan)
        planning.start()
        started.wait()
        answers = 0
        with self.assertRaisesRegex(vantage.Error, "in use by another call, beside which it answers"):
            plan_of(site)
        while planning.is_alive():
            self.assertEqual(vantage.place_heads(site, heads)[0].status, "ok")
            self.assertIsNotNone(site.nearest_place(tuple(heads[1])))
            np.testing.assert_array_equal(site.evaluate(heads, field=True).voxel_points, wanted.voxel_points)
            answers += 1
        planning.join()
        self.assertEqual(errors, [])
        self.assertGreater(answers, 1)
        np.testing.assert_array_equal(plans[0].answer.heads, plan_alone.answer.heads)

    def test_many_threads_make_the_parts_of_a_site_once(self):
        site, found = four_walls_site(**COARSE), []
        heads = np.array(BEFORE_EACH_WALL, float)
        threads = [threading.Thread(target=lambda: found.append(site.evaluate(heads).coverage)) for _ in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(len(set(found)), 1)
        self.assertEqual(len(found), 4)


if __name__ == "__main__":
    unittest.main()
