# SPDX-License-Identifier: Apache-2.0
"""Traces rays that belong to no scanner: own_rays.py SCENE X Y Z [ENGINE]

Looks around from a point with a million rays, says what is nearest and how open the place is, and which of a line of
points it sees."""
import sys

import numpy as np
import vantage

if len(sys.argv) not in (5, 6):
    sys.exit(__doc__)
scene = vantage.Scene.load(sys.argv[1])
eye = np.array(sys.argv[2:5], float)

# Directions that are spread evenly over the sphere, by the golden angle.
many = 1_000_000
z = 1 - (2 * np.arange(many) + 1) / many
around, level = 2.399963229728653 * np.arange(many), np.sqrt(1 - z * z)
directions = np.column_stack([level * np.cos(around), level * np.sin(around), z])

# "auto" is the best graphics card, if there is one. The answers are the same.
tracer = vantage.RayTracer(scene, engine=sys.argv[5] if len(sys.argv) == 6 else "embree")
hits = tracer.nearest(eye, directions)
for index in np.unique(hits.mesh[hits.mesh >= 0]):
    print(f"{scene.meshes[index].name}: {np.count_nonzero(hits.mesh == index)} rays")
nearest = np.argmin(hits.range_m)
print(f"nearest surface at {hits.range_m[nearest]:.2f} m, at {np.round(hits.position[nearest], 2)}")

blocked = tracer.blocked(eye, directions, ranges_m=10)  # whether anything is met takes less time than what
print(f"{100 * (1 - blocked.mean()):.1f} % of the view is open for 10 m")

line = eye + np.column_stack([np.arange(-20, 21), np.full(41, 20), np.zeros(41)])
print(f"sees {vantage.ClashChecker(scene).sees(eye, line).sum()} of {len(line)} points")
