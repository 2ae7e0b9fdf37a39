#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# packaging/wheel.sh [FOLDER]
# Builds a wheel of the Python module that carries its libraries and importers, in FOLDER, or build/wheel: from a clean clone, after which
# `pip install build/wheel/vantage-*.whl` needs none of the -dev packages. It is for the Python of this machine's /usr/bin/python3, or
# $PYTHON, and for Linux with this machine's C library or a newer one.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
folder=${1:-build/wheel}
python=${PYTHON:-/usr/bin/python3}
./setup.sh --packages
[ -d src/import/ifc/node_modules ] || ./setup.sh --ifc
[ -d src/import/laz/node_modules ] || ./setup.sh --laz
plain=$(mktemp -d)
trap 'rm -rf "$plain"' EXIT
"$python" -m pip wheel . --quiet --no-deps --no-build-isolation --wheel-dir "$plain"
mkdir -p "$folder"
rm -f "$folder"/vantage-*.whl
"$python" packaging/carry_libraries.py "$plain"/vantage-*.whl "$folder"
