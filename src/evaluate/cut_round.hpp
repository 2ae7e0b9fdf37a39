// SPDX-License-Identifier: Apache-2.0
// Cuts the order of a round into sessions.
#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <vector>

namespace vantage {

// A round by its stops, in their order.
struct RoundTimes {
  std::vector<double> stay_min;                               // at each stop
  std::vector<double> step_min;                               // walk from each to the next: one less than stops
  std::vector<double> out_min;                                // walk between each and the entrance
  std::function<bool(std::size_t, std::size_t)> linked = {};  // two stops; empty: all are
};

// Consecutive stops from `first` to before `end`.
struct RoundPiece {
  std::size_t first = 0, end = 0;
  double minutes = 0, walk_min = 0;
  std::size_t parts = 1;  // groups of its stops that no link connects
  bool linked = true;     // to a stop outside of it, if there is one
};

// Cuts the whole round into pieces of at most `most_min`: as few as possible, then with the fewest parts, then with the
// fewest unlinked pieces, then with the shortest longest piece, then with the least walking. Empty if some stop alone
// takes longer.
std::vector<RoundPiece> cut_round(const RoundTimes& times, double most_min = std::numeric_limits<double>::infinity());

}  // namespace vantage
