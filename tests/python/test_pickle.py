# SPDX-License-Identifier: Apache-2.0
"""What is plain data can be pickled, and comes back the same; what owns a device says that it cannot be."""
import pickle
import unittest

import numpy as np
import vantage
from sites import BEFORE_EACH_WALL, four_walls_site


def again(value):
    return pickle.loads(pickle.dumps(value))


def parts(value):
    """Every attribute of a value, as something that can be compared; those that raise by their message."""
    found = {}
    for name in dir(value):
        if name.startswith("_") or callable(getattr(type(value), name, None)):
            continue
        try:
            part = getattr(value, name)
        except vantage.Error as error:
            part = str(error)
        if isinstance(part, np.ndarray):
            part = (part.shape, str(part.dtype), part.tobytes())
        elif type(part).__module__.startswith("vantage"):
            part = parts(part)
        elif not isinstance(part, (bool, int)):
            part = repr(part)
        found[name] = part
    return found


class Pickles(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.site = four_walls_site()
        cls.simulator, cls.scene = cls.site.simulator, cls.site.scene

    def same(self, value):
        self.assertGreater(len(parts(value)), 1)
        self.assertEqual(parts(again(value)), parts(value))

    def test_settings(self):
        scanner = vantage.Scanner(name="own", azimuth_step_deg=0.3, beam_divergence_mrad=0.2, noise={
            "distances_m": [1, 20], "reflectivities": [0.1, 0.9], "sigma_m": [[0.001, 0.002], [0.0005, 0.001]]})
        self.assertEqual(again(scanner).to_dict(), scanner.to_dict())
        self.same(vantage.StationSetup(heading_deg=30, tilt_deg=90, scanner=1))
        self.same(vantage.RegistrationOptions(rho_m=0.004, surfaces="all"))
        self.same(vantage.BeamOptions(returns="all", sub_rays=19))
        self.same(vantage.InstrumentErrors(collimation_deg=0.005, range_offset_m=0.001))
        self.same(vantage.OnSiteOptions(set_up_min=5, entrance=(1, 2, 3)))
        self.same(vantage.minimise(0, 20))

    def test_problems(self):
        for problem in (vantage.fewest_stations(0.8, 0.25, 2, 9), vantage.coverage_overlap_min(3, 7),
                        vantage.SurveyProblem(stations_min=2, stations_max=3, existing=[(1, 2, 1.5)], objectives=["time"],
                                              existing_setups=[vantage.StationSetup(tilt_deg=90)], existing_names=["K"], heights_m=(1.2, 1.9),
                                              requirements=["coverage >= 0.123456789", "stations <= 3"])):
            self.same(problem)
        own = vantage.Objective("own", lambda network: 1, vantage.maximise(1, 0))
        with self.assertRaisesRegex(TypeError, "the objective 'own' is one of your own"):
            pickle.dumps(vantage.SurveyProblem(objectives=[own]))

    def test_results(self):
        exact = self.simulator.evaluate(BEFORE_EACH_WALL, field=True, surroundings=True,
                                        registration=vantage.RegistrationOptions())
        sampled = self.simulator.evaluate_sampled([BEFORE_EACH_WALL], voxels=500)[0]
        for value in (exact, sampled, exact.registration, exact.connectivity(), self.scene.meshes[0],
                      self.simulator.scan((8, 0, 1.5), ["position", "normal", "mesh"]),
                      self.simulator.scan((8, 0, 1.5), ["colour", "voxel"], grid=True),
                      vantage.Station((8, 0, 1.5), vantage.StationSetup(heading_deg=20)),
                      vantage.place_heads(self.site, BEFORE_EACH_WALL)[1],
                      vantage.why_missed(self.site, exact),
                      vantage.OnSite(self.site).visit(BEFORE_EACH_WALL)):
            with self.subTest(type(value).__name__):
                self.same(value)
        self.assertEqual(again(exact).to_dict(), exact.to_dict())
        np.testing.assert_array_equal(again(exact).scan_overlap_matrix, exact.scan_overlap_matrix)

    def test_damaged_ones_are_refused(self):
        state = self.simulator.evaluate([[8, 0, 1.5]]).__getstate__()
        self.assertEqual(state[0], vantage.__version__)
        fresh = vantage.Evaluation.__new__(vantage.Evaluation)
        with self.assertRaisesRegex(vantage.Error, "a pickle of vantage is cut short"):
            fresh.__setstate__((state[0], state[1][:-5]))
        with self.assertRaisesRegex(vantage.Error, "a pickle of vantage 0.0.1 is not read by vantage"):
            fresh.__setstate__(("0.0.1", state[1]))

    def test_what_owns_a_device_is_not_pickled(self):
        plan = self.site.plan(vantage.coverage_fix(2), population=4, iterations=1, sample=100)
        for value in (self.simulator, self.site, plan, plan.answer):
            with self.assertRaisesRegex(TypeError, f"a {type(value).__name__} .* is not pickled; "):
                pickle.dumps(value)


if __name__ == "__main__":
    unittest.main()
