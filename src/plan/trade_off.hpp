// SPDX-License-Identifier: Apache-2.0
// Stations against what they capture, from the steps of a choice.
#pragma once

#include <stop_token>
#include <vector>

#include "plan/fewest_choice.hpp"

namespace vantage {

// The best network found of each of some numbers of stations, from one to a few beyond the chosen, by rising number:
// from the chosen one down, always without the station that is missed least, and up along links; swaps improve each,
// until `unimproved` is requested. A stopped call returns what it has.
std::vector<CoverSolution> trade_off_networks(const FewestChoice& choice, const std::stop_token& unimproved,
                                              const std::stop_token& stop);

// Leaves stations out that links need and that do not pay. `pays`: the stations that do by themselves; of those beyond
// that number those go that clearly capture less than `pays.least_m2` each. Asks for no more than the rest captures
// then, and at least for `asked_capture`. True if that leaves some out.
bool keep_what_pays(FewestChoice& choice, const StationsThatPay& pays, double asked_capture,
                    const std::stop_token& stop);

// Adds linked stations as long as a further one captures `pays.least_m2`, with swaps for coverage after each: fewer
// stations than a greedy choice takes may capture the same and leave more. Asks for what all of them capture then. True
// if there was one to add.
bool add_what_pays(FewestChoice& choice, const StationsThatPay& pays, const std::stop_token& stop);

// Numbers of stations to tell a trade-off by, around the chosen one: all of few, else so many evenly spread.
std::vector<std::size_t> trade_off_numbers(std::size_t chosen, std::size_t most);

// Marks the knee: the point farthest above the line from the first to the last, both scaled to 1 (Satopaa, Albrecht,
// Irwin, Raghavan: Finding a "Kneedle" in a Haystack, 2011).
void mark_knee(std::vector<TradeOffPoint>& points);

}  // namespace vantage
