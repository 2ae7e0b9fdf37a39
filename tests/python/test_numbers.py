# SPDX-License-Identifier: Apache-2.0
"""Numbers as nobody should give them, to every call, keyword and array that takes some: each call ends in an exception or in finite results."""
import math
import unittest

import numpy as np
import vantage

from sites import FOUR_WALLS

NOWHERE = [math.nan, math.inf, -math.inf, 1e30, -1e30, 2.0**63, 1e308, 2e6]
ODD = [*NOWHERE, -1.0, -0.0, 0.0, 5e-324, -5e-324, 1e-310, 2**63, 2**64, -(2**63), 10**400, np.float32("nan"), np.nan]
HEAD = [8.0, 0.0, 1.5]
REFUSALS = (vantage.Error, TypeError, ValueError, OverflowError, IndexError)
QUICK = {"engine": "embree", "step": 4, "user_size": 1, "spacing": 0.3, "height": 1.5}
TINY_PLAN = {"problem": "coverage-fix", "stations": 1, "population": 2, "iterations": 1, "sample": 50}


def numbers_in(value):
    """All floats in a result."""
    if isinstance(value, (bool, int, str, bytes)) or value is None:
        return
    if isinstance(value, float):
        yield value
    elif isinstance(value, np.ndarray):
        yield from (float(x) for x in value.ravel() if value.dtype.kind == "f")
    elif isinstance(value, dict):
        for each in value.values():
            yield from numbers_in(each)
    elif isinstance(value, (list, tuple)):
        for each in value:
            yield from numbers_in(each)
    elif isinstance(value, vantage.Evaluation):
        yield from numbers_in([value.coverage, value.visit.minutes if value.visit else 0.0])
    elif isinstance(value, vantage.PlacedStation):
        yield from numbers_in([value.position, value.ground])
    elif isinstance(value, vantage.Visit):
        yield from numbers_in([value.minutes, value.legs_m, value.paths])


def with_each(values, position):
    """The position with each value in place of each coordinate."""
    for value in values:
        for k in range(len(position)):
            yield [*position[:k], value, *position[k + 1:]]


class Numbers(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.site = vantage.Site.open(FOUR_WALLS, **QUICK)
        cls.simulator = cls.site.simulator
        cls.walk = vantage.OnSite(cls.site)
        cls.matrix = vantage.CoverageMatrix([1, 1, 2], 1.0, [[1, 0, 0], [0, 1, 0], [0, 1, 1]])
        cls.graph = vantage.StationGraph(np.full((3, 3), 0.5))

    def ends(self, what, call, refused=False):
        with self.subTest(what):
            try:
                result = call()
            except REFUSALS as error:
                self.assertNotIn("basic_string", str(error))
                return
            self.assertFalse(refused, "was taken")
            for number in numbers_in(result):
                self.assertFalse(math.isnan(number), result)

    def test_positions(self):
        site, clash, walk = self.site, self.site.clash, self.walk
        calls = {
            "place_heads": lambda p: vantage.place_heads(site, [p]),
            "Station": lambda p: site.evaluate([vantage.Station(p)]),
            "Site.evaluate": lambda p: site.evaluate([HEAD, p]),
            "Site.nearest_place": site.nearest_place,
            "Simulator.evaluate": lambda p: self.simulator.evaluate([p]),
            "Simulator.evaluate_sampled": lambda p: self.simulator.evaluate_sampled([[p]], voxels=50),
            "Simulator.scan": lambda p: self.simulator.scan(p).range_m,
            "clashes": lambda p: clash.clashes([p]),
            "clashes at a height": lambda p: clash.clashes([p], 1.5),
            "sees a": lambda p: clash.sees(p, HEAD),
            "sees b": lambda p: clash.sees(HEAD, p),
            "distance": lambda p: clash.distance([p], 1.0),
            "way_m start": lambda p: walk.way_m(p, HEAD),
            "way_m end": lambda p: walk.way_m(HEAD, p),
            "way start": lambda p: walk.way(p, HEAD),
            "way end": lambda p: walk.way(HEAD, p),
            "visit": lambda p: walk.visit([p, HEAD]),
            "entrance": lambda p: vantage.OnSite(site, vantage.OnSiteOptions(entrance=p)),
            "enter": lambda p: vantage.Site.open(FOUR_WALLS, **QUICK, enter=[p]),
            "existing": lambda p: site.plan(vantage.SurveyProblem(existing=[p], objectives=["coverage"], stations_min=1, stations_max=1)),
            "start": lambda p: site.plan(**TINY_PLAN, start=[p]),
            "existing_targets": lambda p: site.plan(**TINY_PLAN, existing_targets=[vantage.Target("T", p)]),
            "greedy_network": lambda p: vantage.greedy_network(site, stations=1, existing=[p]),
            "exact_network": lambda p: vantage.exact_network(site, stations=1, existing=[p]),
        }
        for name, call in calls.items():
            for position in with_each(NOWHERE, HEAD):
                self.ends(f"{name}: {position}", lambda: call(position), refused=True)
        for name in ["place_heads", "Simulator.evaluate", "clashes", "sees a", "distance", "way_m start", "visit"]:
            for position in with_each(ODD, HEAD):
                self.ends(f"{name}: {position}", lambda: calls[name](position))
        with self.assertRaisesRegex(vantage.Error, r"at \(nan, 0, 1.5\); a position must be finite and within 1000 km"):
            site.evaluate([[math.nan, 0, 1.5]])

    def test_numbers_of_calls(self):
        site, matrix, graph = self.site, self.matrix, self.graph
        evaluation = site.evaluate([HEAD, [-8, 0, 1.5]])
        floor = vantage.Scene.from_triangles([[0, 0, 0], [8, 0, 0], [8, 8, 0], [0, 8, 0]], np.array([[0, 1, 2], [0, 2, 3]]))
        calls = {
            "reach_m": lambda v: site.nearest_place(HEAD, v),
            "limit_m": lambda v: site.clash.distance([HEAD], v),
            "height_m": lambda v: site.clash.clashes([HEAD], v),
            "connectivity": lambda v: evaluation.connectivity(v).parts,
            "control_m": lambda v: site.plan(**TINY_PLAN, existing_targets=[vantage.Target("T", HEAD, v)]).front,
            "link": lambda v: site.evaluate([HEAD], link=v),
            "sample_voxels": lambda v: site.evaluate([HEAD], sample_voxels=v),
            "heading": lambda v: self.simulator.evaluate([vantage.Station(HEAD, vantage.StationSetup(heading_deg=v))]),
            "tilt": lambda v: self.simulator.evaluate([vantage.Station(HEAD, vantage.StationSetup(tilt_deg=v))]),
            "scanner": lambda v: self.simulator.evaluate([vantage.Station(HEAD, vantage.StationSetup(scanner=v))]),
            "lower_m": lambda v: vantage.ClashChecker(site.scene, lower_m=v),
            "radius_m": lambda v: vantage.ClashChecker(site.scene, radius_m=v),
            "diffuse": lambda v: vantage.Scene.from_triangles([[0, 0, 0], [1, 0, 0], [0, 1, 0]], np.array([[0, 1, 2]]), v),
            "vertex": lambda v: vantage.Scene.from_triangles([[v, 0, 0], [1, 0, 0], [0, 1, 0]], np.array([[0, 1, 2]])).bounds,
            "default_diffuse": lambda v: vantage.Scene.load(FOUR_WALLS, default_diffuse=v),
            "goal": lambda v: vantage.CoverageMatrix([1], v, [[1]]).coverage([0]),
            "weights": lambda v: vantage.CoverageMatrix([v], 1.0, [[1]]).coverage([0]),
            "overlaps": lambda v: vantage.StationGraph([[0, v], [v, 0]]),
            "max_cover link": lambda v: vantage.max_cover(matrix, 2, graph=graph, link=v).coverage,
            "tolerance": lambda v: vantage.max_cover(matrix, 2, tolerance=v).coverage,
            "max_cover max_seconds": lambda v: vantage.max_cover(matrix, 2, max_seconds=v).coverage,
            "exact_seconds": lambda v: vantage.max_cover(matrix, 2, exact_seconds=v).coverage,
            "min_cover": lambda v: vantage.min_cover(matrix, v).at_least,
            "min_connected_cover": lambda v: vantage.min_connected_cover(matrix, graph, v, 0.3).coverage,
            "find_candidates change": lambda v: vantage.find_candidates(site, first=2, most=4, sample_voxels=50, change=v).change,
            "find_candidates max_seconds": lambda v: vantage.find_candidates(site, first=2, most=4, sample_voxels=50, max_seconds=v).change,
            "exact_network link": lambda v: vantage.exact_network(site, stations=1, candidates=4, sample_voxels=50, link=v),
            "exact_network apart_m": lambda v: vantage.exact_network(site, stations=1, candidates=4, sample_voxels=50, apart_m=v),
            "exact_network max_seconds": lambda v: vantage.exact_network(site, stations=1, candidates=4, sample_voxels=50, max_seconds=v),
            "minimise": lambda v: vantage.minimise(0, v),
            "fewest_stations capture": lambda v: vantage.fewest_stations(v),
            "fewest_stations link": lambda v: vantage.fewest_stations(0.9, v),
            "fitness_min": lambda v: vantage.fitness_min(1, 2, (v, 0.5, 0.5)),
            "link_overlap": lambda v: site.plan(vantage.SurveyProblem(objectives=["coverage"], stations_min=1, stations_max=1, link_overlap=v),
                                                population=2, iterations=1, sample=50),
            "limit": lambda v: site.plan(vantage.SurveyProblem(
                objectives=["coverage"], stations_min=1, stations_max=1,
                requirements=[vantage.Requirement(vantage.coverage_fix(1).objectives[0], ">=", v)]), population=2, iterations=1, sample=50),
            "pulse_m": lambda v: site.evaluate([HEAD], beam=vantage.BeamOptions(pulse_m=v)),
        }
        for member in ("set_up_min", "photos_min", "walking_m_per_s", "detour"):
            calls[member] = lambda v, member=member: vantage.OnSite(site, vantage.OnSiteOptions(**{member: v})).visit([HEAD]).minutes
        for member in ("rho_m", "patch_m", "position_m", "heading_deg", "tilt_deg"):
            calls[member] = lambda v, member=member: site.evaluate([HEAD, [-8, 0, 1.5]], registration=vantage.RegistrationOptions(**{member: v}))
        for member in ("height_m", "azimuth_step_deg", "min_range_m", "max_range_m", "points_per_second", "beam_divergence_mrad", "heading_deg",
                       "vertical_angle_deg", "zenith_start_deg", "detection_range_m", "detection_reflectivity", "exit_diameter_mm"):
            calls["Scanner " + member] = lambda v, member=member: vantage.Scanner(**{member: v}).check()
        for member in ("user_size_m", "point_spacing_m", "max_incidence_deg"):
            calls["Simulator " + member] = lambda v, member=member: vantage.Simulator(
                site.scene, vantage.Scanner(azimuth_step_deg=4, zenith_step_deg=4),
                **{"engine": "embree", "user_size_m": 1, "point_spacing_m": 0.3, member: v}).evaluate([HEAD])
        for name, scene in {"derived": floor, "marked": site.scene}.items():
            for member in ("max_slope_deg", "headroom_m", "min_area_m2", "passage_width_m", "passage_height_m", "climb_m"):
                calls[f"SearchArea {name} {member}"] = lambda v, member=member, scene=scene: vantage.SearchArea(scene, **{member: v}).uv_max
        for name, call in calls.items():
            for value in ODD:
                self.ends(f"{name}: {value}", lambda: call(value), refused=isinstance(value, float) and math.isnan(value))

    def test_settings(self):
        of_site = ["step", "heading", "horizontal", "vertical", "zenith_start", "height", "range", "beam", "detection", "rate", "user_size",
                   "incidence", "spacing", "security", "slope", "headroom", "min_area", "passage", "climb", "levels", "diffuse", "seed"]
        for name in of_site:
            for value in ODD:
                self.ends(f"{name}: {value}", lambda: vantage.Site.open(FOUR_WALLS, **{**QUICK, name: value}).evaluate([HEAD]),
                          refused=isinstance(value, float) and math.isnan(value))
        of_plan = ["capture", "link", "apart", "set_up", "photos", "walking", "stations", "heights", "link_overlap", "min_overlap", "fitness",
                   "registration_rho", "registration_patch", "registration_position", "registration_heading", "registration_tilt", "targets",
                   "target_diameter", "target_height", "target_sigma", "population", "iterations", "batch", "redraws", "stagnation", "sigma",
                   "target_hypervolume", "sample", "renew"]
        for name in of_plan:
            for value in ODD:
                self.ends(f"{name}: {value}", lambda: self.site.plan(**{**TINY_PLAN, name: value}).front,
                          refused=isinstance(value, float) and math.isnan(value))

    def test_an_objective_without_a_number_is_told(self):
        mine = vantage.Objective("mine", lambda network: math.nan, vantage.minimise(0, 1))
        problem = vantage.SurveyProblem(objectives=[mine], stations_min=1, stations_max=1)
        with self.assertRaisesRegex(vantage.Error, 'objective "mine": its value is NaN'):
            self.site.plan(problem, population=2, iterations=1, sample=50)

    def test_names_are_text(self):
        for name in ("\ufffe", "\uffff", "\x00", "\ud800", "a\u202eb"):
            self.ends(repr(name), lambda: self.site.plan(**TINY_PLAN, existing_targets=[vantage.Target(name, HEAD)]).front)


if __name__ == "__main__":
    unittest.main()
