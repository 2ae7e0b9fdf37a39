#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# packaging/try_deb.sh [FOLDER]
# Installs the packages of FOLDER, or build/packages, where nothing else is: in a root of its own, made from this machine's mirror of Debian.
# There the program plans, and the module scans. Needs root, a mirror, and mmdebstrap or debootstrap.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
folder=${1:-build/packages}
say() { printf 'try_deb: %s\n' "$*" >&2; }
for package in vantage libvantage-dev python3-vantage; do
  ls "$folder/${package}"_*.deb >/dev/null || { say "there is no package $package in $folder: run packaging/deb.sh"; exit 1; }
done
if [ "$(id -u)" -ne 0 ]; then say "needs root: not tried"; exit 77; fi
. /etc/os-release
mirror=$(apt-get indextargets --format '$(REPO_URI)' 'Created-By: Packages' "Codename: $VERSION_CODENAME" | head -n 1)
[ -n "$mirror" ] || { say "apt has no mirror of $VERSION_CODENAME: not tried"; exit 77; }
root=$(mktemp -d)
trap 'rm -rf "$root"' EXIT
chmod 755 "$root"
if command -v mmdebstrap >/dev/null; then
  mmdebstrap --quiet --variant=apt "$VERSION_CODENAME" "$root" "$mirror"
elif command -v debootstrap >/dev/null; then
  debootstrap --variant=minbase "$VERSION_CODENAME" "$root" "$mirror" >/dev/null
else
  say "neither mmdebstrap nor debootstrap is installed: not tried"
  exit 77
fi
cp "$folder"/*.deb data/industrial_20k.glb "$root/tmp"
cp /etc/resolv.conf "$root/etc/resolv.conf"
for proxy in http_proxy https_proxy; do [ -z "${!proxy-}" ] || export "${proxy?}"; done
inside() { chroot "$root" env DEBIAN_FRONTEND=noninteractive LC_ALL=C.UTF-8 HOME=/tmp "$@"; }
inside apt-get update -qq

inside sh -ec 'cd /tmp && apt-get install -qq -o Dpkg::Use-Pty=0 --no-install-recommends ./vantage_*.deb >/dev/null'
inside vantage info
inside vantage plan /tmp/industrial_20k.glb --stations 4 --problem coverage-overlap-fix --population 8 --iterations 3 --step 1 --user-size 0.2 --spacing 0.1 -o /tmp/plan
for file in stations.csv front.json report.html report.pdf; do
  [ -s "$root/tmp/plan/$file" ] || { say "the plan has no $file"; exit 1; }
done
for page in vantage vantage-plan; do inside test -s "/usr/share/man/man1/$page.1.gz"; done
inside bash -ec '. /usr/share/bash-completion/completions/vantage
  COMP_WORDS=(vantage plan --cheap) COMP_CWORD=2
  complete -p vantage >/dev/null'

inside sh -ec 'cd /tmp && apt-get install -qq -o Dpkg::Use-Pty=0 --no-install-recommends ./python3-vantage_*.deb >/dev/null'
inside python3 -c '
import vantage
site = vantage.Site.open("/tmp/industrial_20k.glb")
print("vantage", vantage.__version__, site)'

inside sh -ec 'cd /tmp && apt-get install -qq --simulate --no-install-recommends ./libvantage-dev_*.deb >/dev/null'
inside sh -ec 'apt-get purge -qq -o Dpkg::Use-Pty=0 vantage >/dev/null && ! command -v vantage'
say "installed, planned, removed"
