// SPDX-License-Identifier: Apache-2.0
// Stations against what they capture, from the steps of a choice.
#pragma once

#include <stop_token>
#include <vector>

#include "plan/fewest_choice.hpp"

namespace vantage {

// Returns the best network found for each of several numbers of stations, by rising number. From the chosen number down
// it drops the station with the least loss; up to a few more it adds linked ones; swaps improve each until `unimproved`
// is requested. A stopped call returns what it has.
std::vector<CoverSolution> trade_off_networks(const FewestChoice& choice, const std::stop_token& unimproved,
                                              const std::stop_token& stop);

// Drops stations that only links need and that do not pay. `pays`: the stations that pay without links. Stations beyond
// their number go if they clearly capture less than `pays.least_m2` each. Lowers the required capture to that of the
// rest, but not below `asked_capture`. Returns true if it dropped any.
bool keep_what_pays(FewestChoice& choice, const StationsThatPay& pays, double asked_capture,
                    const std::stop_token& stop);

// Adds linked stations, with swaps for coverage after each, as long as a further one captures `pays.least_m2`. Swaps
// may capture the same with fewer stations than a greedy choice, and leave more to gain. Raises the required capture to
// that of all. Returns true if it added any.
bool add_what_pays(FewestChoice& choice, const StationsThatPay& pays, const std::stop_token& stop);

// Numbers of stations in a trade-off, around the chosen one: all if they are few, else some evenly spread.
std::vector<std::size_t> trade_off_numbers(std::size_t chosen, std::size_t most);

// Marks the knee: the point farthest above the line from the first to the last, both scaled to 1 (Satopaa, Albrecht,
// Irwin, Raghavan: Finding a "Kneedle" in a Haystack, 2011).
void mark_knee(std::vector<TradeOffPoint>& points);

}  // namespace vantage
