// SPDX-License-Identifier: Apache-2.0
#include "cli/registration.hpp"

#include <spdlog/fmt/fmt.h>

#include "cli/options.hpp"
#include "cli/parse.hpp"
#include "vantage/error.hpp"

namespace vantage::cli {

void RegistrationCliOptions::add(CLI::App& command) {
  const RegistrationOptions usual;
  const auto number = [&](const char* name, const char* unit, const std::string& what, double otherwise,
                          std::optional<double>& target, const Interval& interval) {
    add_number(command, name, unit, fmt::format("{}; {:.6g} otherwise", what, otherwise), target, interval)
        ->group("Registration");
  };
  number("--registration-rho", "M", "Error of a scan's surface, besides range noise, that is the same over a patch",
         usual.model.rho_m, rho_m, {.low = 1e-6, .high = 1});
  number("--registration-patch", "M", "Side of such a patch", usual.model.patch_m, patch_m, {.low = 1e-3, .high = 100});
  number("--registration-position", "M", "Standard deviation of a head's position before registration",
         usual.position_m, position_m, {.low = 1e-6, .high = 1e4});
  number("--registration-heading", "DEG", "Standard deviation of a scan's heading before registration",
         usual.heading.in_degrees(), heading_deg, {.low = 1e-6, .high = 180});
  number("--registration-tilt", "DEG",
         "Standard deviation of a scan's tilts, by its compensator; 0: exactly level, some degrees: not levelled",
         usual.tilt.in_degrees(), tilt_deg, {.low = 0, .high = 180});
  add_value(command, "--registration-surfaces", "surveyed|all",
            "What holds scans together: surveyed surfaces, or also those that nobody surveys; surveyed otherwise",
            [this](const std::string& text, const std::string& what) {
              if (text != "all" && text != "surveyed")
                throw Error(Errc::invalid_argument, what + ": '" + text + "' is neither surveyed nor all");
              surfaces = text == "all" ? RegistrationSurfaces::all : RegistrationSurfaces::surveyed;
            })
      ->group("Registration");
}

RegistrationOptions RegistrationCliOptions::settle() const {
  RegistrationOptions options;
  if (rho_m) options.model.rho_m = *rho_m;
  if (patch_m) options.model.patch_m = *patch_m;
  if (position_m) options.position_m = *position_m;
  if (heading_deg) options.heading = Angle::degrees(*heading_deg);
  if (tilt_deg) options.tilt = Angle::degrees(*tilt_deg);
  options.surfaces = surfaces;
  return options;
}

}  // namespace vantage::cli
