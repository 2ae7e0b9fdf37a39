#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes python/vantage/__init__.pyi, the types of the Python module, from what the built module says of itself.

    python3 packaging/write_stub.py FOLDER    FOLDER: where `pip install --target` put the module

pybind11 begins each docstring with a signature, and the options that a call takes as **kwargs are in `_options` of the
module. A type is told once, at its binding: by the C++ type, or by the text of a `Typed` (python/typed.hpp). Here is
how pybind11's words become those of Python's typing, and names for what the stub says again and again.
"""
import ast
import inspect
import os
import re
import sys

STUB = os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(__file__))), "python", "vantage", "__init__.pyi")
WIDTH = 120
PREAMBLE = """\
# SPDX-License-Identifier: Apache-2.0
# Types of the module, written by packaging/write_stub.py; shapes, units and errors are in the docstrings.
import os
from typing import Any, Callable, Dict, Iterable, List, Literal, Mapping, Optional, Sequence, Tuple, Union

import numpy as np
import numpy.typing as npt

__version__: str

# A point (x, y, z): survey frame, metres.
Vec3 = Tuple[float, float, float]
# The same where it is given: any three numbers.
Point = Union[Sequence[float], npt.NDArray[Any]]
# A file or a folder.
Path = Union[str, os.PathLike[str]]
# Called with the share done, in [0, 1], now and then; the call ends early if it returns False.
Progress = Callable[[float], Any]
# Heads as an array (n, 3): survey frame, metres; or stations with their set-ups; or stations that were placed.
Stations = Union[npt.ArrayLike, Sequence[Station], Sequence[PlacedStation]]
# A region seen from above, survey frame: points inside an odd number of its rings of corners (x, y).
Rings = Sequence[Sequence[Tuple[float, float]]]
# An array; docstrings tell its shape.
Floats = npt.NDArray[np.float64]
# Value of a setting, in the form of the option of that name: a number, a text, a truth value, or a sequence of them.
Setting = Union[None, bool, float, Path, Sequence[Any]]
"""
ASSIGNED = [node for node in ast.parse(PREAMBLE).body if isinstance(node, ast.Assign)]
ALIASES = {ast.unparse(node.value): node.targets[0].id for node in ASSIGNED}

# Types as pybind11 names them, those that tell nothing, and what every object has or only pickle asks for.
NAMES = {"os.PathLike": "Path", "numpy.ndarray": "npt.NDArray[Any]", "numpy.typing.ArrayLike": "npt.ArrayLike"}
UNTYPED = {"object", "handle", "function", "dict", "list", "tuple", "set", "iterable", "iterator", "sequence", "array"}
USUAL = set(vars(object)) - {"__init__"} | {"__getstate__", "__setstate__"}


def words(node, given):
    """A type in the words of the stub; pybind11's are the same where it is given and where it is returned."""
    if isinstance(node, ast.List):  # what a function is called with
        text = f"[{', '.join(words(part, not given) for part in node.elts)}]"
    elif not isinstance(node, ast.Subscript) or ast.unparse(node.value) == "Literal":
        text = ast.unparse(node).replace("vantage.", "").replace("'", '"')
        if text in UNTYPED:
            raise TypeError(f"'{text}' tells no reader what it holds; name the type at the binding (python/typed.hpp)")
        text = NAMES.get(text, text)
    else:
        name = ast.unparse(node.value)
        parts = node.slice.elts if isinstance(node.slice, ast.Tuple) else [node.slice]
        if isinstance(parts[0], ast.Constant) and isinstance(parts[0].value, int):  # float[3]: of a list so long
            return words(node.value, given)
        if name == "numpy.ndarray":
            number = ast.unparse(parts[0]).replace("numpy.", "np.").replace("bool", "np.bool_")
            return "npt.ArrayLike" if given else ALIASES.get(f"npt.NDArray[{number}]", f"npt.NDArray[{number}]")
        inner = [words(part, given) for part in parts]
        text = f"{name}[{', '.join(inner)}]"
        if given and name == "List":
            text = f"Sequence[{inner[0]}]"
        elif given and name == "Tuple" and inner[1:] == ["..."]:
            text = f"Iterable[{inner[0]}]"
        elif given and ALIASES.get(text) == "Vec3":
            text = "Point"
    return ALIASES.get(text, text)


def typed(text, given):
    return words(ast.parse(text, mode="eval").body, given)


def default_of(text):
    """A default as it is written, if that is a literal."""
    try:
        ast.literal_eval(text)
    except (ValueError, SyntaxError):
        return "..."
    return text.replace("'", '"')


def signature_of(function):
    line = (function.__doc__ or "").split("\n")[0]
    try:
        return ast.parse(f"def told{line[line.index('('):]}: ...").body[0]
    except (ValueError, SyntaxError):  # for a type that is bound later, pybind11 has C++'s name
        raise TypeError(f"'{line}' is no signature of Python's") from None


def parameters_of(signature, where, options):
    every = signature.args

    def written(argument, default):
        if argument.arg == "self":
            return "self"
        text = f"{argument.arg}: {words(argument.annotation, True)}"
        return text if default is None else f"{text} = {default_of(ast.unparse(default))}"

    defaults = [None] * (len(every.args) - len(every.defaults)) + every.defaults
    named = list(map(written, every.kwonlyargs, every.kw_defaults))
    if every.kwarg:
        for name, (kind, value) in options[where].items():
            named.append(f"{name}: {typed(kind, True)} = {default_of(repr(value))}")
    return list(map(written, every.args, defaults)) + ["*"] * bool(named) + named


def function_lines(name, where, function, options, indent=""):
    signature = signature_of(function)
    parameters, returns = parameters_of(signature, where, options), words(signature.returns, False)
    line = f"{indent}def {name}({', '.join(parameters)}) -> {returns}: ..."
    if len(line) <= WIDTH:
        return [line]
    return [f"{indent}def {name}(", *(f"{indent}    {each}," for each in parameters), f"{indent}) -> {returns}: ..."]


def property_lines(name, of):
    got = words(signature_of(of.fget).returns, False)
    given = words(signature_of(of.fset).args.args[1].annotation, True) if of.fset else None
    if given == got:
        return [f"    {name}: {got}"]
    lines = ["    @property", f"    def {name}(self) -> {got}: ..."]
    return lines + [f"    @{name}.setter", f"    def {name}(self, given: {given}) -> None: ..."] * bool(given)


def member_lines(name, where, value, options):
    if isinstance(value, property):
        return property_lines(name, value)
    if isinstance(value, staticmethod):
        return ["    @staticmethod", *function_lines(name, where, value.__func__, options, "    ")]
    return function_lines(name, where, value, options, "    ")


def is_told(name, value):
    """Whether the stub has a member: the public ones, and special ones that the binding made."""
    return not name.startswith("_") or (name not in USUAL and "(self: " in (getattr(value, "__doc__", None) or ""))


def class_lines(name, of, options):
    bases = [base.__name__ for base in of.__bases__ if base.__module__ != "pybind11_builtins"]
    lines = [f"    {member}: {typed(text, False)}" for member, text in vars(of).get("__annotations__", {}).items()]
    for member, value in vars(of).items():
        if not is_told(member, value):
            continue
        where = name if member == "__init__" else f"{name}.{member}"
        try:
            lines += member_lines(member, where, value, options)
        except TypeError as error:
            raise TypeError(f"{member}: {error}") from None
    return ["", f"class {name}{'(' + ', '.join(bases) + ')' if bases else ''}:", *lines, ""]


def stub(module):
    """The text of the stub of `vantage._core`, which the package gives on."""
    lines = []
    for name, value in vars(module).items():
        if name.startswith("_"):
            continue
        try:
            if inspect.isclass(value):
                lines += class_lines(name, value, module._options)
            else:
                lines += function_lines(name, name, value, module._options)
        except TypeError as error:
            raise TypeError(f"{name}: {error}") from None
    return re.sub("\n{3,}", "\n\n", "\n".join([PREAMBLE, *lines])).rstrip("\n") + "\n"


if __name__ == "__main__":
    sys.path.insert(0, sys.argv[1])
    from vantage import _core

    try:
        text = stub(_core)
    except TypeError as error:
        sys.exit(f"write_stub: {error}")
    with open(STUB, "w", encoding="utf-8") as file:
        file.write(text)
