# SPDX-License-Identifier: Apache-2.0
"""The type stubs name what there is: every class, attribute, parameter and default, and nothing else."""
import ast
import inspect
import os
import re
import unittest

import vantage
from vantage import _core

PACKAGE = os.path.dirname(vantage.__file__)
UNSAID = {"SurveyProblem": {"registration", "on_site", "objectives", "requirements", "existing"}}  # defaults that are no literals


def parameters(function):
    """Names and defaults (None where there is none) of a stub's parameters, without self."""
    every = function.args
    positional = [(arg.arg, None) for arg in every.args]
    for k, default in enumerate(every.defaults):
        place = len(positional) - len(every.defaults) + k
        positional[place] = (positional[place][0], default)
    named = dict(positional + [(arg.arg, default) for arg, default in zip(every.kwonlyargs, every.kw_defaults)])
    named.pop("self", None)
    return named


def told_parameters(function):
    """Names of the parameters by the signature in a docstring, without self and options."""
    signature = re.match(r"\w+\((.*)\) -> ", function.__doc__.split("\n")[0]).group(1)
    signature = re.sub(r"\[[^\[\]]*\]", "", re.sub(r"\[[^\[\]]*\]", "", signature))
    names = re.findall(r"(?:^|, )(\w+): ", re.sub(r"= \([^)]*\)", "", signature))
    return [name for name in names if name != "self"]


class Stubs(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        with open(os.path.join(PACKAGE, "__init__.pyi")) as file:
            tree = ast.parse(file.read())
        cls.classes = {node.name: node for node in tree.body if isinstance(node, ast.ClassDef)}
        cls.functions = {node.name: node for node in tree.body if isinstance(node, ast.FunctionDef)}

    def test_the_package_is_marked_as_typed(self):
        self.assertTrue(os.path.exists(os.path.join(PACKAGE, "py.typed")))

    def test_they_name_what_the_module_has(self):
        public = {name: value for name, value in vars(_core).items() if not name.startswith("_")}
        self.assertEqual(set(public), set(self.classes) | set(self.functions))
        self.assertEqual(set(vantage.__all__), set(public) | {"__version__"})

    def test_classes_have_those_members(self):
        for name, node in self.classes.items():
            if name == "Error":
                continue
            stubbed = {item.name for item in node.body if isinstance(item, ast.FunctionDef)}
            stubbed |= {item.target.id for item in node.body if isinstance(item, ast.AnnAssign)}
            there = {member for member in vars(getattr(vantage, name)) if not member.startswith("_")}
            self.assertEqual({member for member in stubbed if not member.startswith("_")}, there, name)

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

    def check_call(self, where, stub, function, options):
        named = parameters(stub)
        self.assertEqual([name for name in named if name not in options], told_parameters(function), where)
        self.assertEqual({name for name in named if name in options}, set(options), where)
        for name, default in options.items():
            if name not in UNSAID.get(where, ()):
                self.assertEqual(ast.literal_eval(named[name]), default, f"{where}: {name}")

    def test_calls_take_those_parameters_and_options(self):
        defaults = dict(_core._defaults, load_gltf=_core._defaults["Scene.load"])
        checked = set()
        for name, stub in self.functions.items():
            checked.add(name)
            self.check_call(name, stub, getattr(vantage, name), defaults.get(name, {}))
        for name, node in self.classes.items():
            for stub in node.body:
                decorators = getattr(stub, "decorator_list", [])
                if not isinstance(stub, ast.FunctionDef) or any(ast.unparse(d) != "staticmethod" for d in decorators):
                    continue
                if stub.name == "__len__":
                    continue
                where = name if stub.name == "__init__" else f"{name}.{stub.name}"
                checked.add(where)
                self.check_call(where, stub, getattr(getattr(vantage, name), stub.name), defaults.get(where, {}))
        self.assertLessEqual(set(defaults), checked)

    def test_attributes_are_the_options(self):
        for name in ("Scanner", "StationSetup", "RegistrationOptions", "BeamOptions", "OnSiteOptions", "SurveyProblem"):
            made = getattr(vantage, name)()
            for option, default in _core._defaults[name].items():
                self.assertEqual(repr(getattr(made, option)), repr(default), f"{name}.{option}")


if __name__ == "__main__":
    unittest.main()
