// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plan/network_evaluator.hpp"

namespace vantage {

class SimulatorEvaluator final : public NetworkEvaluator {
 public:
  struct Options {
    std::uint64_t sample_voxels = 0;  // 0: every ray
    bool overlap = true;
    double min_link_overlap = 0;  // 0: parts are not counted
  };
  // Borrows the simulator.
  SimulatorEvaluator(Simulator& simulator, const Options& options) : simulator_(simulator), options_(options) {}

  std::size_t chunk() const override { return options_.sample_voxels == 0 ? 1 : 0; }
  std::optional<std::vector<NetworkValue>> evaluate(std::span<const Network> networks,
                                                    const Progress& progress) override;
  std::optional<std::vector<NetworkEstimate>> estimate(std::span<const Network> networks,
                                                       const Progress& progress) override;
  std::optional<ConfirmedNetwork> confirm(const Network& network, const Progress& progress) override;
  double trace_seconds() const override { return trace_seconds_; }

 private:
  std::optional<std::vector<NetworkCounts>> count(std::span<const Network> networks, bool overlap,
                                                  const Progress& progress);
  Simulator& simulator_;
  Options options_;
  double trace_seconds_ = 0;
};

}  // namespace vantage
