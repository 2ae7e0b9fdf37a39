# SPDX-License-Identifier: Apache-2.0
"""The tests that ctest lists, in pieces of some seconds: cases of a GoogleTest program that share a process."""
import collections
import concurrent.futures
import dataclasses
import json
import pathlib
import re
import resource
import subprocess
import sys
import threading
import time

from worker import program_of

_PASSED = re.compile(r"^\[       OK \] (\S+?)(?:, where .*)? \((\d+) ms\)$", re.MULTILINE)
_FAILED = re.compile(r"^\[  FAILED  \] (\S+?)(?:,| \(|$)", re.MULTILINE)
_SHARDS = 8  # of a program, while it is tried unbroken
_PIECE_SECONDS = 10
_PIECE_CASES = 200  # the list is one argument
_ALONE_SECONDS = 20  # so long a line's tests run one by one; what is not noticed by then has them all run


class Program:
    def __init__(self, executable, arguments, properties):
        self.executable, self.arguments = executable, arguments
        self.environment = dict(pair.split("=", 1) for pair in properties.get("ENVIRONMENT", []))
        self.must_say = [re.compile(r) for r in properties.get("PASS_REGULAR_EXPRESSION", [])]
        self.must_not_say = [re.compile(r) for r in properties.get("FAIL_REGULAR_EXPRESSION", [])]
        self.folder = properties.get("WORKING_DIRECTORY")
        self.cases = []  # those that ctest lists; empty: all

    def name(self):
        return pathlib.Path(self.executable).name

    def is_of_google_test(self):
        return bool(self.cases) or any(a.startswith("--gtest") for a in self.arguments)

    def passes(self, code, output):
        if any(r.search(output) for r in self.must_not_say):
            return False
        return any(r.search(output) for r in self.must_say) if self.must_say else code == 0


@dataclasses.dataclass
class Piece:
    program: Program
    cases: list
    seconds: float


class Suite:
    def __init__(self, build, wanted, unwanted, environment, memory_gb):
        self.build, self.environment = build, environment
        self.memory = int(memory_gb * 2**30)
        self.failed_before = []
        self.pieces = []
        self.lock = threading.Lock()
        command = [program_of(build, "CMAKE_CTEST_COMMAND"), "--show-only=json-v1"]
        listed = subprocess.run(command, cwd=build, capture_output=True, text=True, check=True)
        found = {}
        for test in json.loads(listed.stdout)["tests"]:
            if not re.search(wanted, test["name"]) or re.search(unwanted, test["name"]) or "command" not in test:
                continue
            executable, *arguments = test["command"]
            if not pathlib.Path(executable).is_relative_to(build):
                continue  # scripts, which test no code of the library
            properties = {p["name"]: p["value"] for p in test["properties"]}
            case = next((a.split("=", 1)[1] for a in arguments if a.startswith("--gtest_filter=")), None)
            rest = [] if case else arguments
            program = found.setdefault((executable, *rest), Program(executable, rest, properties))
            if case:
                program.cases.append(case)
        if not found:
            sys.exit(f"ctest lists no tests of {wanted} in {build}")
        self.programs = list(found.values())

    def targets(self):
        """As ninja knows them."""
        return sorted({str(pathlib.Path(p.executable).relative_to(self.build)) for p in self.programs})

    def run(self, program, cases, options, environment, worker, seconds, cores):
        arguments = [worker.here(a) for a in program.arguments if a != "--gtest_brief=1"]
        command = [str(worker.copied(program.executable)), *arguments, *options]
        if cases:
            command.append("--gtest_filter=" + ":".join(cases))
        # A shared library is looked for here first, wherever the program was linked.
        library = {"LD_LIBRARY_PATH": str(worker.folder / "build")}
        environment = {**program.environment, **library, **environment, **self.environment}
        folder = worker.copied(program.folder) if program.folder else None
        limit = lambda: resource.setrlimit(resource.RLIMIT_DATA, (self.memory, self.memory))  # noqa: E731
        return worker.run(command, seconds, cores, folder, environment, limit if self.memory else None)

    def _try_unbroken(self, program, shard, worker, cores):
        environment = {"GTEST_TOTAL_SHARDS": str(_SHARDS), "GTEST_SHARD_INDEX": str(shard)} if shard is not None else {}
        start = time.monotonic()
        code, output = self.run(program, program.cases, [], environment, worker, 900, cores)
        seconds = time.monotonic() - start
        with self.lock:
            failed = set(_FAILED.findall(output))
            if shard is None and program.passes(code, output):
                self.pieces.append(Piece(program, [], seconds))
            elif shard is not None and (failed or program.passes(code, output)):
                return {case: int(ms) / 1000 for case, ms in _PASSED.findall(output) if case not in failed}, failed
            else:  # none of them is known to pass
                self.failed_before.append(program.name() if shard is None else f"{program.name()}, a part")
            return {}, failed

    def try_unbroken(self, worker, cores):
        """Leaves out what fails, and cuts the rest into pieces by the time that it takes, quick ones first."""
        tried = [(program, cores.submit(0, self._try_unbroken, program, shard, worker))
                 for program in self.programs
                 for shard in (range(_SHARDS) if program.is_of_google_test() else [None])]  # fmt: skip
        seconds = collections.defaultdict(dict)
        for program, future in tried:
            passed, failed = future.result()
            seconds[program].update(passed)
            self.failed_before += [f"{program.name()} {case}" for case in failed]
        for program, cases in seconds.items():
            piece = None
            for case in sorted(cases, key=cases.get):
                if piece is None or piece.seconds + cases[case] > _PIECE_SECONDS or len(piece.cases) == _PIECE_CASES:
                    piece = Piece(program, [], 0)
                    self.pieces.append(piece)
                piece.cases.append(case)
                piece.seconds += cases[case]
        self.failed_before.sort()
        self.pieces.sort(key=lambda piece: piece.seconds)
        if not self.pieces:
            sys.exit("every test fails before anything is broken: " + ", ".join(self.failed_before))

    def first_failure(self, file, worker, rank, end):
        """Who notices that this file is broken: its own module's tests are asked first, then the quick ones. None where
        the time ended before."""
        module = file.split("/")[1] if file.startswith("src/") else "trace"
        own = lambda piece: piece.program.name().startswith(module + "_")  # noqa: E731
        waiting = collections.deque(sorted(self.pieces, key=lambda piece: not own(piece)))
        start = time.monotonic()
        asked = {}
        try:
            while waiting or asked:
                alone = time.monotonic() < start + _ALONE_SECONDS
                while waiting and len(asked) < (1 if alone else len(worker.cores)):
                    piece = waiting.popleft()
                    options = ["--gtest_brief=1", "--gtest_fail_fast"] * piece.program.is_of_google_test()
                    what = (piece.program, piece.cases, options, {}, worker, 60 + 10 * piece.seconds)
                    asked[worker.cores.submit(rank, self.run, *what)] = piece.program
                left = min(5, max(0, end - time.monotonic()))
                done, _ = concurrent.futures.wait(asked, left, concurrent.futures.FIRST_COMPLETED)
                for future in done:
                    program = asked.pop(future)
                    code, output = future.result()
                    if not program.passes(code, output):
                        case = _FAILED.search(output)
                        ended = "takes too long" if code is None else f"ends by signal {-code}" if code < 0 else "fails"
                        return {"outcome": "noticed", "by": f"{program.name()} {case.group(1) if case else ended}"}
                if time.monotonic() > end:
                    return None
            return {"outcome": "slipped"}
        finally:
            running = [future for future in asked if not future.cancel()]
            while concurrent.futures.wait(running, 0.1).not_done:
                worker.stop()
