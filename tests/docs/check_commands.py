#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""check_commands.py BUILD SOURCE [--night]: the commands of README and docs.

Every `vantage COMMAND --option` in them must be a command and an option of the program. Blocks below `<!-- runs -->` are run as they stand,
one page after the other, each in a folder of its own that has `build/release` and `data`; with --night, those below `<!-- runs at night -->`
too."""
import glob
import os
import re
import subprocess
import sys
import tempfile

BUILD, SOURCE = (os.path.abspath(path) for path in sys.argv[1:3])
MARKS = ["<!-- runs -->"] + (["<!-- runs at night -->"] if "--night" in sys.argv[3:] else [])
PROGRAM = os.path.join(BUILD, "vantage")
PAGES = [os.path.join(SOURCE, "README.md"), *sorted(glob.glob(os.path.join(SOURCE, "docs", "**", "*.md"), recursive=True))]


def lines_of(page):
    """The lines of a page, those that end in a backslash joined with the next."""
    with open(page, encoding="utf-8") as file:
        return re.sub(r"\\\n\s*", " ", file.read()).splitlines()


def options_of(command):
    """The options that a command of the program knows; None if it has no such command."""
    done = subprocess.run([PROGRAM, command, "--help-all"], capture_output=True, text=True)
    return set(re.findall(r"(?<![\w-])--?[a-z][\w-]*", done.stdout)) if done.returncode == 0 else None


def unknown(page, known):
    """What a page says that the program does not know."""
    for number, line in enumerate(lines_of(page), 1):
        for match in re.finditer(r"(?:^ {4}|`|&& )(?:build/release/)?vantage ([a-z][\w-]*)((?: [^`&|;]*)?)", line):
            command, rest = match.groups()
            if command not in known:
                known[command] = options_of(command)
            if known[command] is None:
                yield f"{os.path.basename(page)}, line {number}: `vantage {command}` is no command"
                continue
            for option in re.findall(r"(?<![\w-])--[a-z][\w-]*", rest.split("    ")[0]):
                if option not in known[command]:
                    yield f"{os.path.basename(page)}, line {number}: `vantage {command}` has no {option}"


def blocks_of(page):
    """The commands below each mark, as one text a block."""
    lines = lines_of(page)
    for number, line in enumerate(lines):
        if line.strip() not in MARKS:
            continue
        block = []
        for following in lines[number + 1:]:
            if following.startswith("    "):
                block.append(re.split(r" {4,}", following.strip())[0])  # what follows four blanks is explanation
            elif following.strip() or block:
                break
        if not block:
            raise SystemExit(f"{page}: there is no indented block below `{line.strip()}`")
        yield "\n".join(block)


def run(page):
    """Runs a page's marked blocks; returns their number."""
    blocks = list(blocks_of(page))
    with tempfile.TemporaryDirectory() as folder:
        os.makedirs(os.path.join(folder, "build"))
        os.symlink(BUILD, os.path.join(folder, "build", "release"))
        os.symlink(os.path.join(SOURCE, "data"), os.path.join(folder, "data"))
        path = BUILD + os.pathsep + os.environ["PATH"]
        for block in blocks:
            print(f"{os.path.basename(page)}:\n{block}", flush=True)
            done = subprocess.run(["bash", "-euc", block], cwd=folder, env={**os.environ, "PATH": path}, capture_output=True, text=True)
            if done.returncode not in (0, 3):  # 3: the plan meets less than was asked
                raise SystemExit(f"{page}: exit code {done.returncode}\n{block}\n{done.stdout}{done.stderr}")
    return len(blocks)


def main():
    known = {}
    errors = [error for page in PAGES for error in unknown(page, known)]
    if errors:
        raise SystemExit("\n".join(errors))
    if not any(known.values()):
        raise SystemExit("no page has a command of the program")
    if sum(run(page) for page in PAGES) == 0:
        raise SystemExit("no block is marked to run")


if __name__ == "__main__":
    main()
