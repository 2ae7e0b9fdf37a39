# SPDX-License-Identifier: Apache-2.0
"""The tests that ctest lists, by program: cases of GoogleTest share one process, up to the first that fails."""
import json
import pathlib
import re
import resource
import subprocess
import sys
import threading
import time

from worker import program_of

_FAILED = re.compile(r"^\[  FAILED  \] (\S+?)(?:,| \(|$)", re.MULTILINE)


class Program:
    def __init__(self, executable, arguments, properties):
        self.executable, self.arguments = executable, arguments
        self.environment = dict(pair.split("=", 1) for pair in properties.get("ENVIRONMENT", []))
        self.must_say = [re.compile(r) for r in properties.get("PASS_REGULAR_EXPRESSION", [])]
        self.must_not_say = [re.compile(r) for r in properties.get("FAIL_REGULAR_EXPRESSION", [])]
        self.folder = properties.get("WORKING_DIRECTORY")
        self.cases = []  # which to run; empty: all but those left out
        self.left_out = []
        self.seconds = 0.0

    def name(self):
        return pathlib.Path(self.executable).name

    def is_of_google_test(self):
        return bool(self.cases) or any(a.startswith("--gtest") for a in self.arguments)

    def filter(self):
        return ":".join(self.cases) + ("-" + ":".join(self.left_out) if self.left_out else "")

    def passes(self, code, output):
        if any(r.search(output) for r in self.must_not_say):
            return False
        return any(r.search(output) for r in self.must_say) if self.must_say else code == 0


class Suite:
    def __init__(self, build, wanted, unwanted, environment, memory_gb):
        self.build, self.environment = build, environment
        self.memory = int(memory_gb * 2**30)
        self.failed_before = []
        self.lock = threading.Lock()
        listed = subprocess.run([program_of(build, "CMAKE_CTEST_COMMAND"), "--show-only=json-v1"], cwd=build, capture_output=True, text=True, check=True)
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

    def run(self, program, worker, seconds, all_cases=False):
        command = [str(worker.copied(program.executable)), *map(worker.here, program.arguments)]
        if program.is_of_google_test():
            command += ["--gtest_brief=1"] + ["--gtest_fail_fast"] * (not all_cases)
            command += ["--gtest_filter=" + program.filter()] if program.filter() else []
        # A shared library is looked for here first, wherever the program was linked.
        environment = {**program.environment, "LD_LIBRARY_PATH": str(worker.folder / "build"), **self.environment}
        folder = worker.copied(program.folder) if program.folder else None
        limit = lambda: resource.setrlimit(resource.RLIMIT_DATA, (self.memory, self.memory))  # noqa: E731
        return worker.run(command, seconds, folder, environment, limit if self.memory else None)

    def try_unbroken(self, program, worker):
        """Leaves out what fails, and takes the time of the rest."""
        while True:
            start = time.monotonic()
            code, output = self.run(program, worker, 900, all_cases=True)
            program.seconds = time.monotonic() - start
            if program.passes(code, output):
                return
            failed = set(_FAILED.findall(output)) - set(program.left_out) if program.is_of_google_test() else set()
            with self.lock:
                self.failed_before += sorted(f"{program.name()} {case}" for case in failed) or [program.name()]
            program.left_out += sorted(failed)
            if not failed:
                program.executable = None
                return

    def settle(self):
        self.programs = sorted((p for p in self.programs if p.executable), key=lambda p: p.seconds)
        self.failed_before.sort()
        if not self.programs:
            sys.exit("every test fails before anything is broken: " + ", ".join(self.failed_before))

    def first_failure(self, file, worker, end):
        """Who notices that this file is broken: its own module's tests are asked first, then the quick ones."""
        module = file.split("/")[1] if file.startswith("src/") else "trace"
        for program in sorted(self.programs, key=lambda p: not p.name().startswith(module + "_")):
            if time.monotonic() > end:
                return None
            code, output = self.run(program, worker, 20 + 10 * program.seconds)
            if not program.passes(code, output):
                case = _FAILED.search(output)
                ended = "takes too long" if code is None else f"ends by signal {-code}" if code < 0 else "fails"
                return {"outcome": "noticed", "by": f"{program.name()} {case.group(1) if case else ended}"}
        return {"outcome": "slipped"}
