// SPDX-License-Identifier: Apache-2.0
// Built-in objectives: one file each in this folder, one line each in the module's list file.
#pragma once

#include <string_view>

#include "vantage/objective.hpp"

namespace vantage::built_in {

#define VANTAGE_OBJECTIVE(name) Objective name(const ObjectiveSettings& settings);
#include "built_in_objectives.inc"
#undef VANTAGE_OBJECTIVE
// capture(MESHES), of the surveyed meshes of a pattern.
Objective capture_of(std::string_view meshes);

}  // namespace vantage::built_in
