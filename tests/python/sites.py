# SPDX-License-Identifier: Apache-2.0
"""What the tests look at: the four walls of the paper in steps of 0.2 degrees, and a wall of one's own."""
import json
import os
import subprocess

import numpy as np
import vantage

SOURCE = os.environ["VANTAGE_SOURCE"]
FOUR_WALLS = os.path.join(SOURCE, "data", "four_walls.glb")
COARSE = ["--step", "0.2", "--user-size", "0.2", "--spacing", "0.03", "--height", "1.5", "--engine", "embree"]
BEFORE_EACH_WALL = [[8, 0, 1.5], [-8, 0, 1.5], [0, 8, 1.5], [0, -8, 1.5]]


def four_walls(**config):
    scanner = vantage.Scanner(azimuth_step_deg=0.2, zenith_step_deg=0.2, height_m=1.5)
    config = {"engine": "embree", "user_size_m": 0.2, "point_spacing_m": 0.03, **config}
    return vantage.Simulator(vantage.Scene.load(FOUR_WALLS), scanner, **config)


def four_walls_site(**settings):
    """The same as a site."""
    return vantage.Site.open(FOUR_WALLS, **{"step": 0.2, "height": 1.5, "user_size": 0.2, "spacing": 0.03,
                                            "engine": "embree", **settings})


def wall(offset=(0.0, 0.0, 0.0)):
    """Corners and triangles of a wall 4 m wide and 2 m high, 3 m north of the offset: it faces south."""
    corners = np.array([[-2, 3, -1], [2, 3, -1], [2, 3, 1], [-2, 3, 1]], float) + offset
    return corners, np.array([[0, 1, 2], [0, 2, 3]])


def program(*arguments):
    """The program's run: (exit code, standard output, standard error)."""
    run = subprocess.run([os.environ["VANTAGE_PROGRAM"], *map(str, arguments)], capture_output=True, text=True)
    return run.returncode, run.stdout, run.stderr


def program_json(*arguments):
    code, out, err = program(*arguments, "--json")
    assert code == 0, err
    return json.loads(out)
