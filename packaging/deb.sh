#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# packaging/deb.sh [FOLDER]
# Builds the Debian packages vantage, libvantage-dev and python3-vantage for this release of Debian, in FOLDER, or build/packages: from a
# clean clone, after which `apt install ./build/packages/vantage_*.deb` installs the program. Who is asked about them is DEBFULLNAME and
# DEBEMAIL, as for Debian's own tools; git's user otherwise.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
folder=${1:-build/packages}
./setup.sh --packages
[ -d src/import/ifc/node_modules ] || ./setup.sh --ifc
[ -d src/import/laz/node_modules ] || ./setup.sh --laz
name=${DEBFULLNAME:-$(git config user.name || echo vantage)}
email=${DEBEMAIL:-$(git config user.email || echo root@localhost)}
cmake --preset release -B "$folder" -DCMAKE_INSTALL_PREFIX=/usr -DCPACK_PACKAGE_CONTACT="$name <$email>" \
  -DCMAKE_UNITY_BUILD=ON -DCMAKE_UNITY_BUILD_BATCH_SIZE=12 -DVANTAGE_BUILD_TESTS=OFF -DVANTAGE_BUILD_EXAMPLES=OFF \
  -DVANTAGE_PYTHON=ON -DVANTAGE_PYTHON_FOLDER=lib/python3/dist-packages -DPython_EXECUTABLE=/usr/bin/python3 >/dev/null
cmake --build "$folder"
rm -f "$folder"/*.deb
(cd "$folder" && cpack -G DEB)
