# SPDX-License-Identifier: Apache-2.0
import math
import unittest

import numpy as np
import vantage
from sites import four_walls


class CandidatesAndBounds(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.simulator = four_walls()
        cls.area = vantage.SearchArea(cls.simulator.scene)
        cls.clash = vantage.ClashChecker(cls.simulator.scene)
        cls.found = vantage.find_candidates(
            cls.simulator, cls.area, cls.clash, first=32, most=64, sample_voxels=800)

    def test_candidates_may_be_stood_on(self):
        self.assertEqual(len(self.found), 64)
        self.assertEqual(self.found.ended, "enough")
        grounds = np.array([station.ground for station in self.found.stations])
        self.assertFalse(self.clash.clashes(grounds, self.simulator.scanner.height_m).any())

    def test_rows_add_up_to_what_a_network_captures(self):
        rows, chosen = self.found.rows, [3, 17, 40]
        points = np.zeros(len(rows.voxels), int)
        for k in chosen:
            voxel, count = rows.row(k).T
            points[voxel] += count
        share = np.minimum(points / rows.goal_density, 1).mean()
        self.assertAlmostEqual(rows.coverage(chosen)[0], share, places=12)
        network = vantage.heads([self.found.stations[k] for k in chosen])
        sampled, = self.simulator.evaluate_sampled([network], voxels=800)
        self.assertAlmostEqual(sampled.coverage, share, places=12)
        again = vantage.capture_rows(self.simulator, self.found.stations[:2], sample_voxels=800)
        np.testing.assert_array_equal(again.row(1), rows.row(1))
        with self.assertRaises(IndexError):
            rows.row(len(rows))

    def test_no_choice_passes_the_bound(self):
        rows = self.found.rows
        bound = vantage.bound_capture(rows, 3)
        self.assertTrue(bound.complete)
        self.assertEqual(len(bound.chosen), 3)
        self.assertEqual(rows.coverage(bound.chosen)[0], bound.reached[0])
        random = np.random.default_rng(1)
        for _ in range(200):
            chosen = random.choice(len(rows), 3, replace=False)
            self.assertLessEqual(rows.coverage(chosen)[0], bound.bound + 1e-12)
        wanted = vantage.bound_stations(rows, 0.9 * self.found.visible[0])
        self.assertTrue(wanted.possible)
        self.assertLessEqual(wanted.at_least, len(wanted.chosen))
        self.assertEqual(vantage.choose_rows(rows, 2, [5])[0], 5)
        with self.assertRaisesRegex(vantage.Error, "At least 1"):
            vantage.bound_capture(rows, 0)

    def test_linked_choices_hang_together(self):
        links = vantage.links_between(self.simulator, self.found.stations, 0.3, sample_voxels=2000)
        self.assertTrue(all(a < b < len(self.found) for a, b in links))
        any_choice = vantage.bound_capture(self.found.rows, 3)
        linked = vantage.bound_linked_capture(self.found.rows, 3, links, exact_seconds=2)
        among = [(a, b) for a, b in links if {a, b} <= set(linked.chosen)]
        self.assertEqual(len(linked.chosen), 3)
        self.assertGreaterEqual(len(among), 2)  # of three stations: a tree
        self.assertLessEqual(linked.bound, any_choice.bound + 1e-12)
        self.assertEqual(self.found.rows.coverage(linked.chosen)[0], linked.reached[0])

    def test_the_exact_network_keeps_apart(self):
        def exact(apart_m):
            found = vantage.exact_network(
                self.simulator, self.area, self.clash, 3, candidates=24, sample_voxels=400, max_seconds=20, apart_m=apart_m)
            heads = [s.position for s in found.stations]
            return found, min(math.dist(a, b) for i, a in enumerate(heads) for b in heads[:i])

        anyhow, near = exact(0)
        apart, far = exact(1.5 * near)
        self.assertGreaterEqual(far, 1.5 * near)
        self.assertLessEqual(apart.choice.reached[0], anyhow.choice.bound + 1e-12)
        with self.assertRaises(vantage.Error):
            exact(-1)

    def test_the_exact_network_is_no_worse_than_the_greedy_one(self):
        exact = vantage.exact_network(
            self.simulator, self.area, self.clash, 2, candidates=24, sample_voxels=400, max_seconds=5)
        self.assertEqual(len(exact.stations), 2)
        self.assertLessEqual(exact.choice.reached[0], exact.choice.bound + 1e-12)
        rows = vantage.capture_rows(self.simulator, exact.stations, sample_voxels=400)
        self.assertAlmostEqual(rows.coverage()[0], exact.choice.reached[0], places=12)

    def test_greedy_takes_the_best_first(self):
        greedy = vantage.greedy_network(self.simulator, self.area, self.clash, 3, candidates=50, sample_voxels=800)
        self.assertEqual(len(greedy.stations), 3)
        self.assertEqual(greedy.coverage, sorted(greedy.coverage))


if __name__ == "__main__":
    unittest.main()
