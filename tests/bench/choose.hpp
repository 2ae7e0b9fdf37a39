// SPDX-License-Identifier: Apache-2.0
// Time to choose stations on a site that is too large for one network: on arrays alone, without a ray.
#pragma once

#include <CLI/CLI.hpp>
#include <cstddef>
#include <cstdint>

namespace vantage::bench {

struct ChooseOptions {
  std::size_t stations = 1000, candidates = 8000, voxels = 200'000;
  double capture = 0.8;
  std::uint64_t seed = 1;
  void add(CLI::App& command);
};

void run_choose(const ChooseOptions& options);

}  // namespace vantage::bench
