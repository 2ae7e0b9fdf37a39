#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# tests/sanitizers/instrumented_tbb.sh FOLDER
# Builds oneTBB with ThreadSanitizer in it, from the source of the installed Debian package, to FOLDER/lib. Without it every
# hand-over of a task looks like a race. The system's package sources are left as they are.
set -eu
mkdir -p "$1"
cd "$1"
[ -e lib ] && exit 0
version=$(dpkg-query -W -f '${source:Version}' libtbb12)
. /etc/os-release
mirror=$(apt-get indextargets --format '$(REPO_URI)' 'Created-By: Packages' "Codename: $VERSION_CODENAME" | head -n 1)
mkdir -p lists/partial
echo "deb-src [signed-by=/usr/share/keyrings/debian-archive-keyring.gpg] $mirror $VERSION_CODENAME main" >sources.list
set -- -o "Dir::Etc::SourceList=$PWD/sources.list" -o Dir::Etc::SourceParts=/dev/null -o "Dir::State::Lists=$PWD/lists" -o APT::Sandbox::User=
apt-get "$@" -qq update
apt-get "$@" -qq source --download-only "onetbb=$version"
rm -rf source
mkdir source
tar -C source --strip-components=1 -xf onetbb_*.orig.tar.*
cmake -G Ninja -S source -B build -DCMAKE_BUILD_TYPE=RelWithDebInfo -DTBB_TEST=OFF -DTBBMALLOC_BUILD=OFF -DTBB_STRICT=OFF \
      -DTBB_SANITIZE=thread -DCMAKE_CXX_FLAGS=-Wno-tsan >/dev/null
cmake --build build --target tbb
mkdir lib
cp -P build/*/libtbb.so* lib
