// SPDX-License-Identifier: Apache-2.0
// What the objectives of the registration error share.
#pragma once

#include <string>

#include "vantage/objective.hpp"

namespace vantage::built_in {

// In millimetres.
Objective registration_figure(const ObjectiveSettings& settings, std::string name, std::string label,
                              double RegistrationError::*figure);

}  // namespace vantage::built_in
