#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Breaks lines at random, one thing in each, and tells which of them the tests notice.

    cmake -G Ninja -S . -B build/mutation -DCMAKE_BUILD_TYPE=Release -DBUILD_SHARED_LIBS=ON \\
          -DCMAKE_LINK_DEPENDS_NO_SHARED=ON -DCMAKE_CXX_FLAGS=-D_GLIBCXX_ASSERTIONS
    ninja -C build/mutation
    tests/mutation/mutate.py build/mutation --lines 100 --seed 1 -o build/mutation/found

Asks ninja what a changed file makes it run and runs just that, in copies of the tree, one a worker. Tests are those
that ctest lists, its own module's first, then the quick ones, up to the first that fails; cases that fail before
anything is broken are left out, and said. A second run with the same arguments goes on where the first one ended.
Writes, after each line, found.json, a record of all, and found.md, what is to be read. Linux only; nothing but Python's
standard library.
"""
import argparse
import json
import os
import pathlib
import queue
import random
import re
import shutil
import sys
import threading
import time

from breaks import breaks_of
from cores import Cores
from suite import Suite
from worker import Worker, commands_after_change, commands_to_build

SOURCES = (".cpp", ".hpp", ".h", ".comp", ".glsl")
MODULES = ["src/objective", "src/voxel", "src/scan", "src/optimise", "src/trace", "shaders"]
NOTES = pathlib.Path(__file__).with_name("equivalent.json")


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path, help="a build folder of this tree, built with its tests by ninja")
    parser.add_argument("--lines", type=int, default=100, help="how many to break (default: %(default)s)")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--paths", nargs="+", default=MODULES, help="folders to break lines in (default: %(default)s)")
    parser.add_argument("--exclude", default="$^", help="a regular expression of files that are left whole")
    parser.add_argument("--tests", default=r".", help="a regular expression of ctest's names (default: all)")
    parser.add_argument("--exclude-tests", default="^(lint|mutation|consumer|machine|clients|python|bench)",
                        help="likewise (default: %(default)s)")  # fmt: skip
    parser.add_argument("--workers", type=int, default=len(os.sched_getaffinity(0)),
                        help="copies of the tree, each with another line broken (default: that of cores)")  # fmt: skip
    parser.add_argument("--budget-seconds", type=float, default=float("inf"), help="then it ends, to be called again")
    parser.add_argument("--most-commands", type=int, default=80, help="files whose change takes more are left whole")
    parser.add_argument("--environment", nargs="*", default=[], metavar="NAME=VALUE", help="of tests, over ctest's own")
    parser.add_argument("--memory-gb", type=float, default=8, help="of a test, at most; 0: any")
    parser.add_argument("--only", type=pathlib.Path, metavar="JSON", help="try again what slipped through there")
    parser.add_argument("--scratch", type=pathlib.Path, help="where the copies lie (default: beside the build folder)")
    parser.add_argument("-o", "--output", type=pathlib.Path, default=pathlib.Path("mutations"))
    return parser.parse_args()


def key(mutant):
    return (mutant["file"], mutant["line"], mutant["before"], mutant["after"])


def drawn(root, args):
    """Lines in a random order, each with one break: the same for the same tree and seed."""
    lines = []
    for folder in args.paths:
        for path in sorted((root / folder).rglob("*")):
            name = str(path.relative_to(root))
            if path.suffix not in SOURCES or re.search(args.exclude, name):
                continue
            text = path.read_text()
            for at, breaks in breaks_of(text).items():
                lines.append((name, text.split("\n")[at - 1], breaks))
    rng = random.Random(args.seed)
    rng.shuffle(lines)
    for name, before, breaks in lines:
        chosen = rng.choice(breaks)
        after = chosen.applied_to(before)
        yield {"file": name, "line": chosen.line, "kind": chosen.kind, "before": before, "after": after}


def explained(mutant, notes):
    """Why no test can notice it, as somebody wrote it down; lines may have moved since."""
    same = lambda note: all(note[k].strip() == mutant[k].strip() for k in ("file", "before", "after"))  # noqa: E731
    return next((note["why"] for note in notes if same(note)), None)


def table(state, notes):
    broken = [m for m in state["mutants"] if m["outcome"] in ("noticed", "slipped")]
    slipped = [m for m in broken if m["outcome"] == "slipped" and not explained(m, notes)]
    alike = [m for m in broken if m["outcome"] == "slipped" and explained(m, notes)]
    rows = ["| module | lines broken | noticed | nothing to notice | slipped through |"]
    rows += ["| --- | --- | --- | --- | --- |"]
    module = lambda m: "/".join(m["file"].split("/")[:2]) if m["file"].startswith("src/") else "shaders"  # noqa: E731
    for name in sorted({module(m) for m in broken}) + ["all"]:
        of = lambda group: sum(name in ("all", module(m)) for m in group)  # noqa: E731, B023
        noticed = of(broken) - of(alike) - of(slipped)
        rows.append(f"| {name} | {of(broken)} | {noticed} | {of(alike)} | {of(slipped)} |")
    unbuilt = sum(m["outcome"] == "unbuildable" for m in state["mutants"])
    rows += ["", f"Seed {state['seed']}. Besides, {unbuilt} broken lines did not compile, and",
             f"{state['left_whole']} were left whole, since most of the tree includes their file."]  # fmt: skip
    if state["unfinished"]:
        rows += ["", f"Of {state['unfinished']} more the time ended before their tests did."]
    if state["failed_before"]:
        rows += ["", "Left out, since they fail before anything is broken: " + ", ".join(state["failed_before"]) + "."]
    for title, group in (("Slipped through", slipped), ("Nothing to notice", alike)):
        rows += ["", f"## {title}", ""]
        for m in group:
            rows += ["```diff", f"@@ {m['file']}:{m['line']} ({m['kind']})", f"-{m['before']}", f"+{m['after']}", "```"]
            rows += [explained(m, notes) or "", ""]
    return "\n".join(rows) + "\n"


def write(path, text):
    """Whole or not at all."""
    path.parent.mkdir(parents=True, exist_ok=True)
    fresh = path.with_name(path.name + ".new")
    fresh.write_text(text)
    fresh.replace(path)


class Run:
    """What the workers share: the lines that are still to be broken, and what became of the others."""

    def __init__(self, root, args, suite):
        self.root, self.args, self.suite = root, args, suite
        self.end = time.monotonic() + args.budget_seconds
        self.lock = threading.Lock()
        self.notes = json.loads(NOTES.read_text())
        self.path = args.output.with_suffix(".json")
        self.state = {"seed": args.seed, "paths": args.paths, "left_whole": 0, "unfinished": 0, "failed_before": [],
                      "mutants": []}
        if self.path.exists():
            self.state = json.loads(self.path.read_text())
            if (self.state["seed"], self.state["paths"]) != (args.seed, args.paths):
                sys.exit(f"{self.path} is of another seed or other folders; give another -o, or remove it")
        self.done = {key(m) for m in self.state["mutants"]}
        self.state["left_whole"] = self.state["unfinished"] = 0
        source = json.loads(args.only.read_text())["mutants"] if args.only else drawn(root, args)
        wanted = (m for m in source if m["outcome"] == "slipped") if args.only else source
        self.coming = ({k: m[k] for k in ("file", "line", "kind", "before", "after")} for m in wanted)
        self.under_way = 0
        self.rank = 0
        self.commands = {}

    def next(self):
        """The next line, the commands that rebuild what hangs on it, and its rank; None at the end."""
        with self.lock:
            broken = sum(m["outcome"] != "unbuildable" for m in self.state["mutants"])
            if time.monotonic() > self.end or broken + self.under_way >= self.args.lines:
                return None
            for mutant in self.coming:
                if key(mutant) in self.done:
                    continue
                if mutant["file"] not in self.commands:
                    self.commands[mutant["file"]] = commands_after_change(
                        self.root / mutant["file"], self.args.build, self.suite.targets())
                commands = self.commands[mutant["file"]]
                if not commands or len(commands) > self.args.most_commands:
                    self.state["left_whole"] += 1
                    continue
                self.under_way += 1
                self.rank += 1
                return mutant, commands, self.rank
            return None

    def tell(self, mutant, outcome):
        with self.lock:
            self.under_way -= 1
            if outcome is None:  # the budget ended first
                self.state["unfinished"] += 1
                return
            mutant.update(outcome)
            self.state["mutants"].append(mutant)
            self.write()
            print(f"{mutant['outcome']:12}{mutant['seconds']:6.0f} s  {mutant['file']}:{mutant['line']}",
                  f"{mutant['after'].strip()}   [{mutant.get('by', '')}]", flush=True)  # fmt: skip


    def write(self):
        self.state["failed_before"] = self.suite.failed_before
        write(self.path, json.dumps(self.state, indent=1, ensure_ascii=False) + "\n")
        write(self.path.with_suffix(".md"), table(self.state, self.notes))


def in_threads(work, workers):
    """`work(worker)` for each at once; the first failure is the caller's."""
    failures = queue.Queue()

    def guarded(worker):
        try:
            work(worker)
        except BaseException as failure:  # noqa: BLE001, which is raised again below
            failures.put(failure)

    threads = [threading.Thread(target=guarded, args=(worker,)) for worker in workers]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    if not failures.empty():
        raise failures.get()


def main():
    args = arguments()
    root = pathlib.Path(__file__).resolve().parents[2]
    args.build = args.build.resolve()
    environment = dict(pair.split("=", 1) for pair in args.environment)
    suite = Suite(args.build, args.tests, args.exclude_tests, environment, args.memory_gb)
    if left := commands_to_build(args.build, suite.targets()):
        sys.exit(f"{len(left)} commands of {args.build} have not been run; build it first: ninja -C {args.build}")
    run = Run(root, args, suite)
    scratch = (args.scratch or args.build.with_name(args.build.name + ".workers")).resolve()
    cores = Cores(sorted(os.sched_getaffinity(0)))
    workers = [Worker(scratch / str(k), root, args.build, cores) for k in range(args.workers)]
    in_threads(lambda worker: worker.copy_tree(), workers)
    print(f"{len(suite.programs)} test programs in {len(workers)} copies; trying them unbroken", flush=True)
    suite.try_unbroken(workers[0], cores)
    for name in suite.failed_before:
        print(f"left out, since it fails unbroken: {name}", flush=True)
    print(f"{sum(piece.seconds for piece in suite.pieces):.0f} s of tests in {len(suite.pieces)} pieces", flush=True)

    def break_lines(worker):
        while (task := run.next()) is not None:
            mutant, commands, rank = task
            run.tell(mutant, worker.try_mutant(mutant, commands, suite, rank, run.end))

    in_threads(break_lines, workers)
    run.write()
    print(table(run.state, run.notes))
    shutil.rmtree(scratch)


if __name__ == "__main__":
    main()
