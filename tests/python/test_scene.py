# SPDX-License-Identifier: Apache-2.0
import os
import tempfile
import unittest

import numpy as np
import vantage
from sites import FOUR_WALLS, program, wall


class Loading(unittest.TestCase):
    def test_a_file_says_what_is_in_it(self):
        scene = vantage.Scene.load(FOUR_WALLS)
        self.assertEqual([mesh.name for mesh in scene.meshes], ["wall-south", "wall-east", "wall-north", "wall-west"])
        self.assertEqual([mesh.role for mesh in scene.meshes], ["surveyed"] * 4)
        self.assertEqual(scene.triangle_count, 400)
        np.testing.assert_array_equal(scene.bounds, [[-5, -5, 0], [5, 5, 5]])
        self.assertEqual(scene.defaults["user-size"], 0.1)
        self.assertTrue(scene.has_search_area)

    def test_options_are_those_of_the_library(self):
        scene = vantage.Scene.load(FOUR_WALLS, surveyed=["wall-n*"], weights=[("wall-north", 7)])
        roles = {mesh.name: (mesh.role, mesh.weight) for mesh in scene.meshes}
        self.assertEqual(roles["wall-north"], ("surveyed", 7))
        with open(FOUR_WALLS, "rb") as file:
            self.assertEqual(vantage.load_gltf(file.read()).fingerprint, vantage.Scene.load(FOUR_WALLS).fingerprint)

    def test_other_formats_go_through_their_importer(self):
        with tempfile.TemporaryDirectory() as folder:
            site = os.path.join(folder, "site.obj")
            with open(site, "w") as file:
                file.write("o wall\nv 0 0 0\nv 4 0 0\nv 0 3 0\nf 1 2 3\n")
            os.environ["VANTAGE_IMPORTERS"] = os.path.dirname(os.environ["VANTAGE_PROGRAM"])
            os.environ["XDG_CACHE_HOME"] = folder
            scene = vantage.Scene.load(site)
        self.assertEqual([mesh.name for mesh in scene.meshes], ["wall"])
        np.testing.assert_array_equal(scene.bounds, [[0, 0, 0], [4, 0, 3]])

    def test_errors_have_the_programs_text_and_a_code(self):
        with self.assertRaises(vantage.Error) as raised:
            vantage.Scene.load("no_such_file.glb")
        self.assertEqual(raised.exception.code, "io")
        self.assertEqual(raised.exception.details, ())
        code, _, text = program("evaluate", "no_such_file.glb", "--station", "0,0,1")
        self.assertNotEqual(code, 0)
        self.assertIn(str(raised.exception), text)
        with self.assertRaises(vantage.Error) as raised:
            vantage.Scene.load(FOUR_WALLS, up="q")
        self.assertEqual(raised.exception.code, "invalid_argument")

    def test_unknown_and_wrong_options_are_named(self):
        with self.assertRaisesRegex(TypeError, "Scene.load: no option 'survyed'; there are surveyed, blocking"):
            vantage.Scene.load(FOUR_WALLS, survyed=["a"])
        with self.assertRaisesRegex(TypeError, "Scene.load: default_diffuse: 'half' is no float"):
            vantage.Scene.load(FOUR_WALLS, default_diffuse="half")

    def test_built_in_scenes_are_written(self):
        self.assertIn("four-walls", vantage.built_in_scene_names())
        with tempfile.TemporaryDirectory() as folder:
            file = os.path.join(folder, "walls.glb")
            vantage.write_built_in_scene("four-walls", file)
            self.assertEqual(vantage.Scene.load(file).fingerprint, vantage.Scene.load(FOUR_WALLS).fingerprint)


class Building(unittest.TestCase):
    def test_arrays_of_any_layout_give_the_same_scene(self):
        corners, triangles = wall()
        scene = vantage.Scene.from_triangles(corners, triangles)
        for other in (corners.astype(np.float32), np.asfortranarray(corners), corners.tolist()):
            self.assertEqual(vantage.Scene.from_triangles(other, triangles).fingerprint, scene.fingerprint)
        for other in (triangles.astype(np.uint8), np.asfortranarray(triangles), np.repeat(triangles, 2, 0)[::2]):
            self.assertEqual(vantage.Scene.from_triangles(corners, other).fingerprint, scene.fingerprint)

    def test_bad_arrays_are_told_apart(self):
        corners, triangles = wall()
        for bad_corners, bad_triangles, text in [
            (corners[:, :2], triangles, r"positions: an array of shape \(n, 3\) is wanted, and this one's is \(4, 2\)"),
            (corners, triangles[0], r"triangles: an array of shape \(m, 3\) is wanted, and this one's is \(3,\)"),
            (corners, triangles.astype(float), "triangles: integers are wanted, and these are float64"),
            (corners, triangles - 1, "triangles: no corner has the index -1"),
            (corners, triangles + 2**40, "triangles: no corner has the index"),
            (corners, triangles + 9, "9"),
        ]:
            with self.assertRaisesRegex(vantage.Error, text) as raised:
                vantage.SceneBuilder().add(bad_corners, bad_triangles)
            self.assertEqual(raised.exception.code, "invalid_argument")

    def test_the_builder_moves_and_replaces(self):
        builder = vantage.SceneBuilder()
        number = builder.add(*wall(), name="wall", role="surveyed", weight=3)
        self.assertEqual((number, len(builder)), (0, 1))
        first = builder.build()
        self.assertEqual((first.meshes[0].name, first.meshes[0].weight), ("wall", 3))
        builder.move(number, (0, 10, 0))
        np.testing.assert_allclose(builder.build().bounds[:, 1], [13, 13])
        np.testing.assert_allclose(first.bounds[:, 1], [3, 3])
        builder.replace(number, *wall((0, 0, 5)), door=True, station_area=True, detail_m=0.008, accuracy_m=0.003)
        second = builder.build()
        np.testing.assert_allclose(second.bounds[:, 2], [4, 6])
        limits = [(mesh.door, mesh.station_area, mesh.detail_m, mesh.accuracy_m)
                  for scene in (first, second) for mesh in scene.meshes]
        self.assertEqual(limits, [(False, False, 0, 0), (True, True, 0.008, 0.003)])
        with self.assertRaisesRegex(TypeError, "SceneBuilder.add: no option 'doors'; there are name, role"):
            builder.add(*wall(), doors=True)
        with self.assertRaisesRegex(vantage.Error, "the detail must be 0 or more metres"):
            builder.add(*wall(), detail_m=-1)


class Placing(unittest.TestCase):
    def test_the_search_area_is_an_array_that_outlives_it(self):
        scene = vantage.Scene.load(FOUR_WALLS)
        area = vantage.SearchArea(scene)
        positions, triangles = area.positions, area.triangles
        self.assertFalse(positions.flags.writeable or positions.flags.owndata)
        before = positions.copy()
        u = np.linspace(area.uv_min[0], area.uv_max[0], 7)[1:-1]
        v = np.linspace(area.uv_min[1], area.uv_max[1], 7)[1:-1]
        uvs = np.array([(a, b) for a in u for b in v])
        grounds = area.locate(uvs)
        self.assertEqual(grounds.shape, (25, 3))
        there = ~np.isnan(grounds[:, 0])
        self.assertTrue(there.any())
        np.testing.assert_allclose(area.project(grounds[there]), uvs[there], atol=1e-9)
        np.testing.assert_array_equal(np.isnan(area.locate([[1e9, 0]])), [[True] * 3])
        del area, scene
        np.testing.assert_array_equal(positions, before)
        self.assertLess(triangles.max(), len(positions))

    def test_ground_makes_a_third_of_coverage_at_most(self):
        corners = np.array([[-10, -10, 0], [10, -10, 0], [10, 10, 0], [-10, 10, 0]], float)
        builder = vantage.SceneBuilder()
        builder.add(corners, np.array([[0, 1, 2], [0, 2, 3]]), name="ground")
        builder.add(*wall((0, 0, 1.01)), name="wall")
        scene = builder.build()
        self.assertEqual([mesh.weight for mesh in scene.meshes], [1, 1])
        weighed = vantage.Site(scene).scene
        self.assertEqual(weighed.meshes[0].weight, 1)
        # 400 m² of ground, 8 m² of wall: 2 · 400 / 8, rounded up.
        self.assertIn(weighed.meshes[1].weight, (100, 101))
        marked = vantage.Scene.load(FOUR_WALLS)
        self.assertEqual(
            vantage.Site(marked).scene.fingerprint, marked.fingerprint)

    def test_clashes_are_those_with_the_walls(self):
        scene = vantage.Scene.load(FOUR_WALLS)
        clash = vantage.ClashChecker(scene)
        distances = np.array([0.1, 0.49, 0.51, 2.0])
        grounds = np.column_stack([5 + distances, np.zeros(4), np.zeros(4)])
        np.testing.assert_array_equal(clash.clashes(grounds), distances < 0.5)
        np.testing.assert_allclose(clash.distance(grounds + [0, 0, 1], 10), distances, atol=1e-6)
        self.assertFalse(clash.sees((0, 0, 1), (9, 0, 1)))
        self.assertTrue(clash.sees((0, 0, 1), (4, 0, 1)))
        placed = vantage.place_heads(vantage.Site(scene, height=1.5), [[8, 0, 1.5], [5.1, 0, 1.5]])
        self.assertEqual([station.status for station in placed], ["ok", "clash"])
        np.testing.assert_array_equal(vantage.heads(placed), [[8, 0, 1.5], [5.1, 0, 1.5]])


if __name__ == "__main__":
    unittest.main()
