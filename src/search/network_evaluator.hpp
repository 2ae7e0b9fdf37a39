// SPDX-License-Identifier: Apache-2.0
// Interface between search and simulation: networks in, values of measures out.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

#include "vantage/evaluation.hpp"
#include "vantage/progress.hpp"

namespace vantage {

using PlacedNetwork = std::vector<PlacedStation>;

// A sample of `voxels` voxels, from place `from` on in the draw. No voxels: every ray.
struct VoxelWindow {
  std::uint64_t voxels = 0, from = 0;
  friend bool operator==(const VoxelWindow&, const VoxelWindow&) = default;
};

class NetworkEvaluator {
 public:
  virtual ~NetworkEvaluator() = default;
  // Best number of networks for one call of evaluate() with every ray; 0: any.
  virtual std::size_t chunk() const = 0;
  // Values of the searched measures of each network, in order. Empty if stopped.
  virtual std::optional<std::vector<std::vector<double>>> evaluate(std::span<const PlacedNetwork> networks,
                                                                   const VoxelWindow& sample,
                                                                   const Progress& progress) = 0;
  enum class Which { searched, all };
  // The same values with standard errors, of the searched measures or of all.
  virtual std::optional<std::vector<std::vector<Estimate>>> estimate(std::span<const PlacedNetwork> networks,
                                                                     const VoxelWindow& sample, Which measures,
                                                                     const Progress& progress) = 0;
  // All measures with every ray; empty for networks not reached before a stop. A single network may keep the points of
  // every voxel.
  virtual std::vector<std::optional<Evaluation>> confirm(std::span<const PlacedNetwork> networks,
                                                         const Progress& progress) = 0;
  virtual double trace_seconds() const = 0;
};

// Caches the values of networks on the present sample.
class CachingEvaluator {
 public:
  explicit CachingEvaluator(NetworkEvaluator& evaluator) : evaluator_(evaluator) {}
  std::optional<std::vector<std::vector<double>>> evaluate(std::span<const PlacedNetwork> networks,
                                                           const VoxelWindow& sample, const Progress& progress);
  std::uint64_t simulated() const { return simulated_; }

 private:
  NetworkEvaluator& evaluator_;
  std::unordered_map<std::string, std::vector<double>> known_;  // by `sample_`
  VoxelWindow sample_;
  std::uint64_t simulated_ = 0;
};

}  // namespace vantage
