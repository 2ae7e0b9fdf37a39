#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Doxygen 1.9.4 (Debian 12): whose is a comment of a statement that declares several members, `double a, b;`?
# Guess before it was run: it is of all of them, as it is to a reader.
# Seen: a comment before the statement is the first member's alone, one behind it the last member's alone; the
# others count as not documented.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
apt-get download -qq doxygen=1.9.4-4 libclang1-14 libllvm14 libclang-cpp14 libxapian30 >/dev/null
for package in *.deb; do dpkg-deb -x "$package" .; done
export LD_LIBRARY_PATH="$PWD/usr/lib/x86_64-linux-gnu:$PWD/usr/lib/llvm-14/lib"
cat >point.hpp <<'HEADER'
/// A point.
struct Point {
  /// Before.
  double a, b, c;
  double d, e, f;  ///< Behind.
};
HEADER
printf 'INPUT=point.hpp\nGENERATE_HTML=NO\nGENERATE_LATEX=NO\nGENERATE_XML=YES\nQUIET=YES\n' >Doxyfile
missing=$(usr/bin/doxygen 2>&1 | sed -n 's/.*Member \([a-f]\) (variable).*is not documented.*/\1/p' | sort | tr -d '\n')
echo "doxygen $(usr/bin/doxygen --version): not documented: ${missing:-none} of a to f"
[ "$missing" = bcde ]
