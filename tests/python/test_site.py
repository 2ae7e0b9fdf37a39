# SPDX-License-Identifier: Apache-2.0
import os
import re
import subprocess
import tempfile
import unittest

import numpy as np
import vantage
from sites import FOUR_WALLS, SOURCE, program, program_json

COARSE = {"step": 0.5, "user_size": 0.3, "spacing": 0.1, "engine": "embree", "seed": 7}


def options(settings):
    return [text for name, value in settings.items() for text in ("--" + name.replace("_", "-"), value)]


def without_seconds(text):
    """front.json but for what differs from run to run."""
    return re.sub(r'"seconds": \{[^}]*\}', "", text)


class Sites(unittest.TestCase):
    def assert_same_as_the_program(self, scene, settings, question):
        found = vantage.Site.open(scene, **settings).plan(**question)
        with tempfile.TemporaryDirectory() as folder:
            self.assertEqual(found.write(os.path.join(folder, "module"), reports=False), [])
            code, _, text = program("plan", scene, *options(settings), *options(question), "--no-report", "-o",
                                    os.path.join(folder, "program"))
            self.assertIn(code, (0, 3), text)
            given = [f"{name.replace('_', '-')}={value}" for name, value in {**settings, **question}.items()]
            subprocess.run([os.environ["VANTAGE_EXAMPLE"], scene, os.path.join(folder, "example"), *given], check=True,
                           capture_output=True)
            listed = [set(os.listdir(os.path.join(folder, each))) for each in ("module", "program", "example")]
            self.assertEqual(listed[0], listed[1] - {"config.json", "checkpoint.bin", "checkpoint.bin.before"})
            self.assertEqual(listed[2], listed[0] | {"report.html", "report.pdf"})
            told = [open(os.path.join(folder, each, "front.json")).read() for each in ("module", "program", "example")]
        self.assertEqual(without_seconds(told[0]), without_seconds(told[1]))
        self.assertEqual(without_seconds(told[0]), without_seconds(told[2]))

    def test_a_plan_has_the_bytes_of_the_program_and_the_example(self):
        self.assert_same_as_the_program(FOUR_WALLS, COARSE, {
            "problem": "coverage-overlap-fix", "stations": 4, "population": 10, "iterations": 5, "sample": 500})

    def test_the_surveyors_question_has_the_bytes_of_the_program(self):
        self.assert_same_as_the_program(FOUR_WALLS, COARSE, {"sample": 300})

    def test_a_problem_by_name_detects_every_echo_in_all_three(self):
        settings = {**COARSE, "scanner": "rtc360"}
        self.assert_same_as_the_program(FOUR_WALLS, settings, {
            "problem": "coverage-fix", "stations": 3, "population": 6, "iterations": 2, "sample": 300})
        site = vantage.Site.open(FOUR_WALLS, **settings)
        self.assertGreater(site.scanners[0].detection_range_m, 0)
        site.plan(problem="coverage-fix", stations=2, population=4, iterations=1, sample=100)
        self.assertEqual(site.scanners[0].detection_range_m, 0)
        given = vantage.Site.open(FOUR_WALLS, detection=(50, 0.5), **settings)
        given.plan(problem="coverage-fix", stations=2, population=4, iterations=1, sample=100)
        self.assertEqual(given.scanners[0].detection_range_m, 50)
        late = vantage.Site.open(FOUR_WALLS, **settings)
        late.evaluate([[8, 0, 1.5]])
        same = late.plan(problem="coverage-fix", stations=2, population=4, iterations=1, sample=100)
        early = vantage.Site.open(FOUR_WALLS, **settings)
        told = early.plan(problem="coverage-fix", stations=2, population=4, iterations=1, sample=100)
        np.testing.assert_array_equal(same.answer.heads, told.answer.heads)
        self.assertEqual(same.answer.value("coverage"), told.answer.value("coverage"))
        self.assertEqual(late.evaluate([[8, 0, 1.5]]).value("coverage"), early.evaluate([[8, 0, 1.5]]).value("coverage"))

    def test_an_evaluation_has_every_figure_of_the_program(self):
        heads = [[8, 0, 1.5], [9, 8, 1.5], [0, 12, 1.5]]
        stations = [part for head in heads for part in ("--station", ",".join(map(str, head)))]
        site = vantage.Site.open(FOUR_WALLS, **COARSE)
        for more, settings in ((["--exact"], {}), (["--sample", 500], {"sample_voxels": 500})):
            told = program_json("evaluate", FOUR_WALLS, *options(COARSE), *stations, *more, "--registration")
            found = site.evaluate(heads, registration=vantage.RegistrationOptions(), **settings)
            figures = found.to_dict()
            for key in ("summary", "coverage", "coverage_se", "overlap", "overlap_se", "overlap_matrix",
                        "scan_overlap_matrix", "minutes_on_site", "voxels", "goal_density", "rays", "sample"):
                self.assertEqual(figures[key], told[key], key)
            for key, value in figures["registration"].items():
                self.assertEqual(value, told["registration"][key], key)
            self.assertIsNotNone(told["minutes_on_site"])

    def test_reports_are_written_without_the_program(self):
        site = vantage.Site.open(FOUR_WALLS, **COARSE)
        plan = site.plan(problem="coverage-overlap-fix", stations=3, population=4, iterations=2, sample=200)
        found = site.evaluate([[8, 0, 1.5], [0, 12, 1.5]], field=True)
        with tempfile.TemporaryDirectory() as folder:
            for name, write in (("plan", plan.write_report), ("found", lambda file: site.write_report(file, found))):
                for ending, first in ((".html", b"<!doctype html>"), (".pdf", b"%pdf-")):
                    file = os.path.join(folder, name + ending)
                    write(file)
                    with open(file, "rb") as written:
                        self.assertTrue(written.read(20).lower().startswith(first), file)
            with self.assertRaisesRegex(vantage.Error, "neither .html nor .pdf"):
                site.write_report(os.path.join(folder, "found.doc"), found)

    def test_it_chooses_what_nobody_gave_and_says_why(self):
        site = vantage.Site.open(os.path.join(SOURCE, "data", "industrial_20k.glb"), engine="embree", height=None)
        self.assertEqual(site.name, "industrial_20k")
        self.assertEqual(len(site.scanners), 1)
        for choice in site.choices:
            self.assertTrue(choice.setting and choice.value and choice.why, repr(choice))

    def test_the_nearest_place_is_the_nearest_of_a_lattice(self):
        site = vantage.Site.open(FOUR_WALLS, **COARSE, height=1.5)
        for head in ([5.1, 0.3, 1.5], [8, 3, 1.5], [8, 3, 2.1]):
            found = site.nearest_place(head)
            self.assertEqual(found.status, "ok")
            steps = np.arange(-1, 1.001, 0.04)
            around = [[head[0] + dx, head[1] + dy, 1.5] for dx in steps for dy in steps]
            free = [place.position for place in vantage.place_heads(site, around) if place.status == "ok"]
            least = np.linalg.norm(np.array(free) - head, axis=1).min()
            away = np.linalg.norm(np.array(found.position) - head)
            self.assertLessEqual(away, least + 0.01)
            self.assertGreaterEqual(away, least - 0.04)
        self.assertIsNone(site.nearest_place([500, 0, 1.5]))
        self.assertIsNone(site.nearest_place([8, 3, 2.1], reach_m=0.5))
        with self.assertRaisesRegex(vantage.Error, "reach"):
            site.nearest_place([8, 3, 1.5], reach_m=-1)
        clash = site.evaluate([[5.1, 0.3, 1.5]])
        self.assertRegex(clash.summary, r"S1 clashes: .*, and is left out: move it \d+\.\d\d m to the ")

    def test_settings_are_refused_by_their_name(self):
        with self.assertRaisesRegex(TypeError, "no setting 'hight'"):
            vantage.Site.open(FOUR_WALLS, hight=2)
        with self.assertRaisesRegex(vantage.Error, "^height: 'tall' is not a number"):
            vantage.Site.open(FOUR_WALLS, height="tall")
        site = vantage.Site.open(FOUR_WALLS, **COARSE)
        with self.assertRaisesRegex(vantage.Error, "^capture: "):
            site.plan(capture=2)
        with self.assertRaisesRegex(TypeError, "contains the whole question"):
            site.plan(vantage.coverage_fix(3), stations=3)

    def test_a_list_is_given_value_by_value(self):
        site = vantage.Site.open(FOUR_WALLS, **COARSE, weight=["wall*=5"])
        self.assertEqual({mesh.weight for mesh in site.scene.meshes}, {5})


if __name__ == "__main__":
    unittest.main()
