#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# tests/packages/program.sh BUILD CPACK
# Makes the package of the program from a build that is there, and tries it (packaging/try_deb.sh).
set -eu
build=$1 cpack=$2
here=$(cd "$(dirname "$0")/../.." && pwd)
folder=$build/tests/packages/debs
rm -rf "$folder"
mkdir -p "$folder"
cd "$folder"
"$cpack" -G DEB --config "$build/CPackConfig.cmake" -B "$folder" -D CPACK_COMPONENTS_ALL=program -D CPACK_DEBIAN_COMPRESSION_TYPE=gzip
exec "$here/packaging/try_deb.sh" "$folder" program
