// SPDX-License-Identifier: Apache-2.0
// Which links of a network a picture shows: all of them, or where that would be a tangle those that matter.
#pragma once

#include <cstddef>
#include <vector>

namespace vantage {

struct ShownLink {
  std::size_t a = 0, b = 0;
  double overlap = 0;
  bool bridge = false;  // the only link of two parts
};

// Of more than four links a station: the strongest spanning tree of each part, and the two strongest of each station.
// By overlap, ascending, so that the strongest are drawn last.
std::vector<ShownLink> shown_links(std::vector<ShownLink> links, std::size_t stations);

}  // namespace vantage
