// SPDX-License-Identifier: Apache-2.0
// Where scanners and their noise come from.
#pragma once

#include <filesystem>
#include <string>

#include "vantage/scanner.hpp"

namespace vantage::cli {

// The presets file that was installed with this program, wherever that tree now lies; else default_presets_file().
std::filesystem::path presets_file();

// --noise: off, a preset's name, or a CSV file with a header `reflectivity,<distance in metres>,…` and a line of
// standard deviations in metres for each reflectivity.
NoiseTable load_noise(const std::string& name);

}  // namespace vantage::cli
