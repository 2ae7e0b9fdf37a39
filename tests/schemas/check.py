#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""check.py PROGRAM SCHEMAS MANUAL: what plans and `next` write against the schemas that are shipped, and the manual pages and completions
against the program's own --help."""
import csv
import gzip
import json
import os
import re
import struct
import subprocess
import sys
import tempfile

try:
    from jsonschema import Draft202012Validator
except ImportError:
    sys.exit("python3-jsonschema is not installed (setup.sh --tests does it)")

PROGRAM, SCHEMAS, MANUAL = (os.path.abspath(path) for path in sys.argv[1:4])
QUICK = ["--engine", "embree", "--user-size", "0.4"]
COARSE = [*QUICK, "--step", "2"]
SEARCH = ["--population", "6", "--iterations", "2", "--sample", "200"]
PLANS = {
    "front": ["--problem", "coverage-overlap-fix", "--stations", "3", *SEARCH],
    "required": ["--objectives", "coverage,registration", "--require", "parts<=1", "--stations", "2..4", *SEARCH],
    "kept": ["--problem", "coverage-fix", "--stations", "2", "--keep", "x=8,y=3,z=1.5,heading=30,tilt=80,scanner=rtc360,step=2.5", *SEARCH],
    "survey": ["--capture", "0.5", "--max-time", "5s"],
    "paying": ["--max-time", "5s"],
    "days": ["--problem", "coverage-fix", "--stations", "4", "--keep", "8,0,1.5", "--day", "8min", "--crews", "2", "--battery", "5,3", *SEARCH],
    "targets": ["--problem", "coverage-fix", "--stations", "1", "--keep", "7,1,1.5", "--keep", "7.5,-1,1.5", "--targets", "2", "--targets-from",
                "have.csv", *SEARCH],
}
TARGETS = "name,x,y,z,sigma\nC1,5.5,1,1.5,0.002\nC2,7,-1,1.2,0.003\nC3,6.5,2,1.7,0.002\nT1,5.6,-1,1.8,\n"
TEXTS = {"name", "class", "global_id", "scanner", "status", "proposed", "storey", "room", "why_no_station", "node"}  # columns


def run(folder, *arguments, expected=(0,)):
    done = subprocess.run([PROGRAM, *arguments], cwd=folder, capture_output=True, text=True)
    assert done.returncode in expected, f"{arguments}: {done.returncode}\n{done.stderr}"
    return done.stdout


def validator(path):
    with open(path, encoding="utf-8") as file:
        schema = json.load(file)
    Draft202012Validator.check_schema(schema)
    return Draft202012Validator(schema)


def require(holds, value, what):
    errors = [f"{what}: {'/'.join(map(str, e.absolute_path))}: {e.message[:300]}" for e in holds.iter_errors(value)]
    assert not errors, "\n".join(errors)


def rows(path, texts=TEXTS):
    """The lines of a table, with numbers as numbers, but in columns of text."""
    with open(path, encoding="utf-8", newline="") as file:
        return [{name: cell if name in texts else json.loads(cell) for name, cell in row.items() if cell != ""} for row in csv.DictReader(file)]


def add_room(folder, source, to):
    """A copy of a GLB with a room all around its origin, as importers describe one."""
    with open(os.path.join(folder, source), "rb") as file:
        data = file.read()
    size = struct.unpack_from("<I", data, 12)[0]
    tree, rest = json.loads(data[20:20 + size]), data[20 + size:]
    tree["scenes"][tree.get("scene", 0)]["nodes"].append(len(tree["nodes"]))
    tree["nodes"].append({"extras": {"vantage": {"box": [[-8, 0, -8], [8, 3, 8]], "name": "1.01", "long_name": "Hall"}}})
    text = json.dumps(tree).encode()
    text += b" " * (-len(text) % 4)
    with open(os.path.join(folder, to), "wb") as file:
        file.write(struct.pack("<4sIIII", b"glTF", 2, 20 + len(text) + len(rest), len(text), 0x4E4F534A) + text + rest)


def check_tables(folder, written):
    """Tables of a plan with targets and a room; `written` is its front.json."""
    entry = written["front"][written["answer"] - 1]
    assert {"with_targets", "without_targets", "in_site_frame"} == set(entry["registration_mm"])
    assert {target["proposed"] for target in entry["targets"]} == {True, False}
    assert [part["name"] for part in written["floor"]["parts"] if part["kind"] == "room"] == ["1.01 Hall"]
    names = {station["name"] for station in entry["stations"]}
    for name, broken in (("targets", {"proposed": "perhaps"}), ("rooms", {"hidden": 2}), ("missed", {"voxels": -1}), ("elements", {"captured": 2})):
        holds = validator(os.path.join(SCHEMAS, f"{name}.schema.json"))
        table = rows(os.path.join(folder, "targets", f"{name}.csv"), TEXTS | {"stations"})
        assert table
        for row in table:
            require(holds, row, f"{name}.csv")
            assert set(row.get("stations", "").split()) <= names
        assert not holds.is_valid({**table[0], **broken}) and not holds.is_valid({**table[0], "more": 1})
    assert len(rows(os.path.join(folder, "targets/targets.csv"), TEXTS | {"stations"})) == len(entry["targets"])


def check_sessions(folder, written):
    """Sessions in front.json and sessions.csv are the round, cut."""
    entry = written["front"][written["answer"] - 1]
    sessions, table = entry["on_site"]["sessions"], rows(os.path.join(folder, "days/sessions.csv"), TEXTS | {"begin", "end"})
    assert len(sessions) > 1 and [[s["day"], s["crew"]] for s in sessions[:3]] == [[1, 1], [1, 2], [2, 1]][:len(sessions)]
    assert sum((session["order"] for session in sessions), []) == entry["on_site"]["order"]
    assert [row["station"] for row in table] == entry["on_site"]["order"]
    assert all(session["minutes"] <= 8 for session in sessions)
    holds = validator(os.path.join(SCHEMAS, "sessions.schema.json"))
    for row in table:
        require(holds, row, "sessions.csv")
        assert row["name"] == entry["stations"][row["station"] - 1]["name"]
        assert row["batteries"] == sessions[row["session"] - 1]["batteries"][0]["batteries"]
    assert sum(session["batteries"][0]["batteries"] for session in sessions) == entry["on_site"]["batteries"][0]["batteries"]
    assert not holds.is_valid({**table[0], "day": 0}) and not holds.is_valid({**table[0], "more": 1})


def check_files(folder):
    front, stations, after, waypoints = (validator(os.path.join(SCHEMAS, f"{name}.schema.json")) for name in ("front", "stations", "next", "waypoints"))
    config = validator(os.path.join(MANUAL, "schemas/config.schema.json"))
    run(folder, "generate", "four-walls", "-o", "empty.glb")
    add_room(folder, "empty.glb", "walls.glb")
    with open(os.path.join(folder, "have.csv"), "w", encoding="utf-8") as file:
        file.write(TARGETS)
    for name, how in PLANS.items():
        # Targets are measured with steps as fine as a scanner's.
        run(folder, "plan", "walls.glb", *(QUICK if name == "targets" else COARSE), "--no-report", *how, "-o", name, expected=(0, 3))
        with open(os.path.join(folder, name, "front.json"), encoding="utf-8") as file:
            written = json.load(file)
        require(front, written, f"{name}/front.json")
        with open(os.path.join(folder, name, "config.json"), encoding="utf-8") as file:
            require(config, json.load(file), f"{name}/config.json")
        table = rows(os.path.join(folder, name, "stations.csv"))
        assert len(table) == len(written["front"][written["answer"] - 1]["stations"])
        for row in table:
            require(stations, row, f"{name}/stations.csv")
        # A schema must refuse some documents.
        for broken in ({**written, "more": 1}, {**written, "front": []}, {k: v for k, v in written.items() if k != "seed"}):
            assert not front.is_valid(broken)
        with open(os.path.join(folder, name, "waypoints.json"), encoding="utf-8") as file:
            require(waypoints, json.load(file), f"{name}/waypoints.json")
        if name == "targets":
            check_tables(folder, written)
        if name == "days":
            check_sessions(folder, written)
    run(folder, "scan", "walls.glb", *COARSE, "--station", "8,0,1.5", "-o", "day.e57")
    run(folder, "next", "walls.glb", *COARSE, "--scans", "day.e57", "--stations", "survey/front.json", "--link", "0", expected=(0, 3))
    with open(os.path.join(folder, "next/next.json"), encoding="utf-8") as file:
        written = json.load(file)
    require(after, written, "next.json")
    for row in rows(os.path.join(folder, "next/stations.csv")):
        require(stations, row, "next/stations.csv")
    assert not after.is_valid({**written, "taken": []}) and not after.is_valid({**written, "more": 1})
    assert not config.is_valid({"user-sise": 0.1})
    assert not stations.is_valid({**table[0], "status": "perhaps"})


def check_json(folder):
    """What commands print with --json."""
    with open(os.path.join(folder, "wall.obj"), "w", encoding="utf-8") as file:
        file.write("v 0 0 0\nv 4 0 0\nv 4 0 3\nv 0 0 3\nf 1 2 3 4\n")
    station = ["walls.glb", *COARSE, "--station", "8,0,1.5"]
    printed = {
        "info": [["info"], ["info", "--measure", "walls.glb"]],
        "import": [["import", "wall.obj", "-o", "wall.glb"]],
        "scan": [["scan", *station], ["scan", *station, "--returns", "all", "--beam", "0.3,6", "-o", "scan.ply"],
                 ["scan", *station, "--calibration", "18,1,10", "--instrument-errors", "1"]],
        "evaluate": [["evaluate", *station, "--day", "4h"], ["evaluate", *station, "--station", "-8,0,1.5", "--registration", "--attainable", "--sample", "200"]],
        "bound": [["bound", "walls.glb", *COARSE, "--stations", "1", "--capture", "0.5", "--candidates", "8", "--sample", "100"]],
    }
    for name, commands in printed.items():
        holds = validator(os.path.join(SCHEMAS, f"{name}.schema.json"))
        for command in commands:
            written = json.loads(run(folder, *command, "--json"))
            require(holds, written, " ".join(command))
            assert not holds.is_valid({key: value for key, value in written.items() if key != next(iter(holds.schema["required"]))})


def check_manual(folder):
    commands = re.findall(r"^  ([a-z]+) {2,}\S", run(folder, "--help").split("Subcommands:")[1], re.M)
    assert len(commands) > 5
    with open(os.path.join(MANUAL, "bash/vantage"), encoding="utf-8") as file:
        bash = file.read()
    with open(os.path.join(MANUAL, "zsh/_vantage"), encoding="utf-8") as file:
        zsh = file.read()
    for command in commands:
        options = set(re.findall(r"(?<!\S)(--[a-z][a-z0-9-]*)", "\n".join(
            re.findall(r"^  ((?:-\w,)?--\S+)", run(folder, command, "--help-all").replace(",--", ", --"), re.M))))
        options |= set(re.findall(r"^  -\w,(--[a-z0-9-]+)", run(folder, command, "--help-all"), re.M))
        assert "--help" in options, options
        with gzip.open(os.path.join(MANUAL, f"man1/vantage-{command}.1.gz"), "rt", encoding="utf-8") as file:
            page = file.read()
        for option in options:
            assert r"\fB" + option.replace("-", r"\-") + r"\fR" in page, f"vantage-{command}(1) lacks {option}"
        assert set(re.search(rf"^    {command}\) options='([^']*)'", bash, re.M)[1].split()) >= options
        assert all(f"){option}[" in zsh or f"*{option}[" in zsh for option in options)
    # A shell takes it, and completes by it.
    done = subprocess.run(["bash", "-c", bash + 'COMP_WORDS=(vantage plan --capt) COMP_CWORD=2; _vantage 2>/dev/null; echo "${COMPREPLY[@]}"'],
                          capture_output=True, text=True)
    assert done.stdout == "--capture\n", (done.stdout, done.stderr)
    for option, begun, whole in (("engine", "emb", "embree"), ("scanner", "rtc", "rtc360"), ("problem", "sur", "survey"), ("objectives", "covera", "coverage")):
        done = subprocess.run(["bash", "-c", bash + f'COMP_WORDS=(vantage plan --{option} {begun}) COMP_CWORD=3; _vantage 2>/dev/null; echo "${{COMPREPLY[@]}}"'],
                              capture_output=True, text=True)
        assert whole in done.stdout.split(), (option, done.stdout, done.stderr)


def main():
    with tempfile.TemporaryDirectory() as folder:
        check_files(folder)
        check_json(folder)
        check_manual(folder)


main()
