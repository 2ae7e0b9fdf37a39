// SPDX-License-Identifier: Apache-2.0
// The seam between search and simulation.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

#include "vantage/objective.hpp"
#include "vantage/progress.hpp"
#include "vantage/simulator.hpp"

namespace vantage {

// What the search needs to know of a network.
struct NetworkValue {
  double coverage = 0, overlap = 0;
  std::size_t parts = 1;  // connected parts of its links
};

struct NetworkEstimate {
  Estimate coverage, overlap;
};

struct ConfirmedNetwork {
  double coverage = 0, overlap = 0;
  OverlapMatrix overlaps = {};
  std::vector<std::uint64_t> points_on_surveyed = {};
};

class NetworkEvaluator {
 public:
  virtual ~NetworkEvaluator() = default;
  // How many networks evaluate() takes best at once; 0: as many as there are.
  virtual std::size_t chunk() const = 0;
  // Values in order; empty when stopped half way. REQUIRES: each network has an active station.
  virtual std::optional<std::vector<NetworkValue>> evaluate(std::span<const Network> networks,
                                                            const Progress& progress) = 0;
  // The same with overlap always and standard errors, for the few networks of a front.
  virtual std::optional<std::vector<NetworkEstimate>> estimate(std::span<const Network> networks,
                                                               const Progress& progress) = 0;
  // With every ray; empty when stopped.
  virtual std::optional<ConfirmedNetwork> confirm(const Network& network, const Progress& progress) = 0;
  virtual double trace_seconds() const = 0;
};

// Spares the evaluator what needs no simulation: networks without an active station, and networks met before.
class CachingEvaluator {
 public:
  explicit CachingEvaluator(NetworkEvaluator& evaluator) : evaluator_(evaluator) {}
  std::size_t chunk() const { return evaluator_.chunk(); }
  std::optional<std::vector<NetworkValue>> evaluate(std::span<const Network> networks, const Progress& progress);
  std::uint64_t simulated() const { return simulated_; }

 private:
  NetworkEvaluator& evaluator_;
  std::unordered_map<std::string, NetworkValue> known_;
  std::uint64_t simulated_ = 0;
};

}  // namespace vantage
