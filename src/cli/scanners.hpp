// SPDX-License-Identifier: Apache-2.0
// Where a scanner's noise comes from.
#pragma once

#include <string>

#include "vantage/scanner.hpp"

namespace vantage::cli {

// --noise: off, a preset's name, or a CSV file with a header `reflectivity,<distance in metres>,…` and a line of
// standard deviations in metres for each reflectivity.
NoiseTable load_noise(const std::string& name);

}  // namespace vantage::cli
