# SPDX-License-Identifier: Apache-2.0
import json
import os
import tempfile
import unittest

import numpy as np
import vantage
from sites import COARSE, FOUR_WALLS, four_walls_site, program

SEED = 7
SMALL = {"population": 10, "iterations": 5, "sample": 500}


class Plans(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.site = four_walls_site(seed=SEED)
        cls.simulator = cls.site.simulator

    def plan(self, problem, **options):
        return self.site.plan(problem, **{**SMALL, **options})

    def assert_same_front(self, a, b):
        self.assertEqual(len(a.front), len(b.front))
        for one, other in zip(a.front, b.front):
            np.testing.assert_array_equal(one.x, other.x)
            self.assertEqual(one.value("coverage"), other.value("coverage"))

    def test_the_program_finds_the_same(self):
        found = self.plan(vantage.coverage_overlap_fix(4)).to_dict()
        with tempfile.TemporaryDirectory() as folder:
            code, _, text = program(
                "plan", FOUR_WALLS, *COARSE, "--problem", "coverage-overlap-fix", "--stations", 4, "--population", 10,
                "--iterations", 5, "--sample", 500, "--seed", SEED, "-o", os.path.join(folder, "plan"))
            self.assertEqual(code, 0, text)
            with open(os.path.join(folder, "plan", "front.json")) as file:
                told = json.load(file)
        for key in ("front", "hypervolume", "exact_hypervolume", "evaluations", "answer", "engine", "seed"):
            self.assertEqual(found[key], told[key], key)

    def test_objectives_in_python_are_searched_as_built_in_ones(self):
        built_in = self.plan(vantage.coverage_overlap_fix(4))
        own = self.plan(vantage.SurveyProblem(objectives=[
            vantage.Objective("own_coverage", lambda network: network.evaluation.coverage, vantage.maximise(1, 0)),
            vantage.Objective("own_overlap", lambda network: network.evaluation.overlap, vantage.maximise(1, 0),
                              pairs=True)]))
        self.assert_same_front(built_in, own)
        self.assertEqual(built_in.hypervolume, own.hypervolume)
        entry = own.answer
        self.assertEqual(entry.value("own_coverage"), entry.value("coverage"))
        self.assertGreater(entry.values["own_coverage"].standard_error, 0)
        self.assertEqual(self.simulator.evaluate(entry.heads).coverage, entry.value("coverage"))

    def test_objectives_in_python_may_look_at_registration(self):
        options = vantage.RegistrationOptions()
        own = vantage.Objective("own_mm", lambda network: 1e3 * network.evaluation.registration.rms_m,
                                vantage.minimise(0, 100), registration=options)
        answer = self.plan(vantage.SurveyProblem(objectives=[own, "registration"]), population=4, iterations=2).answer
        expected = 1e3 * self.simulator.evaluate(answer.heads, registration=options).registration.rms_m
        self.assertEqual(answer.value("own_mm"), expected)
        self.assertEqual(answer.value("registration"), expected)
        self.assertEqual(1e3 * answer.registration.rms_m, expected)

    def test_objectives_say_which_way_is_better(self):
        with self.assertRaises(TypeError):
            vantage.Objective("walk", lambda network: 1)
        for way, best, worst in (vantage.minimise, 1, 0), (vantage.maximise, 0, 1), (vantage.minimise, 0, np.inf):
            with self.assertRaisesRegex(vantage.Error, f"{way.__name__}: the scale must have best .= worst"):
                way(best, worst)
        walk = vantage.Objective("walk", lambda network: 1, vantage.minimise(0, 20), unit="m")
        self.assertEqual((walk.scale.best, walk.scale.worst, repr(walk.scale)), (0, 20, "vantage.minimise(0.0, 20.0)"))

    def test_requirements_and_kept_stations_hold(self):
        problem = vantage.SurveyProblem(
            stations_min=3, stations_max=3, existing=[(0, 0, 1.5)], objectives=["overlap"],
            requirements=["coverage >= 0.6"])
        problem.requirements += (vantage.Requirement(problem.objectives[0], "<=", 1.0),)
        self.assertEqual([str(each) for each in problem.requirements], ["coverage >= 0.6", "overlap <= 1"])
        found = self.plan(problem)
        self.assertTrue(found.met)
        self.assertEqual(found.what_would_help, [])
        answer = found.answer
        self.assertGreaterEqual(answer.value("coverage"), 0.6)
        self.assertEqual([station.existing for station in answer.stations], [True, False, False, False])
        np.testing.assert_array_equal(answer.heads[0], [0, 0, 1.5])
        self.assertIn("captured", found.summary)
        with self.assertRaises(AttributeError):
            problem.objectives.append("coverage")

    def test_stations_choose_their_scanner_beside_kept_ones_as_set_up(self):
        steps = [vantage.Scanner(azimuth_step_deg=step, zenith_step_deg=step, height_m=1.5) for step in (0.2, 0.5)]
        site = vantage.Site(self.site.scene, scanners=steps, engine="embree", user_size=0.2, spacing=0.03, seed=SEED)
        lying = vantage.StationSetup(tilt_deg=90)
        problem = vantage.SurveyProblem(stations_min=3, stations_max=3, existing=[(8, 0, 1.5)], existing_setups=[lying],
                                        scanners=site.scanners, objectives=["coverage", "time"])
        self.assertEqual(problem.existing_setups, (lying,))
        self.assertEqual([s.azimuth_step_deg for s in problem.scanners], [0.2, 0.5])
        found = site.plan(problem, **SMALL)
        self.assertEqual([s.azimuth_step_deg for s in found.scanners], [0.2, 0.5])
        chosen = set()
        for entry in found.front:
            self.assertEqual(entry.stations[0].setup, lying)
            self.assertEqual(len(entry.x), 3 * 3)
            for station, share in zip(entry.stations[1:], entry.x[6:]):
                self.assertEqual(station.setup, vantage.StationSetup(scanner=int(2 * share)))
                chosen.add(station.setup.scanner)
            self.assertEqual(site.simulator.evaluate(entry.stations).coverage, entry.value("coverage"))
        self.assertEqual(chosen, {0, 1})
        told = found.to_dict()["front"][0]["stations"][0]
        self.assertEqual((told["tilt"], told["step"]), (90, 0.2))

    def test_what_a_problem_holds_is_in_tuples(self):
        problem = vantage.SurveyProblem(existing=iter([[1, 2, 3]]), heights_m=[1, 2], objectives=["coverage"])
        self.assertEqual(problem.existing, ((1, 2, 3),))
        self.assertEqual(problem.heights_m, (1, 2))
        self.assertEqual([objective.name for objective in problem.objectives], ["coverage"])
        with self.assertRaisesRegex(TypeError, r"objectives: \[3\] is no Tuple\[Union\[str, vantage.Objective\], ...\]"):
            problem.objectives = [3]

    def test_the_surveyors_question_is_answered(self):
        found = self.plan(vantage.fewest_stations(capture=0.8, stations_max=6), iterations=2)
        self.assertTrue(found.met)
        self.assertGreaterEqual(found.answer.value("capture"), 0.8)

    def test_progress_is_told_and_may_end_the_search(self):
        told = []
        found = self.plan(vantage.coverage_overlap_fix(4), progress=told.append)
        self.assertEqual([now.phase for now in told if now.phase in ("look", "choose")], [])
        searching = [now for now in told if now.phase == "search"]
        self.assertEqual(searching[-1].evaluations, found.evaluations)
        self.assertEqual(searching[-1].front.shape[1], 2)
        self.assertIn(searching[-1].hypervolume, [line["hypervolume"] for line in found.history])
        self.assertEqual(found.history[-1]["hypervolume"], found.hypervolume)
        stopped = self.plan(
            vantage.coverage_overlap_fix(4), iterations=1000, progress=lambda now: now.iteration < 3)
        self.assertEqual(stopped.stop_reason, "cancelled")
        self.assertLess(stopped.evaluations, 1000)
        self.assertTrue(all(entry.confirmed for entry in stopped.front))

    def test_what_python_raises_comes_through(self):
        def fail(_):
            raise LookupError("no such thing")

        with self.assertRaisesRegex(LookupError, "no such thing"):
            self.plan(vantage.SurveyProblem(objectives=[vantage.Objective("fails", fail, vantage.maximise(1, 0))]))
        with self.assertRaisesRegex(LookupError, "no such thing"):
            self.plan(vantage.coverage_fix(4), progress=fail)
        with self.assertRaisesRegex(TypeError, "must be real number"):
            self.plan(vantage.SurveyProblem(objectives=[vantage.Objective("text", lambda network: "much", vantage.maximise(1, 0))]))
        with self.assertRaisesRegex(vantage.Error, "population: '-1'"):
            self.plan(vantage.coverage_fix(4), population=-1)
        with self.assertRaisesRegex(vantage.Error, "nonsense"):
            vantage.SurveyProblem(objectives=["nonsense"])

    def test_an_ended_search_goes_on_to_the_same_bits(self):
        whole = self.plan(vantage.coverage_overlap_fix(4))
        with tempfile.TemporaryDirectory() as folder:
            file = os.path.join(folder, "checkpoint")

            def interrupt(now):
                if now.iteration == 2:
                    raise KeyboardInterrupt

            with self.assertRaises(KeyboardInterrupt):
                self.plan(vantage.coverage_overlap_fix(4), checkpoint=file, progress=interrupt)
            resumed = self.plan(vantage.coverage_overlap_fix(4), checkpoint=file, resume=True)
        self.assert_same_front(whole, resumed)
        self.assertEqual(whole.hypervolume, resumed.hypervolume)

    def test_a_result_outlives_what_it_was_made_with(self):
        site = four_walls_site()
        found = site.plan(vantage.coverage_fix(3), **SMALL)
        del site
        entry = found.answer
        with tempfile.TemporaryDirectory() as folder:
            found.write(os.path.join(folder, "plan"))
            written = os.listdir(os.path.join(folder, "plan"))
        self.assertLessEqual({"front.json", "front.csv", "stations.csv", "plan.png"}, set(written))
        self.assertEqual(json.loads(json.dumps(found.to_dict()))["problem"], "coverage-fix")
        del found
        self.assertEqual(entry.heads.shape, (3, 3))


if __name__ == "__main__":
    unittest.main()
