#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# packaging/try_wheel.sh [FOLDER]
# Installs the wheel of FOLDER, or build/wheel, where nothing else is: in a root of its own with Python, pip and NumPy, and none of the
# libraries. There the module plans, reads a foreign format, and writes files. Needs root, a mirror, and mmdebstrap or debootstrap.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
folder=${1:-build/wheel}
me=try_wheel
. packaging/root.sh
ls "$folder"/vantage-*.whl >/dev/null || { say "there is no wheel in $folder: run packaging/wheel.sh"; exit 1; }
make_root python3 python3-pip python3-numpy
cp "$folder"/vantage-*.whl data/industrial_20k.glb "$root/tmp"
inside sh -ec 'python3 -m pip install --quiet --no-index --break-system-packages --root-user-action=ignore /tmp/vantage-*.whl'
cat >"$root/tmp/floor.obj" <<'OBJ'
o floor
v 0 0 0
v 8 0 0
v 8 6 0
v 0 6 0
f 1 2 3 4
OBJ
inside python3 -c '
from importlib import metadata
import vantage
assert vantage.__version__ == metadata.version("vantage")
assert any(each.startswith("matplotlib") and "plot" in each.split(";")[1] for each in metadata.requires("vantage") if ";" in each), "no extra plot"
site = vantage.Site.open("/tmp/industrial_20k.glb", engine="embree", step=1, user_size=0.2, spacing=0.1, crs="EPSG:25832")
plan = site.plan(problem="coverage-overlap-fix", stations=4, population=8, iterations=3)
plan.write("/tmp/plan")
assert len(site.simulator.scan((10, 6, 2)).position) > 1000
floor = vantage.Scene.load("/tmp/floor.obj", unit="m", up="z")
assert floor.triangle_count == 2, floor
print("vantage", vantage.__version__, site, floor)'
for file in front.json stations.csv stations.dxf plan.png; do
  [ -s "$root/tmp/plan/$file" ] || { say "the plan has no $file"; exit 1; }
done
say "installed, planned, imported"
