// SPDX-License-Identifier: Apache-2.0
// Shared by the objectives of the registration error.
#pragma once

#include <string>

#include "vantage/objective.hpp"

namespace vantage::built_in {

// In millimetres.
Objective registration_figure(const ObjectiveSettings& settings, std::string name, std::string noun, std::string label,
                              double RegistrationError::*figure);

}  // namespace vantage::built_in
