// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "vantage/planner.hpp"

namespace vantage {

// Writes a line for each iteration; the only table with times.
void write_history_csv(const std::filesystem::path& file, const PlanResult& result);
// Writes every iteration's front: a line with the objectives of each network that meets the requirements.
void write_fronts_csv(const std::filesystem::path& file, const PlanResult& result);

}  // namespace vantage
