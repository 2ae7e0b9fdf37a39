// SPDX-License-Identifier: Apache-2.0
// What a search needs to go on after its process has ended: its last snapshot, the values of all networks since, and
// the time it has taken. Kept in memory, and in a checkpoint where one is asked for.
#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "plan/checkpoint.hpp"

namespace vantage {

class SearchLog {
 public:
  using Values = std::vector<std::vector<double>>;
  using Warn = std::function<void(const std::string&)>;

  // Borrows the configuration. `warn`: as `SearchSetup::warn`.
  SearchLog(const PlanConfig& config, std::string identity, Warn warn);

  // What the checkpoint holds where `config` asks to go on from one; empty: the search begins. Throws Error: io,
  // malformed_file, invalid_argument (of another run).
  std::optional<SearchSnapshot> resume();
  // Values that the checkpoint brought are replayed: told again in place of evaluations, in the order of asking.
  bool replaying() const { return replayed_ < replay_.size(); }
  Values replay(std::size_t most);
  void add(const Values& values);

  // REQUIRES: no batch is open.
  void take(SearchSnapshot snapshot);
  bool has_file() const { return !config_.checkpoint.empty(); }
  bool due() const;
  // Nothing without a file. Throws Error io where nobody is warned.
  void save(double trace_seconds);

  // Of this run and those before it.
  double seconds() const;
  double trace_seconds(double of_this_run) const { return earlier_trace_seconds_ + of_this_run; }

 private:
  using Clock = std::chrono::steady_clock;

  const PlanConfig& config_;
  std::string identity_;
  Warn warn_;
  SearchSnapshot snapshot_;
  Values since_, replay_;
  std::size_t replayed_ = 0;
  double earlier_seconds_ = 0, earlier_trace_seconds_ = 0;
  bool newest_is_ours_ = false;  // and whole, so that it may become the one before
  Clock::time_point start_ = Clock::now(), saved_ = start_;
};

}  // namespace vantage
