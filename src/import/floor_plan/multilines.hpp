// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "import/floor_plan/drawing.hpp"

namespace vantage::floor_plan {

// Calls `add` for each line of each multiline in the model space; layers are named as in the file. Those of blocks are
// passed over.
void read_multilines(const std::filesystem::path& file,
                     const std::function<void(const std::string& layer, Point a, Point b)>& add);

}  // namespace vantage::floor_plan
