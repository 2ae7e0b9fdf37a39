# SPDX-License-Identifier: Apache-2.0
"""Scans a site from the first free spot of its search area, and keeps the points: scan_station.py SCENE POINTS.npz"""
import sys

import numpy as np
import vantage

if len(sys.argv) != 3:
    sys.exit(__doc__)
site = vantage.Site.open(sys.argv[1], step=0.2, height=1.5)
area, height_m = site.area, site.scanners[0].height_m

# A grid over (u, v): where there is ground, and nothing close to it.
u, v = np.meshgrid(*(np.linspace(low, high, 18)[1:-1] for low, high in zip(area.uv_min, area.uv_max)))
grounds = area.locate(np.column_stack([u.ravel(), v.ravel()]))
grounds = grounds[~np.isnan(grounds[:, 0])]
grounds = grounds[~site.clash.clashes(grounds, height_m)]
if len(grounds) == 0:
    sys.exit("no place to stand")
head = grounds[0] + [0, 0, height_m]

scan = site.simulator.scan(head, ["position", "reflectivity", "mesh"])
np.savez(sys.argv[2], position=scan.position, intensity=scan.reflectivity, row=scan.row, column=scan.column)

print(f"{scan.rays} rays, {len(scan)} points from ({head[0]:.3f}, {head[1]:.3f}, {head[2]:.3f})")
for number in np.unique(scan.mesh):
    on_it = scan.mesh == number
    print(f"{site.scene.meshes[number].name}: {on_it.sum()} points, the nearest at {scan.range_m[on_it].min():.2f} m")
