# SPDX-License-Identifier: Apache-2.0
"""The stub is what the module says of itself, and every public thing has a docstring."""
import difflib
import inspect
import os
import re
import sys
import unittest

import numpy as np
import vantage
from vantage import _core

from sites import SOURCE

sys.path.insert(0, os.path.join(SOURCE, "packaging"))
import write_stub

PACKAGE = os.path.dirname(vantage.__file__)


def literals(kind):
    """The names in a type."""
    return set(re.findall(r"'([^']*)'", "".join(re.findall(r"Literal\[[^]]*\]", kind))))


class Stubs(unittest.TestCase):
    def test_the_package_is_typed(self):
        for name in ("py.typed", "__init__.pyi"):
            self.assertTrue(os.path.exists(os.path.join(PACKAGE, name)), name)

    def test_the_stub_is_what_the_module_says(self):
        with open(write_stub.STUB, encoding="utf-8") as file:
            there = file.read()
        said = write_stub.stub(_core)
        if there != said:
            folder = os.path.relpath(os.path.dirname(PACKAGE), SOURCE)
            lines = difflib.unified_diff(there.splitlines(), said.splitlines(), "the stub", "the module", n=1, lineterm="")
            self.fail("\n".join([f"write it anew: {sys.executable} packaging/write_stub.py {folder}", *lines]))
        for name in write_stub.ALIASES.values():
            self.assertGreater(len(re.findall(rf"\b{name}\b", there)), 1, f"nothing is a {name}")

    def test_the_package_gives_on_what_the_module_has(self):
        public = {name for name in vars(_core) if not name.startswith("_")}
        self.assertEqual(set(vantage.__all__), public | {"__version__"})

    def test_everything_has_a_docstring(self):
        for name in vantage.__all__:
            thing = getattr(vantage, name)
            if name == "__version__":
                continue
            self.assertTrue(thing.__doc__.strip(), name)
            if inspect.isclass(thing) and name != "Error":
                for member, value in vars(thing).items():
                    if not member.startswith("_"):
                        self.assertTrue((getattr(value, "__doc__", None) or "").strip(), f"{name}.{member}")

    def test_attributes_are_the_options(self):
        for name in ("Scanner", "StationSetup", "RegistrationOptions", "BeamOptions", "OnSiteOptions", "SurveyProblem"):
            made = getattr(vantage, name)()
            for option, (_, default) in _core._options[name].items():
                self.assertEqual(repr(getattr(made, option)), repr(default), f"{name}.{option}")

    def test_names_are_those_of_the_library(self):
        """Errors list every name."""
        scene = vantage.Scene.from_triangles([[0, 0, 0], [1, 0, 0], [0, 1, 0]], np.array([[0, 1, 2]]))
        calls = {
            "Scene.load": lambda **given: vantage.Scene.load("no.glb", **given),
            "SceneBuilder.add": lambda **given: vantage.SceneBuilder().add([[0, 0, 0]], np.array([[0, 0, 0]]), **given),
            "RegistrationOptions": vantage.RegistrationOptions,
            "BeamOptions": vantage.BeamOptions,
            "Simulator": lambda **given: vantage.Simulator(scene, vantage.Scanner(), **given),
        }
        compared = set()
        for call, make in calls.items():
            for option, (kind, _) in _core._options[call].items():
                if not literals(kind) or "Tuple" in kind:
                    continue
                with self.assertRaises(vantage.Error, msg=f"{call}: {option}") as refused:
                    make(**{option: "?"})
                listed = re.split(r"one of |none of |use |there are ", str(refused.exception))[-1]
                self.assertEqual(set(re.split(r", | or ", listed)), literals(kind), f"{call}: {option}")
                compared.add(option)
        self.assertEqual(compared, {"unit", "up", "shared_meshes", "role", "surfaces", "returns", "engine"})


if __name__ == "__main__":
    unittest.main()
