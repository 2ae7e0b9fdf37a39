#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Range noise of a scanner, measured on planes of its scans: measure_noise.py FILE... [--sensor JSON] [--origin X,Y,Z]
[--points N] [--nearest M] [--incidence DEG]

FILEs are scans of one scanner, each from one place: PCD, PLY, columns of text, packets of an Ouster (scan_files.py).

Each scan is cut into patches of up to N neighbouring rays. A plane is fitted to each; residuals are along the rays. A
patch is flat if 95 % of its points are within four sigma, a quadric fits no better than chance along the rows, and the
plane of another patch beside it goes on in its own. The size of its residuals plays no part, so no noise is cut off.
Three figures of a patch tell noise from surface:

    plane        residuals from the plane: noise, offsets of beams, and what is uneven in a patch
    neighbours   differences of nearest points, mostly of one beam, over sqrt(2): no offsets and no bends, but less than
                 the noise if neighbours correlate
    blocks       how many times as far off as white noise's the means of sixteenths of a patch are

Tables have medians over patches with their standard errors, and the plane's lower quartile: if it is far below the
median, some of the surfaces are rough. Rough surfaces, such as curtains and leaves, count as noise in all figures, so
these are upper bounds of the noise."""
import argparse
import dataclasses

import numpy as np

import scan_files

LEAST_POINTS = 20
SIGMAS = 4  # of 10 000 normal residuals, fewer than one is beyond
BENT = 3.8  # F of three terms of a quadric: one white patch in a hundred is beyond
STEPS_MM = (0.1, 0.2, 0.25, 0.5, 1, 2, 2.5, 4, 5, 8, 10, 20)
RANGES_M = (0, 0.5, 1, 2, 4, 8, 16, 32, 64, 128)
INCIDENCES_DEG = (0, 20, 40, 60)


@dataclasses.dataclass
class Patch:
    plane: np.ndarray  # m of the plane m·x = 1
    centre: np.ndarray
    points: int
    range: float
    incidence: float  # degrees
    intensity: float
    sigma: float
    neighbours: float
    correlation: float
    blocks: float
    rows: tuple | None  # beams, normal equations of their offsets, right side


def cut(angles, most):
    """Parts of at most `most` points, by halves of the longer side."""
    todo, parts = [np.arange(len(angles))], []
    while todo:
        part = todo.pop()
        if len(part) <= most:
            parts.append(part)
            continue
        longer = np.argmax(np.ptp(angles[part], axis=0))
        order = part[np.argsort(angles[part, longer], kind="stable")]
        todo += [order[:len(order) // 2], order[len(order) // 2:]]
    return parts


def fit_plane(points, rays, random):
    """m of the plane m·x = 1, residuals along the rays, and which of them are kept; None where no plane shows."""
    def residuals(m):
        return (points @ m - 1) / (rays @ m)

    corners = points[random.integers(len(points), size=(40, 3))]
    corners = corners[np.abs(np.linalg.det(corners)) > 1e-12]
    tried = np.linalg.solve(corners, np.ones((len(corners), 3, 1)))[..., 0]
    tried = tried[np.abs(tried @ rays.T).min(axis=1, initial=np.inf) > 1e-6]
    if len(tried) == 0:
        return None
    typical = np.median(np.abs((tried @ points.T - 1) / (tried @ rays.T)), axis=1)
    m = tried[typical.argmin()]
    kept = np.abs(residuals(m)) <= SIGMAS * 1.4826 * typical.min()
    for _ in range(10):
        if kept.sum() < LEAST_POINTS:
            return None
        weights = 1 / np.abs(rays[kept] @ m)
        m = np.linalg.lstsq(points[kept] * weights[:, None], weights, rcond=None)[0]
        e, before = residuals(m), kept
        kept = np.abs(e) <= SIGMAS * np.sqrt((e[kept] ** 2).sum() / (kept.sum() - 3))
        if (kept == before).all():
            break
    return m, e, kept


def is_bent(e, angles, row):
    """Whether a quadric fits better than the plane does; offsets of beams are no bend."""
    a = (angles - angles.mean(axis=0)) / angles.std(axis=0)
    linear = [np.ones(len(e)), *a.T] if row is None else [*np.eye(row.max() + 1)[row].T, *a.T]
    bends = np.column_stack([*linear, a ** 2, a[:, 0] * a[:, 1]])
    sums, sizes = [], []
    for terms in (np.column_stack(linear), bends):
        solution, _, size, _ = np.linalg.lstsq(terms, e, rcond=None)
        sums.append(((e - terms @ solution) ** 2).sum())
        sizes.append(size)
    if len(e) < sizes[1] + 10:
        return True  # too few points to tell
    return sizes[1] > sizes[0] and (sums[0] - sums[1]) / (sizes[1] - sizes[0]) > BENT * sums[1] / (len(e) - sizes[1])


def excess_of_blocks(e, angles):
    parts = cut(angles, max(len(e) // 16 + 1, 3))
    sizes, means = np.array([len(p) for p in parts]), np.array([e[p].mean() for p in parts])
    within = ((e ** 2).sum() - (sizes * means ** 2).sum()) / (len(e) - len(parts))
    return np.sqrt((sizes * means ** 2).sum() / (len(parts) - 3) / within)


def patches_of(scan, settings, random):
    ranges, rays = scan.rays()
    good = np.isfinite(ranges) & (ranges > settings.nearest)
    scan, ranges, rays = scan.subset(good), ranges[good], rays[good]
    elevation, azimuth = np.arcsin(np.clip(rays[:, 2], -1, 1)), np.arctan2(rays[:, 1], rays[:, 0])
    # A field that is not the full circle has no seam in it.
    azimuth = np.angle(np.exp(1j * azimuth) * np.conj(np.exp(1j * azimuth).mean()))
    angles = np.column_stack([azimuth * np.cos(np.median(elevation)), elevation])
    row = scan.row if scan.row is not None else rows_of(elevation)
    found = []
    for part in cut(angles, settings.points):
        fitted = fit_plane(scan.points[part], rays[part], random) if len(part) >= LEAST_POINTS else None
        if fitted is None or fitted[2].mean() < 0.95:
            continue
        m, e, kept = fitted
        part, e = part[kept], e[kept]
        beams = None if row is None else np.unique(row[part], return_inverse=True)[1]
        if np.ptp(angles[part], axis=0).min() == 0 or is_bent(e, angles[part], beams):
            continue
        incidence = np.degrees(np.arccos(np.clip(np.abs(rays[part] @ m).mean() / np.linalg.norm(m), 0, 1)))
        if incidence > settings.incidence:
            continue
        # The plane takes up part of the noise: `share` of each pair of points, exactly so for white noise.
        weighted = scan.points[part] / np.abs(rays[part] @ m)[:, None]
        share = weighted @ np.linalg.solve(weighted.T @ weighted, weighted.T)
        apart = ((angles[part][:, None] - angles[part][None]) ** 2).sum(axis=2)
        np.fill_diagonal(apart, np.inf)
        near = apart.argmin(axis=1)
        own, mutual = np.diag(share), share[np.arange(len(e)), near]
        variance = (e ** 2).sum() / (len(e) - 3)
        found.append(Patch(
            m, scan.points[part].mean(axis=0), len(part), float(np.median(ranges[part])), incidence,
            np.nan if scan.intensity is None else float(np.median(scan.intensity[part])), np.sqrt(variance),
            np.sqrt(((e - e[near]) ** 2).mean() / (2 - own - own[near] + 2 * mutual).mean()),
            (e * e[near]).mean() / variance + mutual.mean(), excess_of_blocks(e, angles[part]),
            None if row is None else equations_of_rows(e, share, row[part])))
    return continued(found)


def equations_of_rows(e, share, row):
    rows, index = np.unique(row, return_inverse=True)
    of_row = np.eye(len(rows))[index]
    return rows, of_row.T @ of_row - of_row.T @ share @ of_row, of_row.T @ e


def rows_of(elevation):
    """Numbers of beams that turn at a few elevations; None for other scanners."""
    values, row = np.unique(np.degrees(elevation).round(2), return_inverse=True)
    return row if len(values) > 1 and np.ptp(values) > 0.1 * len(values) else None


def continued(patches):
    """Those in whose plane another patch beside them lies."""
    if not patches:
        return []
    m, centre = (np.array([getattr(p, name) for p in patches]) for name in ("plane", "centre"))
    size, away = np.linalg.norm(m, axis=1), np.linalg.norm(centre, axis=1)
    normal, slack = m / size[:, None], 3 * np.array([p.sigma for p in patches])
    off = np.abs(centre @ m.T - 1) / size
    same = (np.abs(normal @ normal.T) > np.cos(np.radians(5))) & (off < slack[None]) & (off.T < slack[None])
    same &= np.linalg.norm(centre[:, None] - centre[None], axis=2) < 0.5 * np.minimum(away[:, None], away[None])
    np.fill_diagonal(same, False)
    return [p for p, others in zip(patches, same.sum(axis=1)) if others > 0]


def median_and_error(values):
    """The median of `values` and its standard error, from the quartiles."""
    low, middle, high = np.percentile(values, (25, 50, 75))
    return middle, 1.2533 * (high - low) / 1.349 / np.sqrt(len(values))


def step_of_ranges(scan):
    """What its ranges or else its coordinates are multiples of, in mm."""
    ranges = scan.rays()[0] + np.linalg.norm(scan.origins, axis=1)
    for name, values in (("ranges", ranges), ("coordinates", scan.points.ravel())):
        values = 1000 * values[np.isfinite(values) & (values != 0)]
        for step in reversed(STEPS_MM):
            if len(values) and np.abs(np.exp(2j * np.pi * values / step).mean()) > 0.9:
                return f"{name} in steps of {step:g} mm"
    return "no step of ranges shows"


def exponents(patches):
    """Powers of range, cosine of incidence and intensity in the noise of neighbours: {name: (power, error) or None}."""
    columns = {"range": [p.range for p in patches], "cosine": np.cos(np.radians([p.incidence for p in patches])),
               "intensity": [p.intensity for p in patches]}
    logs = {name: np.log(np.maximum(values, 1e-9)) for name, values in columns.items() if np.isfinite(values).all()}
    # A power shows where the values differ enough.
    known = [name for name, values in logs.items() if values.std() > (0.1 if name == "cosine" else 0.25)]
    result = dict.fromkeys(columns)
    y, kept = np.log([p.neighbours for p in patches]), np.full(len(patches), True)
    if len(patches) < 20 or not known:
        return result
    for _ in range(5):
        terms = np.column_stack([np.ones(len(y))] + [logs[name] for name in known])
        power = np.linalg.lstsq(terms[kept], y[kept], rcond=None)[0]
        left = y - terms @ power
        kept = np.abs(left) < 4 * 1.4826 * np.median(np.abs(left[kept]))
    variance = (left[kept] ** 2).sum() / (kept.sum() - len(power))
    errors = np.sqrt(variance * np.diag(np.linalg.inv(terms[kept].T @ terms[kept])))
    return result | {name: (power[k + 1], errors[k + 1]) for k, name in enumerate(known)}


def repeated_offsets(patches):
    """Offsets of beams that are the same in all patches: their root mean square, what noise alone would give at most,
    and the number of beams; or None. A common offset, and what changes evenly from beam to beam, is not in it, since
    planes take that up."""
    equations = [patch.rows for patch in patches if patch.rows is not None]
    if not equations:
        return None
    beams = np.unique(np.concatenate([rows for rows, _, _ in equations]))
    normal, right = np.zeros((len(beams), len(beams))), np.zeros(len(beams))
    for rows, matrix, vector in equations:
        at = np.searchsorted(beams, rows)
        normal[np.ix_(at, at)] += matrix
        right[at] += vector
    enough = np.diag(normal) > 0.05 * np.diag(normal).mean()
    if enough.sum() < 5:
        return None
    inverse = np.linalg.pinv(normal[np.ix_(enough, enough)], rcond=0.02, hermitian=True)
    covariance = median_and_error([patch.neighbours for patch in patches])[0] ** 2 * inverse
    square = np.mean((inverse @ right[enough]) ** 2) - np.trace(covariance) / enough.sum()
    by_noise = 3 * np.sqrt(2 * (covariance ** 2).sum()) / enough.sum()
    return np.sqrt(max(square, 0)), np.sqrt(by_noise), int(enough.sum())


def classes(patches):
    yield "all", patches
    for name, bounds in (("range", RANGES_M), ("incidence", INCIDENCES_DEG)):
        unit = " m" if name == "range" else "°"
        for low, high in zip(bounds, bounds[1:]):
            yield f"{name} {low:g}-{high:g}{unit}", [p for p in patches if low <= getattr(p, name) < high]
    values = np.array([p.intensity for p in patches])
    if np.isfinite(values).all() and np.ptp(values) > 0:
        thirds = np.unique(np.percentile(values, (0, 100 / 3, 200 / 3, 100)))
        for low, high in zip(thirds, thirds[1:]):
            yield f"intensity {low:.4g}-{high:.4g}", [p for p in patches if low <= p.intensity <= high]


def measure(scans, settings):
    random = np.random.default_rng(1)
    return [patch for scan in scans for patch in patches_of(scan, settings, random)]


def report(scans, patches):
    steps = ", ".join(sorted(set(map(step_of_ranges, scans))))
    print(f"{len(scans)} scans, {sum(len(scan.points) for scan in scans)} points; {steps}")
    titles = ("", "patches", "points", "plane, mm", "quarter", "neighbours, mm", "correlation", "blocks")
    line = "{:26}{:>8}{:>8}{:>15}{:>9}{:>16}{:>14}{:>13}".format
    print(line(*titles))
    for name, some in classes(patches):
        if len(some) >= 5:
            plane, near, correlation, blocks = (
                "{:.2f} ± {:.2f}".format(*np.multiply(unit, median_and_error([getattr(p, key) for p in some])))
                for key, unit in (("sigma", 1000), ("neighbours", 1000), ("correlation", 1), ("blocks", 1)))
            quarter = 1000 * np.percentile([p.sigma for p in some], 25)
            points = sum(patch.points for patch in some)
            print(line(name, len(some), points, plane, f"{quarter:.2f}", near, correlation, blocks))
    for name, power in exponents(patches).items():
        print(f"power of {name}: " + ("not known" if power is None else f"{power[0]:.2f} ± {power[1]:.2f}"))
    rows = repeated_offsets(patches)
    print("offsets of beams that repeat: " + (f"{1000 * rows[0]:.2f} mm, of which noise alone gives up to "
                                              f"{1000 * rows[1]:.2f} mm, {rows[2]} beams" if rows else "not known"))


def parse(arguments=None):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("files", nargs="+", metavar="FILE")
    parser.add_argument("--sensor", metavar="JSON", help="description of the sensor beside packets of an Ouster")
    parser.add_argument("--origin", default="0,0,0", help="where the scanner stands in the files")
    parser.add_argument("--points", type=int, default=60, help="most points of a patch")
    parser.add_argument("--nearest", type=float, default=0.5, metavar="M", help="shorter ranges do not count")
    parser.add_argument("--incidence", type=float, default=60, metavar="DEG", help="larger angles do not count")
    return parser.parse_args(arguments)


def main():
    settings = parse()
    origin = np.array([float(value) for value in settings.origin.split(",")])
    scans = [scan_files.read(path, origin, settings.sensor) for path in settings.files]
    patches = measure(scans, settings)
    if len(patches) < 5:
        raise SystemExit(f"{len(patches)} flat patches are too few to measure noise by: try other --points")
    report(scans, patches)


if __name__ == "__main__":
    main()
