// SPDX-License-Identifier: Apache-2.0
#include "map/shown_links.hpp"

#include <algorithm>

#include "core/disjoint_sets.hpp"
#include "core/first_numbers.hpp"

namespace vantage {
namespace {

constexpr std::size_t kTangle = 4, kStrongest = 2;  // links for each station

}  // namespace

StationLinks links_to_draw(const Evaluation& evaluation) {
  return evaluation.links().value_or(StationLinks{.least = evaluation.link_overlap});
}

std::vector<ShownLink> links_of(const StationLinks& network) {
  std::vector<ShownLink> links;
  const std::size_t stations = network.values.size();
  const auto bridges = connectivity(network.values, network.least).bridges;
  for (std::size_t a = 0; a < stations; ++a)
    for (std::size_t b = a + 1; b < stations; ++b)
      if (const double value = network.values(a, b); value > 0 && value >= network.least)
        links.push_back({a, b, value, std::binary_search(bridges.begin(), bridges.end(), std::pair{a, b})});
  // From the strongest on, as Kruskal does.
  std::vector<std::size_t> order = first_numbers(links.size());
  std::ranges::stable_sort(order, std::ranges::greater{}, [&](std::size_t k) { return links[k].overlap; });
  DisjointSets parts(stations);
  for (const std::size_t k : order) links[k].tree = parts.join(links[k].a, links[k].b);
  return links;
}

std::vector<ShownLink> shown_links(std::vector<ShownLink> links, std::size_t stations) {
  std::ranges::stable_sort(links, {}, &ShownLink::overlap);
  std::vector<std::size_t> drawn(stations, 0);
  for (const ShownLink& link : links) drawn[link.a] = drawn[link.b] = 1;
  const auto linked = static_cast<std::size_t>(std::ranges::count(drawn, std::size_t{1}));
  if (links.size() <= kTangle * linked) return links;
  drawn.assign(stations, 0);
  DisjointSets parts(stations);
  std::vector<ShownLink> shown;
  for (auto link = links.rbegin(); link != links.rend(); ++link) {
    const bool strong = drawn[link->a]++ < kStrongest, strong_too = drawn[link->b]++ < kStrongest;
    if (parts.join(link->a, link->b) || strong || strong_too) shown.push_back(*link);
  }
  std::ranges::reverse(shown);
  return shown;
}

}  // namespace vantage
