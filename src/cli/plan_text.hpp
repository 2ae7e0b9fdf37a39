// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "vantage/vantage.hpp"

namespace vantage::cli {

// Text of a plan for a terminal: the front, the chosen network's stations and its summary.
std::string plan_text(const PlanResult& result, const std::string& folder);

}  // namespace vantage::cli
