// SPDX-License-Identifier: Apache-2.0
#include "map/shown_links.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace vantage {
namespace {

// Every pair, the stronger the nearer their numbers.
std::vector<ShownLink> all_pairs(std::size_t stations) {
  std::vector<ShownLink> links;
  for (std::size_t a = 0; a < stations; ++a)
    for (std::size_t b = a + 1; b < stations; ++b)
      links.push_back({a, b, 1 / static_cast<double>(b - a) - 1e-3 * static_cast<double>(a)});
  return links;
}

TEST(ShownLinks, AreAllOfThemWhereTheyAreFew) {
  const auto shown = shown_links(all_pairs(9), 9);  // 36 of 9 stations
  EXPECT_EQ(shown.size(), 36u);
  EXPECT_TRUE(std::ranges::is_sorted(shown, {}, &ShownLink::overlap));
}

TEST(ShownLinks, OfATangleAreTheStrongestTreeAndTwoOfEachStation) {
  const auto shown = shown_links(all_pairs(30), 30);
  EXPECT_TRUE(std::ranges::is_sorted(shown, {}, &ShownLink::overlap));
  // Neighbours are the tree, and the two strongest of all but the two at the ends, whose second is two further.
  EXPECT_EQ(shown.size(), 31u);
  for (std::size_t k = 0; k + 1 < 30; ++k)
    EXPECT_TRUE(std::ranges::any_of(shown, [&](const ShownLink& l) { return l.a == k && l.b == k + 1; })) << k;
}

TEST(ShownLinks, KeepAWeakLinkThatHoldsPartsTogether) {
  std::vector<ShownLink> links = all_pairs(12);
  for (ShownLink link : all_pairs(12)) links.push_back({link.a + 12, link.b + 12, link.overlap});
  links.push_back({3, 20, 1e-6, true});
  const auto shown = shown_links(links, 24);
  EXPECT_LT(shown.size(), 40u);
  EXPECT_EQ(shown.front().overlap, 1e-6);
  EXPECT_TRUE(shown.front().bridge);
}

}  // namespace
}  // namespace vantage
