// SPDX-License-Identifier: Apache-2.0
#include "objective/built_in/registration.hpp"

#include <string>
#include <utility>

#include "objective/built_in/built_in.hpp"
#include "vantage/registration.hpp"

namespace vantage::built_in {
namespace {

constexpr double kMillimetresPerMetre = 1000;
// End of the search's scale. Good networks register to some tenths of a millimetre.
constexpr double kWorst_mm = 10;

std::string parameters_of(const RegistrationOptions& options) {
  std::string text;
  for (const Setting& setting : vantage::settings(options))
    text += (text.empty() ? "" : ", ") + setting.name + " " + setting.json;
  return text;
}

}  // namespace

Objective registration_figure(const ObjectiveSettings& settings, std::string name, std::string noun, std::string label,
                              double RegistrationError::*figure) {
  const RegistrationOptions options = settings.registration;
  check(options);
  const bool all = options.surfaces == RegistrationSurfaces::all;
  return {
      .name = std::move(name),
      .label = std::move(label),
      .unit = "mm",
      .noun = std::move(noun),
      .scale = minimise(0, kWorst_mm),
      .needs = {.pairs = true, .surroundings = all, .registration = options.model, .surroundings_registration = all},
      .value =
          [options, figure](const MeasuredNetwork& m) {
            return registration_error(m.counts, m.voxels, options, m.surroundings, m.surroundings_voxels).*figure *
                   kMillimetresPerMetre;
          },
      .parameters = parameters_of(options)};
}

Objective registration(const ObjectiveSettings& settings) {
  return registration_figure(settings, "registration", "registration error",
                             "Registration error over the covered surface (predicted)", &RegistrationError::rms_m);
}

}  // namespace vantage::built_in
