# SPDX-License-Identifier: Apache-2.0
"""Evaluates a station while something on the site moves, as a crane or a vehicle does: changed_scene.py SCENE X Y Z PATTERN

Moves the meshes whose names match the pattern along x, a metre at a time, and lets one simulator take each scene."""
import sys
import time

import numpy as np
import vantage

if len(sys.argv) != 6:
    sys.exit(__doc__)
first = vantage.Scene.load(sys.argv[1])
heads = np.array([sys.argv[2:5]], float)
scanner = vantage.Scanner(azimuth_step_deg=0.2, zenith_step_deg=0.2)

start = time.perf_counter()
simulator = vantage.Simulator(first, scanner, engine="embree", user_size_m=0.1, point_spacing_m=0.02)
print(f"a new simulator: {1e3 * (time.perf_counter() - start):.1f} ms")
for metres in range(4):
    # Each scene is made of the first, so that roundings do not add up.
    moved = first.with_changes(move={sys.argv[5]: (metres, 0, 0)})
    start = time.perf_counter()
    kept = simulator.set_scene(moved)
    taken = 1e3 * (time.perf_counter() - start)
    how = "" if kept else " by making all anew"
    print(f"{metres} m: taken in {taken:.1f} ms{how}, coverage {simulator.evaluate(heads).coverage:.3f}")
without = first.with_changes(remove=[sys.argv[5]])
simulator.set_scene(without)
print(f"gone: {len(without.meshes)} meshes, coverage {simulator.evaluate(heads).coverage:.3f}")
