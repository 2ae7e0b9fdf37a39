# SPDX-License-Identifier: Apache-2.0
"""What can be broken in a line of C++ or GLSL: an operator, a comparison, a constant, a bound, a sign.

Text is looked at without comments, strings, preprocessor lines, assertions, messages and template arguments, so that
what is broken is something that runs.
"""
import dataclasses
import re


@dataclasses.dataclass(frozen=True)
class Break:
    line: int  # counted from 1
    column: int  # of the first character that goes
    length: int  # characters that go
    put: str  # what comes in their place
    kind: str

    def applied_to(self, line_text):
        return line_text[: self.column] + self.put + line_text[self.column + self.length :]


_NOT_CODE = re.compile(
    r"""(?P<comment>//[^\n]*|/\*.*?\*/)
      | (?P<string>"(?:\\.|[^"\\\n])*")
      | (?P<character>(?<![0-9A-Fa-f])'(?:\\.|[^'\\\n])+')
      | (?P<preprocessor>^[ \t]*\#(?:\\\n|[^\n])*)""",
    re.VERBOSE | re.DOTALL | re.MULTILINE,
)
# Statements that only say something, or only hold when compiled.
_NOT_RUN = re.compile(
    r"""\bthrow\b[^;]*;
      | \b(?:static_assert|assert)\b[^;]*;
      | \)(?:[ ]const)?(?:[ ]noexcept)?[ ]=[ ]0;
      | \b(?:warn|spdlog::\w+)\([^;]*;
      | ^[ \t]*(?:using|namespace|template|typedef|friend|layout|struct|class|enum)\b[^\n]*
      | (?:(?<=[;{}])|^)[ \t]*[\w.]+(?:\(\))?\s<<[^;]*;""",
    re.VERBOSE | re.MULTILINE,
)
_TEMPLATE = re.compile(r"(?<=\w)<[^<>;(){}]*>")

_OPERATORS = {
    "comparison": {"==": ["!="], "!=": ["=="], "<": ["<=", ">"], ">": [">=", "<"], "<=": ["<", ">="],
                   ">=": [">", "<="]},
    "operator": {"+": ["-"], "-": ["+"], "*": ["/"], "/": ["*"], "%": ["/"], "&": ["|"], "|": ["&"], "^": ["|"],
                 "<<": [">>"], ">>": ["<<"], "&&": ["||"], "||": ["&&"], "+=": ["-="], "-=": ["+="], "*=": ["/="],
                 "/=": ["*="], "|=": ["&="], "&=": ["|="], "^=": ["|="], "<<=": [">>="], ">>=": ["<<="]},
}  # fmt: skip
_REPLACED = {old: (kind, new) for kind, table in _OPERATORS.items() for old, new in table.items()}
# Between two spaces: which is how clang-format tells an operator from a pointer, a reference or a template.
_OPERATOR = re.compile(r"(?<= )(?:<<=|>>=|[=!<>+\-*/|&^]=|<<|>>|&&|\|\||[-+*/%&|^<>])(?=[ \n])")
_SIGN = re.compile(r"(?:(?<=[(\[{])|(?<=, )|(?<=[=?:<>+*/&|] )|(?<=return ))(?:-(?=[\w(.])|!(?=[\w(]))")
_BOUND = re.compile(r"\b(?:min|max|floor|ceil|true|false)\b(?=\(|[ ;,)}]|$)", re.MULTILINE)
_OPPOSITE = {"min": "max", "max": "min", "floor": "ceil", "ceil": "floor", "true": "false", "false": "true"}
_NUMBER = re.compile(r"(?<![\w.'])(0[xX][0-9a-fA-F]+|(?:\d[\d']*\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)([a-zA-Z]*)(?![\w.'])")


def _blank(match):
    return re.sub(r"[^\n]", " ", match.group())


def what_runs(text):
    """The text with all else blanked out; every character keeps its place."""
    text = _NOT_RUN.sub(_blank, _NOT_CODE.sub(_blank, text))
    while _TEMPLATE.search(text):
        text = _TEMPLATE.sub(lambda match: re.sub(r"[^\n]", "_", match.group()), text)
    return text


def _other_numbers(number, suffix):
    if number[:2].lower() == "0x":
        return [f"0x{int(number, 16) ^ 1:X}{suffix}"]
    plain = number.replace("'", "")
    if re.fullmatch(r"\d+", plain) and suffix.lower() != "f":
        value = int(plain)
        return [f"{value + 1}{suffix}"] + ([f"{value - 1}{suffix}"] if value > 0 else [])
    value = float(plain)
    return [f"{1.0 if value == 0 else value * 1.5!r}{suffix}"]


def breaks_of(text):
    """Every break of the text, by line."""
    found = {}
    for at, line in enumerate(what_runs(text).split("\n"), start=1):

        def add(match, put, kind, length=None):
            length = len(match.group()) if length is None else length
            found.setdefault(at, []).append(Break(at, match.start(), length, put, kind))

        for match in _OPERATOR.finditer(line + "\n"):
            kind, others = _REPLACED.get(match.group(), (None, []))
            for other in others:
                add(match, other, kind)
        for match in _SIGN.finditer(line):
            add(match, "", "sign")
        for match in _BOUND.finditer(line):
            add(match, _OPPOSITE[match.group()], "bound")
        for match in _NUMBER.finditer(line):
            for other in _other_numbers(*match.groups()):
                add(match, other, "constant")
    return found
