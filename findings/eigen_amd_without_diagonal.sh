#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Eigen 3.4.0 (Debian 12), AMDOrdering: the order in which to eliminate a graph, such as stations that share surfaces. The
# graph is the pattern of a symmetric matrix without its diagonal, since no station is tied to itself; does the order
# depend on whether the pattern holds the diagonal?
# Guess before it was run: no. Approximate minimum degree is about neighbours, and Eigen's own code drops the diagonal
# before it starts.
# Seen: it does. A column whose diagonal is not stored counts as dense and is put last; without any diagonal, nothing is
# ordered: the permutation is the identity, without a word. A grid of 30 by 30, numbered by rows, then fills up two and a
# half times as much.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
apt-get download -qq libeigen3-dev=3.4.0-4 >/dev/null
dpkg-deb -x libeigen3-dev*.deb .
cat >order.cpp <<'CODE'
#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>
#include <cstdio>
#include <set>
#include <vector>
int main() {
  constexpr int side = 30, n = side * side;
  for (const bool diagonal : {true, false}) {
    std::vector<Eigen::Triplet<double>> entries;
    for (int k = 0; k < n; ++k) {
      if (diagonal) entries.emplace_back(k, k, 1);
      for (const int other : {k % side + 1 < side ? k + 1 : n, k + side})
        if (other < n) entries.emplace_back(k, other, 1), entries.emplace_back(other, k, 1);
    }
    Eigen::SparseMatrix<double> graph(n, n);
    graph.setFromTriplets(entries.begin(), entries.end());
    Eigen::AMDOrdering<int>::PermutationType order;
    Eigen::AMDOrdering<int>()(graph, order);
    bool identity = true;
    std::vector<int> place(n);
    for (int k = 0; k < n; ++k) identity = identity && order.indices()[k] == k, place[order.indices()[k]] = k;
    std::vector<std::set<int>> below(n);
    for (const auto& entry : entries)
      if (place[entry.row()] > place[entry.col()]) below[place[entry.col()]].insert(place[entry.row()]);
    std::size_t filled = 0;
    for (const auto& rows : below) {
      filled += rows.size();
      if (!rows.empty()) below[*rows.begin()].insert(std::next(rows.begin()), rows.end());
    }
    std::printf("diagonal stored: %s, order is the identity: %s, entries below the diagonal of the factor: %zu\n",
                diagonal ? "yes" : "no", identity ? "yes" : "no", filled);
  }
}
CODE
g++ -O1 -std=c++17 -isystem usr/include/eigen3 order.cpp -o order
told=$(./order)
echo "Eigen 3.4.0-4:"
echo "$told"
with=$(sed -n 's/^diagonal stored: yes, order is the identity: no, .*: //p' <<<"$told")
without=$(sed -n 's/^diagonal stored: no, order is the identity: yes, .*: //p' <<<"$told")
[ -n "$with" ] && [ -n "$without" ] && [ $((without)) -gt $((2 * with)) ]
