// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "plan/measures.hpp"
#include "plan/network_evaluator.hpp"
#include "vantage/simulator.hpp"

namespace vantage {

class SimulatorEvaluator final : public NetworkEvaluator {
 public:
  struct Options {
    std::size_t existing = 0;  // number of existing stations, the first of every network
    // Connected components of the visibility graph; required if a measure needs it.
    std::function<std::size_t(const Network&)> visible_parts = {};
    // All surfaces; required if a measure needs them. With a number of sampled voxels, or every ray.
    Simulator* surroundings = nullptr;
    std::uint64_t surroundings_voxels = 0;
    RegistrationOptions registration = {};  // of confirmed networks, where a measure needs it
    // By which searches and confirmed networks are told what they capture; needed where a measure needs it. On
    // different voxels, or a network would be confirmed on those that it was chosen by.
    const AttainableCounts *searched = nullptr, *confirmed = nullptr;
    // Minutes on site without the existing stations; needed where a measure needs it.
    std::function<double(std::span<const PlacedStation>)> minutes = {};
  };
  // Borrows the simulators.
  SimulatorEvaluator(Simulator& simulator, Measures measures, Options options)
      : simulator_(simulator), measures_(std::move(measures)), options_(std::move(options)) {}

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
  struct Counted {
    std::vector<NetworkCounts> surveyed, surroundings;  // the latter empty where nothing needs them
    std::vector<Estimate> captured;                     // the same
  };
  // `errors`: whether standard errors are needed.
  std::optional<Counted> count(std::span<const Network> networks, const VoxelWindow& sample,
                               const RequiredInputs& needs, bool errors, const Progress& progress);
  // A window without voxels means every ray.
  std::optional<std::vector<NetworkCounts>> count_with(Simulator& simulator, std::span<const Network> networks,
                                                       const SampleOptions& sample, const Progress& progress);
  MeasuredNetwork measured(const Counted& counted, std::size_t k, const PlacedNetwork& stations, const Network& network,
                           const RequiredInputs& needs) const;

  Simulator& simulator_;
  Measures measures_;
  Options options_;
  double trace_seconds_ = 0;
};

}  // namespace vantage
