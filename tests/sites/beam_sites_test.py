# SPDX-License-Identifier: Apache-2.0
"""The sites of examples/python/beam_sites.py say what a beam meets there, and it matters:
beam_sites_test.py PROGRAM EXAMPLE"""
import json
import subprocess
import sys
import tempfile
from pathlib import Path

program, example = sys.argv[1:]
SITES = ("glass", "leaves", "leaves-solid", "steel")


def run(*arguments):
    return subprocess.run([str(a) for a in arguments], check=True, capture_output=True, text=True)


def evaluate(scene, head, *more):
    """Captured share, and what was told."""
    done = run(program, "evaluate", scene, "--engine", "embree", "--scanner", "x7", "--step", "0.5", "--user-size", "0.3",
               "--spacing", "0.1", "--no-overlap", "--json", "--station", head, *more)
    return json.loads(done.stdout), done.stderr


with tempfile.TemporaryDirectory() as name:
    folder = Path(name)
    for site in ("office", "street", "plant"):
        run(program, "generate", site, "-o", folder / f"{site}.glb")
    run(sys.executable, "-B", example, folder)
    first = {site: (folder / f"{site}.glb").read_bytes() for site in SITES}
    run(sys.executable, "-B", example, folder)
    for site in SITES:
        assert (folder / f"{site}.glb").read_bytes() == first[site], f"{site}: other bytes"

    clear, told = evaluate(folder / "glass.glb", "9,7.5,1.85")
    opaque, _ = evaluate(folder / "glass.glb", "9,7.5,1.85", "--glass", "opaque", "--detection", "off")
    assert "m² of glass" in told and '"inner_walls", "panes"' in told, told
    assert clear["voxels"] < opaque["voxels"], "panes are not surveyed"
    assert clear["coverage"] > 2 * opaque["coverage"], (clear["coverage"], opaque["coverage"])

    leaves, told = evaluate(folder / "leaves.glb", "16,9,1.97", "--blocking", "tree_*")
    solid, _ = evaluate(folder / "leaves-solid.glb", "16,9,1.97", "--blocking", "tree_*")
    assert "holes of masked textures" in told, told
    assert leaves["coverage"] > solid["coverage"], (leaves["coverage"], solid["coverage"])

    steel, told = evaluate(folder / "steel.glb", "15,10,1.85")
    matt, _ = evaluate(folder / "steel.glb", "15,10,1.85", "--mirror", "none", "--detection", "off")
    assert "are mirrors" in told and '"vessel"' in told, told
    assert steel["dropped"]["echo"] > 100, steel["dropped"]
    assert steel["voxels"] < matt["voxels"], "mirrors are not surveyed"
