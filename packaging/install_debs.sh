#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# packaging/install_debs.sh FOLDER
# Installs program and module from the packages of FOLDER with what they take, and Vulkan for graphics cards and in software: the second stage
# of the Containerfile, and the steps that try_deb.sh runs in a root of its own.
set -eu
apt-get update -qq
apt-get install -qq -o Dpkg::Use-Pty=0 --no-install-recommends "$1"/vantage_*.deb "$1"/python3-vantage_*.deb libvulkan1 mesa-vulkan-drivers \
  fonts-dejavu-core >/dev/null
rm -rf /var/lib/apt/lists/*
