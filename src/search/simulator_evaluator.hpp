// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "evaluate/evaluator.hpp"
#include "search/measures.hpp"
#include "search/network_evaluator.hpp"
#include "vantage/simulator.hpp"

namespace vantage {

class SimulatorEvaluator final : public NetworkEvaluator {
 public:
  // Attainable counts that captured shares of searches and of confirmed networks refer to, if a measure needs them.
  // They are of different voxels, so that no network is confirmed on those that chose it.
  struct Attainable {
    const AttainableCounts *searched = nullptr, *confirmed = nullptr;
  };
  // Borrows the site's parts, which measures need. A search counts so many voxels of the surroundings; 0: every ray.
  SimulatorEvaluator(const EvaluationSite& site, Measures measures, EvaluationOptions options, Attainable attainable,
                     std::uint64_t surroundings_voxels)
      : site_(site),
        measures_(std::move(measures)),
        attainable_(attainable),
        surroundings_voxels_(surroundings_voxels),
        evaluator_(site, std::move(options), measures_.all) {}

  std::size_t chunk() const override;
  std::optional<std::vector<std::vector<double>>> evaluate(std::span<const PlacedNetwork> networks,
                                                           const VoxelWindow& sample,
                                                           const Progress& progress) override;
  std::optional<std::vector<std::vector<Estimate>>> estimate(std::span<const PlacedNetwork> networks,
                                                             const VoxelWindow& sample, Which measures,
                                                             const Progress& progress) override;
  std::vector<std::optional<Evaluation>> confirm(std::span<const PlacedNetwork> networks,
                                                 const Progress& progress) override;
  double trace_seconds() const override { return trace_seconds_; }

 private:
  struct Counted : CountedNetworks {
    std::vector<CapturedShares> captured;  // empty where nothing needs them
    CountedNetwork network(std::size_t k, const PlacedNetwork& stations) const {
      return {.stations = stations,
              .surveyed = surveyed[k],
              .surroundings = surroundings.empty() ? nullptr : &surroundings[k],
              .captured = captured.empty() ? CapturedShares{} : captured[k]};
    }
  };
  // `errors`: whether standard errors are needed.
  std::optional<Counted> count(std::span<const Network> networks, const VoxelWindow& sample,
                               const RequiredInputs& needs, bool errors, const Progress& progress);
  // A window without voxels means every ray.
  std::optional<std::vector<NetworkCounts>> count_with(Simulator& simulator, std::span<const Network> networks,
                                                       const SampleOptions& sample, const Progress& progress);

  EvaluationSite site_;
  Measures measures_;
  Attainable attainable_;
  std::uint64_t surroundings_voxels_;
  Evaluator evaluator_;
  double trace_seconds_ = 0;
};

}  // namespace vantage
