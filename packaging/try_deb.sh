#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# packaging/try_deb.sh [FOLDER]
# Installs the packages of FOLDER, or build/packages, where nothing else is: in a root of its own, made from this machine's mirror of Debian.
# There the program plans, and the module scans. Needs root, a mirror, and mmdebstrap or debootstrap.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
folder=${1:-build/packages}
me=try_deb
. packaging/root.sh
for package in vantage libvantage-dev python3-vantage; do
  ls "$folder/${package}"_*.deb >/dev/null || { say "there is no package $package in $folder: run packaging/deb.sh"; exit 1; }
done
make_root
cp "$folder"/*.deb data/industrial_20k.glb "$root/tmp"

cp packaging/install_debs.sh "$root/tmp"
inside /tmp/install_debs.sh /tmp
inside vantage info
inside vantage plan /tmp/industrial_20k.glb --stations 4 --problem coverage-overlap-fix --population 8 --iterations 3 --step 1 --user-size 0.2 --spacing 0.1 -o /tmp/plan
for file in stations.csv front.json report.html report.pdf; do
  [ -s "$root/tmp/plan/$file" ] || { say "the plan has no $file"; exit 1; }
done
for page in vantage vantage-plan; do inside test -s "/usr/share/man/man1/$page.1.gz"; done
inside bash -ec '. /usr/share/bash-completion/completions/vantage
  COMP_WORDS=(vantage plan --cheap) COMP_CWORD=2
  complete -p vantage >/dev/null'

inside python3 -c '
import vantage
site = vantage.Site.open("/tmp/industrial_20k.glb")
print("vantage", vantage.__version__, site)'

inside apt-get update -qq
inside sh -ec 'cd /tmp && apt-get install -qq --simulate --no-install-recommends ./libvantage-dev_*.deb >/dev/null'
inside sh -ec 'apt-get purge -qq -o Dpkg::Use-Pty=0 vantage >/dev/null && ! command -v vantage'
say "installed, planned, removed"
