// SPDX-License-Identifier: Apache-2.0
#include "objective/built_in/built_in.hpp"
#include "objective/built_in/registration.hpp"

namespace vantage::built_in {

Objective registration_worst(const ObjectiveSettings& settings) {
  return registration_figure(settings, "registration_worst", "registration error of the worst station",
                             "Registration error of the worst station (predicted)", &RegistrationError::worst_m);
}

}  // namespace vantage::built_in
