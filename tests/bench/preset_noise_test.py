#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Scans of the program have the noise of their presets, measured as in real scans: preset_noise_test.py VANTAGE"""
import subprocess
import sys
import tempfile
import unittest

import measure_noise
import scan_files

VANTAGE = sys.argv.pop()
STATION = (12, 7.5, 1.7)


class PresetNoise(unittest.TestCase):
    def test_walls_of_the_office(self):
        with tempfile.TemporaryDirectory() as folder:
            def run(*arguments):
                subprocess.run([VANTAGE, *arguments], cwd=folder, check=True, stdout=subprocess.DEVNULL)

            run("generate", "office", "-o", "office.glb")
            for scanner, sigma in (("vlp-16", 0.010), ("xt32", 0.005)):
                run("scan", "office.glb", "--engine", "embree", "--scanner", scanner,
                    "--station", ",".join(map(str, STATION)), "-o", "scan.ply")
                scan = scan_files.read(f"{folder}/scan.ply", STATION)
                patches = measure_noise.measure([scan], measure_noise.parse(["-"]))
                self.assertGreater(len(patches), 100)
                for figure in ("sigma", "neighbours"):
                    middle, _ = measure_noise.median_and_error([getattr(patch, figure) for patch in patches])
                    self.assertAlmostEqual(middle / sigma, 1, delta=0.05, msg=f"{figure} of {scanner}")
                blocks, error = measure_noise.median_and_error([patch.blocks for patch in patches])
                self.assertLess(abs(blocks - 1), 4 * error, "noise of rays is white")


if __name__ == "__main__":
    unittest.main()
