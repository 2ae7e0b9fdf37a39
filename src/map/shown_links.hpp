// SPDX-License-Identifier: Apache-2.0
// Links of a network that a picture shows: all of them, or the important ones if all would be a tangle.
#pragma once

#include <cstddef>
#include <vector>

#include "vantage/evaluation.hpp"

namespace vantage {

struct ShownLink {
  std::size_t a = 0, b = 0;
  double overlap = 0;
  bool bridge = false;  // the only link between two components
  bool tree = false;    // of the maximum spanning tree of its component
};

// The links of an evaluation that pictures and drawings show; none if they are not known.
StationLinks links_to_draw(const Evaluation& evaluation);
// All links of a network.
std::vector<ShownLink> links_of(const StationLinks& network);

// With more than four links for each linked station, returns the maximum spanning tree of each component, and the two
// strongest links of each station. Sorted by overlap, ascending, so that the strongest are drawn last.
std::vector<ShownLink> shown_links(std::vector<ShownLink> links, std::size_t stations);

}  // namespace vantage
