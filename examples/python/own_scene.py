# SPDX-License-Identifier: Apache-2.0
"""Makes a scene from arrays, evaluates two stations in it, moves one of its meshes and evaluates them again:
own_scene.py"""
import itertools

import numpy as np
import vantage


def box(low, high):
    """Corners and triangles of a closed box: (8, 3) and (12, 3)."""
    corners = np.array([[x, y, z] for z, y, x in itertools.product(*zip(low[::-1], high[::-1]))])
    triangles = [[0, 2, 1], [1, 2, 3], [4, 5, 6], [5, 7, 6], [0, 1, 4], [1, 5, 4],
                 [2, 6, 3], [3, 6, 7], [0, 4, 2], [2, 4, 6], [1, 3, 5], [3, 7, 5]]
    return corners, np.array(triangles)


def evaluate(scene, heads):
    scanner = vantage.Scanner(azimuth_step_deg=0.25, zenith_step_deg=0.25)
    simulator = vantage.Simulator(scene, scanner, user_size_m=0.1, point_spacing_m=0.05)
    return simulator.evaluate(heads, surroundings=True, registration=vantage.RegistrationOptions())


builder = vantage.SceneBuilder()
builder.add(*box([-6, -5, -0.2], [6, 5, 0]), name="floor", role="blocking")
builder.add(*box([-6, 4, 0.001], [6, 4.2, 3]), name="wall", role="surveyed")
builder.add(*box([3, -4, 0.001], [3.5, -3, 2]), name="pillar", role="surveyed")
crate = builder.add(*box([-1, 2, 0.001], [1, 3, 2.2]), name="crate", role="blocking")

heads = [[-2, 0, 1.6], [2, 0, 1.6]]
for when, move in [("before the wall", [0, 0, 0]), ("out of the way", [-4, -6, 0.01])]:
    builder.move(crate, move)
    found = evaluate(builder.build(), heads)
    print(f"crate {when}: coverage {found.coverage:.3f}, scans share {found.scan_overlap_matrix[0, 1]:.3f}, "
          f"registered to {1e3 * found.registration.rms_m:.1f} mm")
