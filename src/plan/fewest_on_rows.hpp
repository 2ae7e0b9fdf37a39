// SPDX-License-Identifier: Apache-2.0
// The fewest rows that capture enough and hang together: on arrays alone, so that thousands of networks are judged in
// the time that one takes to be traced.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <stop_token>
#include <vector>

#include "vantage/candidates.hpp"

namespace vantage {

// For each pair of candidates the scan overlap, and whether they may both have a station.
class PairTable {
 public:
  PairTable() = default;
  // Scan overlap from rows over the surroundings, by counts of voxels that both see, 0 where there are no rows;
  // `nearest_m`: what stations have to stand apart.
  PairTable(const CaptureRows& surroundings, std::span<const PlacedStation> stations, double nearest_m);
  // Of numbers, row-major. `near`: whether two may not stand together; empty: all may.
  PairTable(std::size_t size, std::vector<float> overlaps, std::vector<char> near = {});

  std::size_t size() const { return size_; }
  float overlap(std::size_t i, std::size_t j) const { return overlap_[i * size_ + j]; }
  bool too_near(std::size_t i, std::size_t j) const { return !near_.empty() && near_[i * size_ + j] != 0; }

 private:
  std::size_t size_ = 0;
  std::vector<float> overlap_;
  std::vector<char> near_;
};

struct RowQuestion {
  const CaptureRows& rows;
  const PairTable& pairs;
  double coverage = 0;    // equation 8 that is wanted
  double link = 0;        // least scan overlap along some spanning tree; 0: stations need not hang together
  std::size_t fixed = 0;  // the first so many rows are there already
  std::size_t fewest = 1, most = max_stations;  // how many further ones
};

struct RowAnswer {
  std::vector<std::size_t> rows;  // fixed ones first
  double coverage = 0;
  double link = 0;    // weakest link of the strongest spanning tree; 1 for one station
  double missed = 0;  // 0: both requirements are kept
};

// What a network of rows is worth to a question.
RowAnswer judge_rows(const RowQuestion& question, std::vector<std::size_t> rows);

// From `from`, with further rows where it is not enough, or without it from a greedy choice along links: for as long as
// it succeeds one station fewer, by a tabu search over swaps (Glover: Tabu Search, Part I, 1989). Where the
// requirements cannot be kept, the nearest network of at most `most`. `nearly`: the best network of one station fewer,
// which does not do, if one was looked for. Deterministic unless stopped; once stopped it gives what it has, a greedy
// network at least.
RowAnswer fewest_on_rows(const RowQuestion& question, std::stop_token stop = {}, std::optional<RowAnswer> from = {},
                         std::optional<RowAnswer>* nearly = nullptr);

// At the same number of stations: swaps until the requirements are kept, then for as strong a weakest link as they
// allow. Never worse than `from`.
RowAnswer better_on_rows(const RowQuestion& question, RowAnswer from, std::stop_token stop = {});

}  // namespace vantage
