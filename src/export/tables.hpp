// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "vantage/planner.hpp"

namespace vantage {

// A line an iteration; the one table with times in it.
void write_history_csv(const std::filesystem::path& file, const PlanResult& result);
// Every iteration's front, a line a network that keeps the requirements: the objectives.
void write_fronts_csv(const std::filesystem::path& file, const PlanResult& result);

}  // namespace vantage
