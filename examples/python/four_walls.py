# SPDX-License-Identifier: Apache-2.0
"""The four walls of the paper (section 5.1.2): four stations for coverage, then eight for coverage against overlap, and
a figure of both: four_walls.py FIGURE.png [--population M] [--iterations K] [--sample VOXELS] [--seed S]

Left the cartography of coverage with the four stations (figure 7 of the paper), in the middle the front (figure 10),
right one of its networks with its overlap graph (figures 11 and 12)."""
import argparse
import tempfile
from pathlib import Path

import matplotlib

matplotlib.use("agg")
import matplotlib.pyplot as plt
import numpy as np
import vantage


def draw_from_above(axes, simulator, found, heads, title):
    """The walls from above, each column of voxels in the colour of its mean coverage, and the stations."""
    xy, column = np.unique(simulator.voxel_centres()[:, :2].round(6), axis=0, return_inverse=True)
    covered = np.minimum(found.voxel_points / found.goal_density, 1)
    share = np.bincount(column, covered) / np.bincount(column)
    walls = axes.scatter(*xy.T, c=share, cmap="RdYlGn", vmin=0, vmax=1, s=9, marker="s", linewidths=0)
    axes.scatter(*heads[:, :2].T, c="black", s=45, zorder=3)
    for number, (x, y, _) in enumerate(heads, 1):
        axes.annotate(f"S{number}", (x, y), xytext=(6, 5), textcoords="offset points", fontsize=8, zorder=4,
                      bbox={"facecolor": "white", "alpha": 0.7, "pad": 1, "linewidth": 0})
    reach = 1.12 * np.abs(heads[:, :2]).max()
    axes.set(title=title, xlabel="x (m)", ylabel="y (m)", aspect="equal", xlim=(-reach, reach), ylim=(-reach, reach))
    return walls


def draw_links(axes, heads, overlap, least=0.01):
    for i, j in zip(*np.nonzero(np.triu(overlap) >= least)):
        axes.plot(*heads[[i, j], :2].T, color="tab:blue", linewidth=0.5 + 5 * overlap[i, j], alpha=0.7, zorder=2)


options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
options.add_argument("figure", type=Path)
options.add_argument("--population", type=int, default=200, help="of the second search")
options.add_argument("--iterations", type=int, default=300, help="of the second search")
options.add_argument("--sample", type=int, default=4000, help="voxels that the searches look at")
options.add_argument("--seed", type=int, default=1)
options = options.parse_args()

with tempfile.TemporaryDirectory() as folder:
    file = Path(folder, "four_walls.glb")
    vantage.write_built_in_scene("four-walls", file)
    # The scanner is otherwise the paper's: 360 by 300 degrees, steps of 0.1.
    site = vantage.Site.open(file, height=1.5, user_size=0.1, spacing=0.01, seed=options.seed)
simulator = site.simulator
print(f"{simulator.scanner.rays} rays a station, goal density {simulator.goal_density:.1f}")

# Coverage of four stations: 200 iterations of 10 candidates.
four = site.plan(vantage.coverage_fix(4), population=10, iterations=200, sample=options.sample).answer
print(f"4 stations: coverage {four.value('coverage'):.3f} (paper: 0.89)")

# Coverage against overlap of eight.
eight = site.plan(vantage.coverage_overlap_fix(8), population=options.population, iterations=options.iterations,
                  sample=options.sample)
print(f"8 stations: hypervolume {eight.exact_hypervolume:.3f} (paper: 0.97)")
front = [entry for entry in eight.front if not entry.dominated]
coverage, overlap = (np.array([entry.value(name) for entry in front]) for name in ("coverage", "overlap"))
enough = coverage >= min(0.98, coverage.max())
shown = np.argmax(np.where(enough, overlap, -1))
print("the network shown, of most overlap at coverage 0.98: "
      f"coverage {coverage[shown]:.3f}, overlap {overlap[shown]:.3f} (paper: 0.98, 0.75)")

figure, (left, middle, right) = plt.subplots(1, 3, figsize=(15, 4.8), layout="constrained")
walls = draw_from_above(left, simulator, simulator.evaluate(four.heads, field=True), four.heads,
                        f"4 stations: coverage {four.value('coverage'):.3f}")
figure.colorbar(walls, ax=left, label="coverage")
middle.scatter(1 - coverage, 1 - overlap, s=14)
middle.scatter(1 - coverage[shown], 1 - overlap[shown], s=70, facecolors="none", edgecolors="black")
middle.set(title=f"8 stations: hypervolume {eight.exact_hypervolume:.3f}", xlabel="1 - coverage", ylabel="1 - overlap",
           xlim=(0, 1), ylim=(0, 1))
middle.grid(alpha=0.3)
draw_from_above(right, simulator, simulator.evaluate(front[shown].heads, field=True), front[shown].heads,
                f"coverage {coverage[shown]:.3f}, overlap {overlap[shown]:.3f}")
draw_links(right, front[shown].heads, front[shown].overlap_matrix)
figure.savefig(options.figure, dpi=110)
