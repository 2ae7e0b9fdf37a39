# SPDX-License-Identifier: Apache-2.0
"""A copy of the tree in which lines are broken, built and tested, one after another."""
import contextlib
import itertools
import os
import pathlib
import re
import shutil
import signal
import subprocess
import threading
import time


def program_of(build, name):
    """As the build folder was configured with."""
    cache = (build / "CMakeCache.txt").read_text()
    return re.search(rf"^{name}:\w+=(.*)$", cache, re.MULTILINE).group(1)


def commands_to_build(build, targets):
    """What ninja would run, in order; to be run in the build folder."""
    plan = build / "build.asked.ninja"  # by another name ninja does not look first whether CMake has to run again
    shutil.copy(build / "build.ninja", plan)
    try:
        command = [program_of(build, "CMAKE_MAKE_PROGRAM"), "-f", plan.name, "-n", "-v", *targets]
        told = subprocess.run(command, cwd=build, capture_output=True, text=True, check=True)
    finally:
        plan.unlink()
    return re.findall(r"^\[\d+/\d+\] (.*)$", told.stdout, re.MULTILINE)


def commands_after_change(path, build, targets):
    """What it would run if the file changed."""
    before = path.stat()
    os.utime(path)
    try:
        return commands_to_build(build, targets)
    finally:
        os.utime(path, ns=(before.st_atime_ns, before.st_mtime_ns))


def stopped(process):
    """Ends it with all that it started."""
    with contextlib.suppress(ProcessLookupError):
        os.killpg(process.pid, signal.SIGKILL)
    process.wait()


class Worker:
    def __init__(self, folder, root, build, cores):
        self.folder, self.root, self.build, self.cores = folder, root, build, cores
        self.tree, self.temporary = folder / "tree", folder / "tmp"
        self.running = set()
        self.lock = threading.Lock()

    def copied(self, path):
        """Where the copy of a path of the tree is. The build folder may lie elsewhere."""
        path = pathlib.Path(path)
        if path.is_relative_to(self.build):
            return self.folder / "build" / path.relative_to(self.build)
        return self.tree / path.relative_to(self.root)

    def copy_tree(self):
        if self.folder.exists():
            shutil.rmtree(self.folder)
        for made in (self.temporary, self.tree):
            made.mkdir(parents=True)
        parts = [self.root / part for part in ("include", "src", "shaders", "cmake", "tests", "data")]
        subprocess.run(["cp", "-a", *parts, self.tree], check=True)
        subprocess.run(["cp", "-a", self.build, self.folder / "build"], check=True)

    def here(self, command):
        """A command of the tree, for its copy."""
        paths = {str(self.build): str(self.folder / "build"), str(self.root): str(self.tree)}
        return re.sub("|".join(map(re.escape, paths)), lambda match: paths[match.group()], command)

    def run(self, command, seconds, cores, cwd=None, environment=None, limits=None):
        """(exit code, output); the code is None where it took too long."""

        def prepare():
            os.sched_setaffinity(0, cores)
            if limits:
                limits()

        environment = {**os.environ, "TMPDIR": str(self.temporary), **(environment or {})}
        process = subprocess.Popen(command, shell=isinstance(command, str), cwd=cwd or self.folder / "build",
                                   stdout=subprocess.PIPE, stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL,
                                   env=environment, start_new_session=True, preexec_fn=prepare)  # fmt: skip
        with self.lock:
            self.running.add(process)
        try:
            output, _ = process.communicate(timeout=seconds)
            return process.returncode, output.decode(errors="replace")
        except subprocess.TimeoutExpired:
            return None, ""
        finally:
            with self.lock:
                self.running.remove(process)
                stopped(process)

    def stop(self):
        """Ends what runs here now; who waits for it gets a signal's exit code."""
        with self.lock:
            for process in self.running:
                with contextlib.suppress(ProcessLookupError):
                    os.killpg(process.pid, signal.SIGKILL)

    def rebuild(self, commands, rank):
        """What the first one that fails says; None without. Compilations in a row know nothing of each other."""
        run = lambda command, cores: self.run(self.here(command), 600, cores)  # noqa: E731
        for compiling, row in itertools.groupby(commands, lambda command: bool(re.search(r" -o \S+ -c ", command))):
            if compiling:
                results = [future.result() for future in [self.cores.submit(rank, run, command) for command in row]]
            else:
                results = (self.cores.submit(rank, run, command).result() for command in row)
            for code, output in results:
                if code != 0:
                    return output or "it takes too long"
        return None

    def try_mutant(self, mutant, commands, suite, rank, end):
        """What became of it; None where the time ended first."""
        start, started = time.monotonic(), time.time_ns()
        path = self.tree / mutant["file"]
        whole = path.read_text()
        lines = whole.split("\n")
        lines[mutant["line"] - 1] = mutant["after"]
        path.write_text("\n".join(lines))
        try:
            if (failure := self.rebuild(commands, rank)) is not None:
                if "error" not in failure:
                    raise RuntimeError(f"{mutant['file']} is not rebuilt: {failure}")
                return {"outcome": "unbuildable", "seconds": time.monotonic() - start}
            found = suite.first_failure(mutant["file"], self, rank, end)
            if found is None:
                return None
            return {**found, "seconds": time.monotonic() - start}
        finally:
            path.write_text(whole)
            self.restore(started)

    def restore(self, since):
        """Takes back what was built since then."""
        for folder, _, names in os.walk(self.folder / "build"):
            for name in names:
                copy = pathlib.Path(folder, name)
                if copy.is_symlink() or copy.stat().st_mtime_ns < since:
                    continue
                original = self.build / copy.relative_to(self.folder / "build")
                copy.unlink()
                if original.exists():
                    shutil.copy2(original, copy)
        shutil.rmtree(self.temporary)
        self.temporary.mkdir()
