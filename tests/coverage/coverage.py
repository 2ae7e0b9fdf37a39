#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Which lines and branches of the library the tests run, by module.

    cmake -G Ninja -S . -B build/coverage -DVANTAGE_COVERAGE=ON && ninja -C build/coverage
    find build/coverage/tests/{unit,golden,conformance,stress} -name '*_test' -type f -exec {} \\;
    tests/coverage/coverage.py build/coverage            a table; --lines MODULE lists the lines that nothing ran,
                                                         --files REGEX has a row for each file of that name

Reads what gcov says of every object. Of branches, those that only an exception takes are left out: every call has one.
"""
import argparse
import collections
import json
import pathlib
import re
import subprocess


def reports(build):
    """What gcov says of each object, one after another."""
    counted = sorted(build.rglob("*.gcda"))
    if not counted:
        raise SystemExit(f"no counts below {build}; configure it with -DVANTAGE_COVERAGE=ON, build it and run the tests")
    for path in counted:
        told = subprocess.run(["gcov", "--json-format", "--stdout", "--branch-probabilities", str(path)],
                              cwd=build, capture_output=True, text=True)  # fmt: skip
        for line in told.stdout.splitlines():
            report = json.loads(line)
            yield pathlib.Path(report["current_working_directory"]), report["files"]


def counted_lines(build, root):
    """By file below the root's src and include: {line: times}, {(line, branch): times}."""
    lines = collections.defaultdict(collections.Counter)
    branches = collections.defaultdict(collections.Counter)
    for folder, files in reports(build):
        for file in files:
            path = (folder / file["file"]).resolve()
            if not any(path.is_relative_to(root / part) for part in ("src", "include")):
                continue
            name = str(path.relative_to(root))
            for line in file["lines"]:
                lines[name][line["line_number"]] += line["count"]
                taken = [b["count"] for b in line["branches"] if not b["throw"]]
                for k, count in enumerate(taken):
                    branches[name][line["line_number"], k] += count
    return lines, branches


def module_of(name):
    parts = name.split("/")
    return parts[1] if parts[0] == "src" else "include"


def share(counts):
    run = sum(count > 0 for count in counts)
    return f"{run} of {len(counts)} ({100 * run / len(counts):.1f} %)" if counts else "none"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--lines", metavar="MODULE", help="list what was not run there")
    parser.add_argument("--files", metavar="REGEX", help="a row a file, of those whose names it is found in")
    args = parser.parse_args()
    root = pathlib.Path(__file__).resolve().parents[2]
    lines, branches = counted_lines(args.build.resolve(), root)
    if args.lines:
        for name in sorted(name for name in lines if module_of(name) == args.lines):
            missed = sorted(line for line, count in lines[name].items() if count == 0)
            if missed:
                print(f"{name}: {', '.join(map(str, missed))}")
        return
    row_of = module_of
    if args.files:
        lines = {name: counts for name, counts in lines.items() if re.search(args.files, name)}
        row_of = str
    print(f"| {'file' if args.files else 'module'} | lines run | branches taken |\n| --- | --- | --- |")
    for row in sorted({row_of(name) for name in lines}) + ["all"]:
        of = lambda counts: [c for n in lines if row in ("all", row_of(n)) for c in counts[n].values()]  # noqa: E731, B023
        print(f"| {row} | {share(of(lines))} | {share(of(branches))} |")


if __name__ == "__main__":
    main()
