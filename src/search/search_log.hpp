// SPDX-License-Identifier: Apache-2.0
// Data with which a search continues after its process has ended: last snapshot, values of all networks since, and
// elapsed time. Kept in memory and, if requested, in a checkpoint.
#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "search/checkpoint.hpp"

namespace vantage {

class SearchLog {
 public:
  using Values = std::vector<std::vector<double>>;
  using Warn = std::function<void(const std::string&)>;

  // Borrows the configuration. `warn`: as `SearchSetup::warn`.
  SearchLog(const PlanConfig& config, std::string identity, Warn warn);

  // Content of the checkpoint if `config` asks to resume; empty: the search begins. Throws Error: io, malformed_file,
  // invalid_argument (of another run).
  std::optional<SearchSnapshot> resume();
  // Values of the checkpoint are replayed: given again in place of evaluations, in the order of asking.
  bool replaying() const { return replayed_ < replay_.size(); }
  Values replay(std::size_t most);
  void add(const Values& values);

  // REQUIRES: no batch is open.
  void take(SearchSnapshot snapshot);
  bool has_file() const { return !config_.checkpoint.empty(); }
  bool due() const;
  // Does nothing without a file. Throws Error io if there is no one to warn.
  void save(double trace_seconds);

  // Seconds of this run and those before it.
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
  bool newest_is_ours_ = false;  // and whole, so it may become the one before
  Clock::time_point start_ = Clock::now(), saved_ = start_;
};

}  // namespace vantage
