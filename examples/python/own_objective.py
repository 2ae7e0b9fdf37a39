# SPDX-License-Identifier: Apache-2.0
"""Searches for an objective that the library does not know, under a requirement: own_objective.py SCENE N FOLDER

No scan should stand alone. For every station take the neighbour that shares most with it, as a share of the smaller
scan; the least of these is to be as large as can be, and the coverage at least 0.5."""
import sys

import vantage


def loneliest(network):
    return network.evaluation.scan_overlap_matrix.max(axis=1).min()


def report(now):
    print(f"\r{now.phase} {now.iteration} of {now.iterations}, hypervolume {now.hypervolume:.3f}", end="",
          file=sys.stderr)


if len(sys.argv) != 4:
    sys.exit(__doc__)
site = vantage.Site.open(sys.argv[1], step=0.2, height=1.5, user_size=0.2, spacing=0.05, seed=42)

stations = int(sys.argv[2])
neighbour = vantage.Objective(
    "neighbour", loneliest, vantage.maximise(1, 0), label="What the loneliest scan shares with its neighbour",
    surroundings=True)
problem = vantage.SurveyProblem(
    stations_min=stations, stations_max=stations, objectives=["coverage", neighbour], requirements=["coverage >= 0.5"])
result = site.plan(problem, population=20, iterations=10, sample=5000, progress=report)
print(file=sys.stderr)

for entry in result.front:
    broken = "  (misses what is required)" if entry.missed > 0 else ""
    print(f"coverage {entry.value('coverage'):.3f}, neighbour {entry.value('neighbour'):.3f}{broken}")
print(result.summary, end="")
result.write(sys.argv[3])
