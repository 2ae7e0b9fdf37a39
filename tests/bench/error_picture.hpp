// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "map/canvas.hpp"

namespace vantage::bench {

// Methods of evaluating a network.
enum class Way { every_ray, exact, sampled, coarser_steps, coarser_steps_and_voxels, coarser_voxels };

struct ErrorDot {
  Way way = Way::exact;
  std::string label;  // size of the sample, factor
  double milliseconds = 0;
  double coverage_rms = 0, overlap_rms = 0;  // 0 for what is exact
  double coverage_se = 0, overlap_se = 0;    // predicted; of samples alone
};

// Time against error, both logarithmic: coverage left, clustering coefficient right.
std::unique_ptr<Canvas> error_picture(const std::vector<ErrorDot>& dots, const std::string& title,
                                      const std::string& subtitle, const std::string& time_label);

}  // namespace vantage::bench
