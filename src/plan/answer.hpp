// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>

#include "vantage/planner.hpp"

namespace vantage {

// answer() of a front that is no result yet. REQUIRES: a network, and the violations of all.
std::size_t answer(std::span<const PlanEntry> front, const SurveyProblem& problem);

}  // namespace vantage
