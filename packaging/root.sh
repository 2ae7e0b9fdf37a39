# SPDX-License-Identifier: Apache-2.0
# To be sourced: makes $root, a Debian of its own from this machine's mirror, with the packages given, and `inside`, which runs a command
# there. Ends with exit code 77 where that needs more than this machine has. Its caller sets `me`, the name in messages.
say() { printf '%s: %s\n' "$me" "$*" >&2; }
inside() { chroot "$root" env DEBIAN_FRONTEND=noninteractive LC_ALL=C.UTF-8 HOME=/tmp "$@"; }
make_root() {
  if [ "$(id -u)" -ne 0 ]; then say "needs root: not tried"; exit 77; fi
  . /etc/os-release
  local mirror
  mirror=$(apt-get indextargets --format '$(REPO_URI)' 'Created-By: Packages' "Codename: $VERSION_CODENAME" | head -n 1)
  [ -n "$mirror" ] || { say "apt has no mirror of $VERSION_CODENAME: not tried"; exit 77; }
  root=$(mktemp -d)
  trap 'umount -q "$root/proc" || true; rm -rf --one-file-system "$root"' EXIT
  chmod 755 "$root"
  if command -v mmdebstrap >/dev/null; then
    mmdebstrap --quiet --variant=apt "$VERSION_CODENAME" "$root" "$mirror"
  elif command -v debootstrap >/dev/null; then
    debootstrap --variant=minbase "$VERSION_CODENAME" "$root" "$mirror" >/dev/null
  else
    say "neither mmdebstrap nor debootstrap is installed: not tried"
    exit 77
  fi
  # Programs find the libraries beside them by /proc.
  mount -t proc proc "$root/proc" || { say "/proc cannot be mounted in a root: not tried"; exit 77; }
  cp /etc/resolv.conf "$root/etc/resolv.conf"
  for proxy in http_proxy https_proxy; do [ -z "${!proxy-}" ] || export "${proxy?}"; done
  inside apt-get update -qq
  [ $# -eq 0 ] || inside apt-get install -qq -o Dpkg::Use-Pty=0 --no-install-recommends "$@" >/dev/null
}
