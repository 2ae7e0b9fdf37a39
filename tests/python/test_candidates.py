# SPDX-License-Identifier: Apache-2.0
import math
import unittest

import numpy as np
import vantage
from sites import four_walls_site


class CandidatesAndBounds(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.site = four_walls_site()
        cls.simulator = cls.site.simulator
        cls.found = vantage.find_candidates(cls.site, first=32, most=64, sample_voxels=800)

    def test_candidates_may_be_stood_on(self):
        self.assertEqual(len(self.found), 64)
        self.assertEqual(self.found.ended, "enough")
        grounds = np.array([station.ground for station in self.found.stations])
        self.assertFalse(self.site.clash.clashes(grounds, self.simulator.scanner.height_m).any())

    def test_columns_add_up_to_what_a_network_covers(self):
        sampled, chosen = self.found.coverage, [3, 17, 40]
        matrix = sampled.matrix
        amounts = np.zeros(len(sampled.voxels), int)
        for k in chosen:
            element, amount = matrix.column(k).T
            amounts[element] += amount
        share = np.minimum(amounts / matrix.goal, 1).mean()
        self.assertAlmostEqual(sampled.coverage(chosen)[0], share, places=12)
        self.assertAlmostEqual(matrix.coverage(chosen), share, places=12)
        network = vantage.heads([self.found.stations[k] for k in chosen])
        evaluated, = self.simulator.evaluate_sampled([network], voxels=800)
        self.assertAlmostEqual(evaluated.coverage, share, places=12)
        again = vantage.sample_coverage(self.simulator, self.found.stations[:2], sample_voxels=800)
        np.testing.assert_array_equal(again.matrix.column(1), matrix.column(1))
        for wrong in (lambda: matrix.column(len(matrix)), lambda: matrix.coverage([len(matrix)])):
            with self.assertRaises(IndexError):
                wrong()

    def test_no_choice_passes_the_bound(self):
        sampled = self.found.coverage
        best = vantage.max_cover(sampled.matrix, 3)
        self.assertTrue(best.complete)
        self.assertEqual(len(best.chosen), 3)
        self.assertAlmostEqual(sampled.coverage(best.chosen)[0], best.coverage, places=12)
        random = np.random.default_rng(1)
        for _ in range(200):
            chosen = random.choice(len(sampled), 3, replace=False)
            self.assertLessEqual(sampled.coverage(chosen)[0], best.bound + 1e-12)
        wanted = vantage.min_cover(sampled.matrix, 0.9 * self.found.attainable[0])
        self.assertTrue(wanted.possible)
        self.assertLessEqual(wanted.at_least, len(wanted.chosen))
        with self.assertRaisesRegex(vantage.Error, "number of stations"):
            vantage.max_cover(sampled.matrix, 0)

    def test_greedy_and_swaps_keep_what_exists(self):
        matrix = self.found.coverage.matrix
        chosen = vantage.greedy(matrix, 3, [5])
        self.assertEqual(chosen[0], 5)
        self.assertEqual(len(chosen), 4)
        better = vantage.improve_by_swaps(matrix, chosen, [5])
        self.assertEqual(better[0], 5)
        self.assertGreaterEqual(matrix.coverage(better), matrix.coverage(chosen))
        with self.assertRaisesRegex(vantage.Error, "begin with"):
            vantage.improve_by_swaps(matrix, [1, 2], [5])

    def test_linked_choices_are_connected(self):
        graph = vantage.overlap_graph(self.simulator, self.found.stations, sample_voxels=2000)
        overlaps, matrix = graph.overlaps, self.found.coverage.matrix
        self.assertEqual(overlaps.shape, (64, 64))
        np.testing.assert_array_equal(overlaps, overlaps.T)
        linked = vantage.max_cover(matrix, 3, graph=graph, link=0.3, exact_seconds=2)
        among = [(a, b) for a in linked.chosen for b in linked.chosen if a < b and overlaps[a, b] >= 0.3]
        self.assertEqual(len(linked.chosen), 3)
        self.assertGreaterEqual(len(among), 2)  # of three stations: a tree
        self.assertLessEqual(linked.bound, vantage.max_cover(matrix, 3).bound + 1e-12)
        few = vantage.min_connected_cover(matrix, 0.8 * self.found.attainable[0], graph, 0.3)
        self.assertEqual(few.violation, 0)
        self.assertGreaterEqual(few.link, 0.3)

    def test_problems_of_ones_own(self):
        matrix = vantage.CoverageMatrix([1, 1, 2], goal=10, amounts=[[10, 0, 0], [0, 5, 10], [0, 10, 0]])
        self.assertEqual(vantage.greedy(matrix, 2), [1, 0])
        overlaps = [[0, 0.5, 0.5], [0.5, 0, 0.5], [0.5, 0.5, 0]]
        graph = vantage.StationGraph(overlaps)
        best = vantage.max_cover(matrix, 2, graph=graph, link=0.5, exact_seconds=5)
        self.assertEqual(sorted(best.chosen), [0, 1])
        self.assertAlmostEqual(best.bound, 0.875, places=5)
        graph = vantage.StationGraph(overlaps, excluded=[(0, 1)])
        apart = vantage.max_cover(matrix, 2, graph=graph, link=0.5, exact_seconds=5)
        self.assertEqual(sorted(apart.chosen), [1, 2])
        for wrong in (lambda: vantage.StationGraph([1, 2]),
                      lambda: vantage.CoverageMatrix([1], goal=0, amounts=[]),
                      lambda: vantage.CoverageMatrix([1], goal=1, amounts=[[1, 2]]),
                      lambda: vantage.max_cover(matrix, 1, link=0.5)):
            with self.assertRaises(vantage.Error):
                wrong()

    def test_the_exact_network_keeps_apart(self):
        def exact(apart_m):
            found = vantage.exact_network(
                self.site, 3, candidates=24, sample_voxels=400, max_seconds=20, apart_m=apart_m)
            heads = [s.position for s in found.stations]
            return found, min(math.dist(a, b) for i, a in enumerate(heads) for b in heads[:i])

        anyhow, near = exact(0)
        apart, far = exact(1.5 * near)
        self.assertGreaterEqual(far, 1.5 * near)
        self.assertLessEqual(apart.choice.coverage, anyhow.choice.bound + 1e-12)
        with self.assertRaises(vantage.Error):
            exact(-1)

    def test_the_exact_network_is_no_worse_than_the_greedy_one(self):
        exact = vantage.exact_network(self.site, 2, candidates=24, sample_voxels=400, max_seconds=5)
        self.assertEqual(len(exact.stations), 2)
        self.assertLessEqual(exact.choice.coverage, exact.choice.bound + 1e-12)
        sampled = vantage.sample_coverage(self.simulator, exact.stations, sample_voxels=400)
        self.assertAlmostEqual(sampled.coverage()[0], exact.choice.coverage, places=12)

    def test_a_sample_may_be_of_every_voxel(self):
        every = vantage.greedy_network(self.site, 1, candidates=8, sample_voxels=None)
        covered = self.simulator.evaluate(vantage.heads(every.stations)).coverage
        self.assertAlmostEqual(every.coverage[0], covered, places=12)
        with self.assertRaises(vantage.Error):
            vantage.find_candidates(self.site, sample_voxels=0)

    def test_greedy_takes_the_best_first(self):
        greedy = vantage.greedy_network(self.site, 3, candidates=50, sample_voxels=800)
        self.assertEqual(len(greedy.stations), 3)
        self.assertEqual(greedy.coverage, sorted(greedy.coverage))


if __name__ == "__main__":
    unittest.main()
