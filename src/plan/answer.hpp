// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "vantage/planner.hpp"

namespace vantage {

// Returns the answer of a front that is not part of a result yet. REQUIRES: a network, and the violations of all.
std::size_t answer(std::span<const PlanEntry> front, const SurveyProblem& problem);

// Returns the requirements of a plan's problem. Their advice asks for more stations only if the answer has all that are
// allowed, and the limit can be raised.
std::vector<Requirement> advised_requirements(const PlanResult& result);

// True if a requirement is what the stations that pay capture, rather than the problem's own.
bool requires_what_pays(const PlanResult& result, const Requirement& requirement);

}  // namespace vantage
