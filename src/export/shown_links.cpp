// SPDX-License-Identifier: Apache-2.0
#include "export/shown_links.hpp"

#include <algorithm>
#include <numeric>

namespace vantage {
namespace {

constexpr std::size_t kTangle = 4, kStrongest = 2;  // links for each station

}  // namespace

std::vector<ShownLink> shown_links(std::vector<ShownLink> links, std::size_t stations) {
  std::ranges::stable_sort(links, {}, &ShownLink::overlap);
  if (links.size() <= kTangle * stations) return links;
  std::vector<std::size_t> part(stations), drawn(stations, 0);
  std::iota(part.begin(), part.end(), std::size_t{0});
  const auto part_of = [&](std::size_t k) {
    while (part[k] != k) k = part[k] = part[part[k]];
    return k;
  };
  // Kruskal's algorithm: from the strongest on.
  std::vector<ShownLink> shown;
  for (auto link = links.rbegin(); link != links.rend(); ++link) {
    const std::size_t a = part_of(link->a), b = part_of(link->b);
    const bool strong = drawn[link->a]++ < kStrongest, strong_too = drawn[link->b]++ < kStrongest;
    if (a != b) part[a] = b;
    if (a != b || strong || strong_too) shown.push_back(*link);
  }
  std::ranges::reverse(shown);
  return shown;
}

}  // namespace vantage
