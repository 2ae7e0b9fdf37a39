# SPDX-License-Identifier: Apache-2.0
"""Scans with a scanner whose rays form no grid: own_pattern.py SCENE X Y Z

The rosette of two turning prisms, of half a second, which looks along +X. Tells how the points come in, and how much
of the site this and a spinning scanner of 16 rows capture from the point."""
import sys

import numpy as np
import vantage

if len(sys.argv) != 5:
    sys.exit(__doc__)
scene = vantage.Scene.load(sys.argv[1])
head = np.array(sys.argv[2:], float)

# Each prism bends the beam by 9.5° towards where it points, so the field is a circle of 38°.
times = np.arange(100_000) / 200_000
first, second = 2 * np.pi * 121.6 * times, -2 * np.pi * 77.7 * times
directions = 9.5 * np.column_stack([np.cos(first) + np.cos(second), np.sin(first) + np.sin(second)])
prisms = vantage.Scanner(name="two prisms", directions_deg=directions, times_s=times, min_range_m=0.5, max_range_m=90,
                         points_per_second=200_000)
spinning = vantage.Scanner(name="16 rows", azimuth_step_deg=0.2, row_zeniths_deg=np.arange(75, 106, 2))

simulator = vantage.Simulator(scene, [prisms, spinning], user_size_m=0.2, point_spacing_m=0.1)
scan = simulator.scan(head, ["position"])
seconds = times[scan.row]  # the row of a point is the number of its ray
print(f"{len(scan)} points of {prisms.rays} rays, the first after {seconds[0]:.4f} s, "
      f"the last after {seconds[-1]:.4f} s")
for k, scanner in enumerate([prisms, spinning]):
    station = vantage.Station(head, setup=vantage.StationSetup(scanner=k))
    print(f"{scanner.name}: coverage {simulator.evaluate([station]).coverage:.4f}")
