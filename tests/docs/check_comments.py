#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""check_comments.py SOURCE: public declarations of include/vantage without a comment, which the reference would have nothing to say about.
Special members, forward declarations and what overrides a documented function need none; declarators of one statement share one."""
import glob
import os
import re
import sys

TYPE = re.compile(r"(?:template <[^>]*> )?(?:struct|class|enum class|enum) (\w+)[^()=]*$")
TOKEN = re.compile(r'///<?|//|"(?:\\.|[^"\\])*"|\'(?:\\.|[^\'\\])\'|\n|[{};,]|(?:public|private|protected):(?!:)|\w+|.')


def needs_none(text):
    return re.search(r"= (?:default|delete)$|\boverride\b|~\w+\(|\b(\w+)\(\1&&\)|\boperator=\(\w+&&\)", text) \
        or re.match(r"using [\w:]+$|friend [^{]*\w+\([^{]*$|static_assert", text)


class Header:
    def __init__(self, path):
        self.path, self.missing, self.scopes = path, [], []  # of each scope: its kind, and whether it is public
        self.text, self.line, self.commented, self.last = "", 1, False, None

    def end(self, defined=False):
        """The declaration at hand is complete; a comment behind it may follow. Types are told of where they are defined."""
        text = re.sub(r"\s+", " ", self.text).strip()
        if not defined and re.match(r"(?:friend )?(?:class|struct) \w+$", text):
            text = ""
        public = all(public for _, public in self.scopes)
        self.last = None
        if text and public and not self.commented and not needs_none(text):
            self.last = f"{self.path}:{self.line}: {text[:100]}"
            self.missing.append(self.last)
        self.text, self.commented = "", False

    def behind(self):
        """A comment behind a declaration, or within one that runs over lines."""
        if self.text.strip():
            self.commented = True
        elif self.last:
            self.missing.remove(self.last)
            self.last = None

    def opens(self):
        text = re.sub(r"\s+", " ", self.text).strip()
        if text.startswith("namespace"):
            self.scopes.append(("namespace", True))
            self.text, self.commented = "", False  # the header's own comment is for no declaration
        elif TYPE.match(text):
            self.end(defined=True)
            self.scopes.append(("enum" if "enum" in text.split(" ")[:1] else "type", not text.split("> ")[-1].startswith("class")))
        else:
            self.scopes.append(("code", True))

    def closes(self):
        kind, _ = self.scopes.pop()
        if kind == "enum" and self.text.strip():
            self.end()
        elif kind == "code" and re.search(r"\)[^=()]*$", self.text) and not any(kind == "code" for kind, _ in self.scopes):
            self.end()  # a function's body, and no initial value

    def read(self, source):
        within = None  # a comment: its mark
        number = 1
        for token in TOKEN.findall(source):
            if token == "\n":
                within, number = None, number + 1
                self.text += " "
                continue
            code = bool(self.scopes) and self.scopes[-1][0] == "code"
            if within or token in ("//", "///", "///<"):
                if not within and not code:
                    if token == "///<":
                        self.behind()
                    elif token == "///":
                        self.commented = True
                within = within or token
            elif token == "{":
                self.opens()
            elif token == "}":
                self.closes()
            elif code:
                continue
            elif re.match(r"(?:public|private|protected):", token):
                self.scopes[-1] = ("type", token == "public:")
            elif token == ";" or token == "," and self.scopes and self.scopes[-1][0] == "enum":
                self.end()
            elif not self.text.strip() and token.strip():
                self.text, self.line = token, number
            else:
                self.text += token
        return self.missing


def main():
    root = os.path.abspath(sys.argv[1])
    headers = sorted(glob.glob(os.path.join(root, "include", "vantage", "*.hpp")))
    missing = []
    for path in headers:
        name = os.path.relpath(path, root)
        with open(path, encoding="utf-8") as file:
            source = file.read()
        if not re.match(r"//.*\n/// ", source):
            missing.append(f"{name}:2: the header itself")
        missing += Header(name).read(re.sub(r"(?m)^#.*$", "", source))
    if not headers or missing:
        raise SystemExit("\n".join(missing) or "there are no headers")


main()
