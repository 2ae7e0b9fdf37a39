// SPDX-License-Identifier: Apache-2.0
// Sites on which the right place is hard to find: terrain high above its lowest point or on a slope, gates, glass
// doors, gratings, ladders, single sheets, vaults and decks for cars.
#pragma once

#include <functional>
#include <string>

#include "sites/random_site.hpp"

namespace vantage::test {

// Draws for a site, and names in its language.
struct Draws {
  std::function<double(double low, double high)> uniform;
  std::function<std::string(const char* english)> name;
};

// Adds one of the kinds to an empty site.
void make_strange(RandomSite& made, std::size_t kind, const Draws& draw);
inline constexpr std::size_t kStrangeKinds = 9;

}  // namespace vantage::test
