// SPDX-License-Identifier: Apache-2.0
// Tracers that do one piece of work together, each on a thread of its own. One that fails is dropped, and the others do
// its piece again.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "trace/spread/pieces.hpp"
#include "trace/spread/rate.hpp"
#include "trace/tracer.hpp"

namespace vantage {

// What a kind of work has shown of how fast each member is; it sizes pieces, never results.
struct TeamRates {
  std::vector<Rate> of_members = {};
  std::vector<double> shares = {};  // of all work, by these rates
  // Of what is left, handed out in one round: all of it where items take alike, so that rates seen hold good.
  double of_rest = Pieces::factored;
};

class Team {
 public:
  using Warn = std::function<void(const std::string&)>;
  // REQUIRES: at least one tracer.
  Team(std::vector<std::unique_ptr<Tracer>> tracers, Warn warn);

  // What a member may ask for on the thread that called work(); it waits for the answer.
  using OnCaller = std::function<void(const std::function<void()>&)>;
  // Does items [first, end) of the work. Whether it came to their end: where not, the work is stopped.
  using Do = std::function<bool(Tracer& tracer, const Piece& piece, const Progress& progress, const OnCaller& ask)>;

  // Has `items` items done, each once, but for those of a member that fails on its way. Returns whether all are done:
  // where not, the caller wanted to stop. Throws what a member throws that is no failure of its device, and the failure
  // of the last.
  bool work(std::size_t items, TeamRates& rates, const Progress& progress, const Do& job);

  std::size_t size() const { return tracers_.size(); }  // with those that were dropped
  std::size_t left() const;
  // Null: dropped.
  Tracer* member(std::size_t k) const { return tracers_[k].get(); }

 private:
  class Shift;
  bool work_alone(std::size_t items, TeamRates& rates, const Progress& progress, const Do& job);
  std::size_t fastest(const TeamRates& rates) const;
  void drop(std::size_t k, const std::string& why);

  std::vector<std::unique_ptr<Tracer>> tracers_;
  std::vector<std::string> names_;
  Warn warn_;
};

}  // namespace vantage
