# SPDX-License-Identifier: Apache-2.0
"""Next stations are those of the program, to the last digit."""
import csv
import os
import tempfile
import unittest

import vantage
from sites import COARSE, FOUR_WALLS, four_walls_site, program, program_json

HEADS = [[8, 0, 1.5], [0, -8, 1.5], [0, 8, 1.5]]


class Next(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.scans = os.path.join(cls.folder.name, "day.e57")
        code, _, err = program("scan", FOUR_WALLS, *COARSE, "--station", "8,0,1.5", "-o", cls.scans)
        assert code == 0, err
        cls.plan = os.path.join(cls.folder.name, "plan.csv")
        with open(cls.plan, "w") as file:
            file.write("name,x,y,z\n" + "".join(f"{n},{x},{y},{z}\n" for n, (x, y, z) in zip("ABC", HEADS)))
        cls.site = four_walls_site()
        cls.found = cls.site.next(cls.scans, HEADS, planned_names=["A", "B", "C"], link=0, capture=0.8)

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def test_are_those_of_the_program(self):
        told = program_json("next", FOUR_WALLS, *COARSE, "--scans", self.scans, "--stations", self.plan, "--link", "0",
                            "--capture", "0.8", "-o", os.path.join(self.folder.name, "program"))
        self.assertEqual(self.found.to_dict(), told)
        folder = os.path.join(self.folder.name, "module")
        self.found.write(folder)
        for name in ("next.json", "stations.csv", "plan.png"):
            with open(os.path.join(folder, name), "rb") as ours, \
                    open(os.path.join(self.folder.name, "program", name), "rb") as theirs:
                self.assertEqual(ours.read(), theirs.read(), name)
        with open(os.path.join(folder, "stations.csv"), newline="") as file:
            self.assertEqual([row["name"] for row in csv.DictReader(file)], self.found.names[1:])

    def test_tell_what_was_taken_and_what_comes_next(self):
        found = self.found
        self.assertEqual(len(found.taken), 1)
        self.assertEqual(found.names[0], "A")
        self.assertEqual(len(found.names), 1 + len(found.stations))
        self.assertTrue(found.enough)
        self.assertGreaterEqual(found.captured_then, 0.8)
        self.assertLess(found.captured[0], 0.8)
        self.assertGreater(found.visit.minutes, 0)
        self.assertTrue(found.taken[0].existing)
        again = found.found.evaluate(found.taken + found.stations, sample_voxels=500)
        self.assertGreater(again.coverage, 0.3)

    def test_without_a_plan(self):
        self.assertEqual(self.site.next(self.scans, link=0, capture=0.3).to_dict()["planned"], [])

    def test_stop_when_progress_says_so(self):
        self.assertIsNone(self.site.next(self.scans, link=0, progress=lambda done: False))

    def test_refuse_what_makes_no_sense(self):
        with self.assertRaisesRegex(TypeError, "Site.next: there is no setting 'stations'"):
            self.site.next(self.scans, stations=3)
        with self.assertRaisesRegex(vantage.Error, "planned_names: one for each"):
            self.site.next(self.scans, HEADS, planned_names=["A"])
        with self.assertRaisesRegex(vantage.Error, "there is no such file or folder of scans"):
            self.site.next("none.e57")


if __name__ == "__main__":
    unittest.main()
