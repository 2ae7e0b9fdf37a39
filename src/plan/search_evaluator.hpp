// SPDX-License-Identifier: Apache-2.0
// What the search loop knows of evaluation: values of the networks that it proposes, and now and then better ones of
// those that its archive holds. Exact, by one sample of voxels, or by a sample that is redrawn.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "plan/network_evaluator.hpp"
#include "vantage/planner.hpp"

namespace vantage {

// Of the searched measures, a row for each network.
using SearchValues = std::vector<std::vector<double>>;
using SearchEstimates = std::vector<std::vector<Estimate>>;

// The networks that the optimiser keeps.
struct SearchArchive {
  std::vector<ParetoPoint> points;
  std::vector<PlacedNetwork> networks;  // of the points, in their order
};

// Evaluates the archive again, with samples that did not choose it.
class ArchiveEvaluator {
 public:
  virtual ~ArchiveEvaluator() = default;
  // Told the archive as each iteration leaves it. Whether re_evaluate() is due.
  virtual bool due(std::span<const ParetoPoint> archive, std::uint64_t iterations) = 0;
  // Better values of the archive, with which newcomers compare from now on. Empty when stopped half way; nothing has
  // changed then.
  virtual std::optional<SearchValues> re_evaluate(const SearchArchive& archive, std::uint64_t iterations,
                                                  const Progress& progress) = 0;
  // The best values that are to be had, at the end of a search. Empty when stopped half way, as above.
  virtual std::optional<SearchEstimates> verify(const SearchArchive& archive, std::uint64_t iterations,
                                                const Progress& progress) = 0;
};

class SearchEvaluator {
 public:
  virtual ~SearchEvaluator() = default;
  // How many networks evaluate() takes best at once; 0: any number.
  virtual std::size_t chunk() const = 0;
  // Empty when stopped half way.
  virtual std::optional<SearchValues> evaluate(std::span<const PlacedNetwork> networks, const Progress& progress) = 0;
  virtual double trace_seconds() const = 0;
  // The voxels by which the front is reported; none: every ray.
  virtual VoxelWindow reported_by() const = 0;
  // Null: what was evaluated once stands. Otherwise all of the archive is the outcome, and every ray chooses the front.
  virtual ArchiveEvaluator* archive() { return nullptr; }

  // What it must remember to go on from a checkpoint, as bytes.
  virtual std::string state() const { return {}; }
  // Throws Error malformed_file.
  virtual void restore(std::string_view /*state*/) {}
};

// As `config` asks. Borrows the evaluator. `measures`: how many a search evaluates.
std::unique_ptr<SearchEvaluator> make_search_evaluator(NetworkEvaluator& evaluator, const PlanConfig& config,
                                                       std::size_t measures);

}  // namespace vantage
