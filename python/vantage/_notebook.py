# SPDX-License-Identifier: Apache-2.0
"""What notebooks show of sites, evaluations and plans: HTML without any other package, and plans by matplotlib."""
from html import escape

import numpy as np

from . import _core

_LEAST_LINK = 0.3  # scan overlap, as `vantage plan --link`


def _table(rows, head=None):
    cells = lambda row, tag: "".join(f"<{tag} style='text-align:left'>{escape(str(each))}</{tag}>" for each in row)
    lines = [f"<tr>{cells(head, 'th')}</tr>"] if head else []
    return "<table>" + "".join(lines + [f"<tr>{cells(row, 'td')}</tr>" for row in rows]) + "</table>"


def _site_html(self):
    low, high = self.scene.bounds
    size = " x ".join(f"{length:.3g}" for length in high - low)
    rows = [
        ("scene", f"{len(self.scene.meshes)} meshes, {self.scene.triangle_count} triangles, {size} m"),
        ("scanner", ", ".join(scanner.name for scanner in self.scanners)),
    ]
    rows += [(choice.setting, f"{choice.value}: {choice.why}") for choice in self.choices]
    return f"<b>Site {escape(self.name)}</b>{_table(rows)}"


def _evaluation_html(self):
    stations = f"{self.stations} station" + ("" if self.stations == 1 else "s")
    if self.cancelled:
        return f"<b>{stations}</b>: the evaluation was cancelled"
    return f"<b>{stations}</b><pre>{escape(self.summary)}</pre>"


def _plan_html(self):
    head = ["network", "stations", *self.measures]
    shown = []
    for number, entry in enumerate(self.front, 1):
        known = (entry.values[name].best_known if name in entry.values else float("nan") for name in self.measures)
        shown.append([number, len(entry.stations), *("" if value != value else f"{value:.4g}" for value in known)])
    front = f"<details><summary>{len(shown)} networks</summary>{_table(shown, head)}</details>" if len(shown) > 1 else ""
    return f"<b>Plan</b><pre>{escape(self.summary)}</pre>{front}"


def _axes(ax):
    if ax is not None:
        return ax
    try:
        import matplotlib.pyplot as plt
    except ImportError:
        raise ImportError(
            "plot needs matplotlib, which is not installed: pip install 'vantage[plot]', or python3-matplotlib"
        ) from None
    return plt.subplots()[1]


def _draw_ground(ax, site):
    from matplotlib.collections import PolyCollection

    try:
        area = site.area
    except _core.Error:  # a model without ground; stations are drawn all the same
        return
    corners = area.positions[area.triangles][:, :, :2]
    ax.add_collection(PolyCollection(corners, facecolor="0.88", edgecolor="none", antialiased=False, zorder=0))


def _draw_network(ax, heads, overlaps, least):
    n = len(heads)
    if overlaps is not None and len(overlaps) == n:
        for a, b in zip(*np.triu_indices(n, 1)):
            if overlaps[a, b] < least:
                continue
            ax.plot(heads[[a, b], 0], heads[[a, b], 1], color="tab:blue", linewidth=1, zorder=1)
    ax.scatter(heads[:, 0], heads[:, 1], color="tab:red", s=20, zorder=2)
    for number, (x, y) in enumerate(heads[:, :2], 1):
        ax.annotate(f"S{number}", (x, y), xytext=(3, 3), textcoords="offset points", fontsize=8)


def _finish(ax, title):
    ax.autoscale_view()
    ax.set_aspect("equal")
    ax.set(xlabel="x, m", ylabel="y, m", title=title)
    return ax


def _plot_site(self, ax=None):
    """plot(self: vantage.Site, ax: Any = None) -> Any

    Draws the ground in plan view, and the outline of the scene. ax: matplotlib's axes; None: new ones, which are
    returned. Raises ImportError without matplotlib."""
    ax = _axes(ax)
    _draw_ground(ax, self)
    (x, y, _), (x1, y1, _) = self.scene.bounds
    ax.plot([x, x1, x1, x, x], [y, y, y1, y1, y], color="0.5", linewidth=0.8)
    return _finish(ax, self.name)


def _plot_evaluation(self, ax=None, site=None, link=_LEAST_LINK):
    """plot(self: vantage.Evaluation, ax: Any = None, site: Optional[vantage.Site] = None, link: float = 0.3) -> Any

    Draws the stations in plan view, with lines where scan overlaps, if they are known, are at least `link`. site: its
    ground is drawn. ax: matplotlib's axes; None: new ones, which are returned. Raises ImportError without matplotlib."""
    ax = _axes(ax)
    if site is not None:
        _draw_ground(ax, site)
    try:
        overlaps = self.scan_overlap_matrix
    except _core.Error:  # not asked for
        overlaps = None
    _draw_network(ax, self.heads, overlaps, link)
    title = "cancelled" if self.cancelled else f"{self.stations} stations, coverage {100 * self.coverage:.1f} %"
    return _finish(ax, title)


def _plot_plan(self, ax=None, link=_LEAST_LINK):
    """plot(self: vantage.PlanResult, ax: Any = None, link: float = 0.3) -> Any

    Draws the answer in plan view: ground, stations, and lines where scan overlaps are at least `link`. ax:
    matplotlib's axes; None: new ones, which are returned. Raises ImportError without matplotlib."""
    ax = _axes(ax)
    _draw_ground(ax, self.site)
    answer = self.answer
    _draw_network(ax, answer.heads, answer.scan_overlap_matrix, link)
    captured = answer.values["coverage"].best_known if "coverage" in answer.values else float("nan")
    share = "" if captured != captured else f", coverage {100 * captured:.1f} %"
    return _finish(ax, f"{self.site.name}: {len(answer.stations)} stations{share}")


_core.Site._repr_html_, _core.Site.plot = _site_html, _plot_site
_core.Evaluation._repr_html_, _core.Evaluation.plot = _evaluation_html, _plot_evaluation
_core.PlanResult._repr_html_, _core.PlanResult.plot = _plan_html, _plot_plan
for _type in (_core.Site, _core.Evaluation, _core.PlanResult):
    _type.plot.__name__, _type.plot.__qualname__ = "plot", f"{_type.__name__}.plot"
