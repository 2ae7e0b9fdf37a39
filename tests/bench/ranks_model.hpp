// SPDX-License-Identifier: Apache-2.0
// Time that ranks take for a population that they pull in pieces, simulated event by event.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace vantage::bench {

// Inputs of the model, in seconds and bytes; measured, except the network's figures, which are given.
struct RanksModel {
  std::vector<double> network_s;  // evaluation times of single networks, of which those of a population are drawn
  double piece_s = 0;             // what a rank spends on a piece whatever its size
  double search_s = 0;            // a network, on rank 0 between two populations: asked for, told
  double messages_s = 0;          // a network, on rank 0: its messages written and read
  double member_s = 0;            // a rank and population, on rank 0: its thread begun and ended
  double ask_bytes = 0, answer_bytes = 0;  // a network
  double round_trip_s = 0;
  double bytes_a_second = 0;  // in and out of rank 0, each way
};

// Seconds from one population to the next. Ranks are as fast as each other, networks are not.
double seconds_a_population(const RanksModel& model, std::size_t ranks, std::size_t population, std::uint64_t seed);

}  // namespace vantage::bench
