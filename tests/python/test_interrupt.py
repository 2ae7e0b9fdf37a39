# SPDX-License-Identifier: Apache-2.0
"""Ctrl-C, as it comes from a terminal: a signal to another process."""
import os
import signal
import subprocess
import sys
import tempfile
import unittest

LONG = """
import vantage
from sites import four_walls, four_walls_site
simulator = four_walls(max_rays_per_dispatch=20_000)
begun = []
def report(now):
    if not begun:
        begun.append(now)
        print("begun", flush=True)
try:
    {call}
except KeyboardInterrupt:
    print("interrupted", flush=True)
print("simulator usable:", simulator.evaluate([[0, 0, 1.5]]).coverage > 0, flush=True)
"""
PLAN = ("four_walls_site().plan(vantage.coverage_overlap_fix(8), iterations=10**8, sample=2000, "
        "checkpoint={checkpoint!r}, progress=report)")
EVALUATE = "while True: simulator.evaluate([[0, 0, 1.5]] * 64, skip=False, progress=report)"


class Interrupts(unittest.TestCase):
    def interrupt(self, call):
        script = [sys.executable, "-c", LONG.format(call=call)]
        with subprocess.Popen(script, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
            self.assertEqual(process.stdout.readline(), "begun\n")
            process.send_signal(signal.SIGINT)
            out, err = process.communicate(timeout=200)
        self.assertEqual(process.returncode, 0, err)
        self.assertEqual(out, "interrupted\nsimulator usable: True\n", err)

    def test_a_search_ends_and_leaves_its_checkpoint(self):
        with tempfile.TemporaryDirectory() as folder:
            checkpoint = os.path.join(folder, "checkpoint")
            self.interrupt(PLAN.format(checkpoint=checkpoint))
            self.assertTrue(os.path.exists(checkpoint))

    def test_tracing_ends(self):
        self.interrupt(EVALUATE)


if __name__ == "__main__":
    unittest.main()
