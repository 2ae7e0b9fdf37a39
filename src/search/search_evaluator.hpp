// SPDX-License-Identifier: Apache-2.0
// Evaluation as the search loop sees it: values of proposed networks, and sometimes better values of the archive.
// Exact, on one sample of voxels, or on a sample that is redrawn.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "search/network_evaluator.hpp"
#include "vantage/problem.hpp"

namespace vantage {

// Values of the searched measures, a row for each network.
using SearchValues = std::vector<std::vector<double>>;
using SearchEstimates = std::vector<std::vector<Estimate>>;

// The optimiser's archive.
struct SearchArchive {
  std::vector<ParetoPoint> points;
  std::vector<PlacedNetwork> networks;  // of the points, in their order
};

// Re-evaluates the archive, with samples that did not choose it.
class ArchiveEvaluator {
 public:
  virtual ~ArchiveEvaluator() = default;
  // Gets the archive after each iteration. Returns whether re_evaluate() is due.
  virtual bool due(std::span<const ParetoPoint> archive, std::uint64_t iterations) = 0;
  // Better values of the archive, with which newcomers compare from now on. Empty if stopped; nothing has changed then.
  virtual std::optional<SearchValues> re_evaluate(const SearchArchive& archive, std::uint64_t iterations,
                                                  const Progress& progress) = 0;
  // The best available values, at the end of a search. Empty if stopped, as above.
  virtual std::optional<SearchEstimates> verify(const SearchArchive& archive, std::uint64_t iterations,
                                                const Progress& progress) = 0;
};

class SearchEvaluator {
 public:
  virtual ~SearchEvaluator() = default;
  // Best number of networks for one call of evaluate(); 0: any.
  virtual std::size_t chunk() const = 0;
  // Empty if stopped.
  virtual std::optional<SearchValues> evaluate(std::span<const PlacedNetwork> networks, const Progress& progress) = 0;
  virtual double trace_seconds() const = 0;
  // Voxels of the reported values; none: every ray.
  virtual VoxelWindow reported_by() const = 0;
  // Null: values are final. Otherwise the outcome is the whole archive, and every ray chooses the front.
  virtual ArchiveEvaluator* archive() { return nullptr; }

  // State for a checkpoint, as bytes.
  virtual std::string state() const { return {}; }
  // Throws Error malformed_file.
  virtual void restore(std::string_view /*state*/) {}
};

// Makes the evaluator of `config`. Borrows the other one. `measures`: number of measures that a search evaluates.
std::unique_ptr<SearchEvaluator> make_search_evaluator(NetworkEvaluator& evaluator, const PlanConfig& config,
                                                       std::size_t measures);

}  // namespace vantage
