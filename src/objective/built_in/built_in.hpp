// SPDX-License-Identifier: Apache-2.0
// Built-in objectives: one file each in this folder, one line each in the module's list file.
#pragma once

#include "vantage/objective.hpp"

namespace vantage::built_in {

#define VANTAGE_OBJECTIVE(name) Objective name(const ObjectiveSettings& settings);
#include "built_in_objectives.inc"
#undef VANTAGE_OBJECTIVE

}  // namespace vantage::built_in
