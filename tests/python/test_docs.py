# SPDX-License-Identifier: Apache-2.0
"""What docs/python.md prints runs, block after block, from the root of the source tree."""
import os
import re
import unittest

from sites import SOURCE


class Tour(unittest.TestCase):
    def test_every_block_runs(self):
        with open(os.path.join(SOURCE, "docs", "python.md"), encoding="utf-8") as file:
            blocks = re.findall(r"```python\n(.*?)```", file.read(), re.DOTALL)
        self.assertGreater(len(blocks), 5)
        here, names = os.getcwd(), {}
        os.chdir(SOURCE)
        try:
            for block in blocks:
                exec(compile(block, "docs/python.md: " + block.split("\n")[0], "exec"), names)
        finally:
            os.chdir(here)
        self.assertGreater(len(names["near"]), 0)
        self.assertEqual(names["image"].astype(bool).sum(), len(names["scan"]))
        self.assertEqual(names["mixed"].stations, 2)
        self.assertEqual(names["several"][1].stations, 2)
        self.assertEqual((names["after"].bounds - names["before"].bounds).tolist(), [[0, 1, 0]] * 2)
        self.assertLessEqual(names["best"].coverage, names["best"].bound)
        self.assertIn("neighbour", names["result"].measures)
        self.assertEqual(names["everything"]["problem"], "coverage-overlap-fix")
