// SPDX-License-Identifier: Apache-2.0
#include <optional>
#include <string>

#include "core/setting_list.hpp"
#include "core/setting_table.hpp"
#include "vantage/measure.hpp"

namespace vantage {
namespace {

constexpr Interval kTilts{.low = 0, .high = 180};  // degrees

}  // namespace

std::string to_string(RegistrationSurfaces surfaces) {
  return surfaces == RegistrationSurfaces::all ? "all" : "surveyed";
}

Settings settings(const RegistrationOptions& options) {
  return SettingList()
      .add("rho_m", options.model.rho_m, {"registration-rho"})
      .add("patch_m", options.model.patch_m, {"registration-patch"})
      .add("position_m", options.position_m, {"registration-position"})
      .add("heading_deg", options.heading, {"registration-heading"})
      .add("tilt_deg", options.tilt_of_scanner ? std::optional<Angle>() : options.tilt, {"registration-tilt"})
      .add("surfaces", to_string(options.surfaces), {"registration-surfaces"})
      .take();
}

void check(const RegistrationOptions& options) { check_settings(registration_settings(), options); }

const SettingTable<RegistrationOptions>& registration_settings() {
  static const SettingTable<RegistrationOptions> table = [] {
    using Options = RegistrationOptions;
    const Options usual;
    return SettingRows<Options>()
        .group("Registration")
        .number_in(
            "registration-rho", "M",
            otherwise("Modelling error of a scan's surface besides range noise, the same over a patch, in metres",
                      usual.model.rho_m),
            [](Options & o) -> auto& { return o.model.rho_m; }, {.low = 1e-6, .high = 1})
        .advanced()
        .number_in("registration-patch", "M", otherwise("Side of such a patch, in metres", usual.model.patch_m),
                   [](Options & o) -> auto& { return o.model.patch_m; }, {.low = 1e-3, .high = 100})
        .advanced()
        .number("registration-position", "M", "Standard deviation of a head's position before registration, in metres",
                &Options::position_m, {.low = 1e-6, .high = 1e4})
        .advanced()
        .degrees("registration-heading",
                 otherwise("Standard deviation of a scan's heading before registration, in degrees",
                           usual.heading.in_degrees()),
                 &Options::heading, {.low = 1e-6, .high = 180})
        .advanced()
        .custom("registration-tilt", "DEG|scanner",
                otherwise("Standard deviation of a scan's tilts, from its compensator, in degrees; 0: exactly level, "
                          "some degrees: not levelled, scanner: what the scanner states",
                          usual.tilt.in_degrees()),
                [](Options& options, const std::string& text, const std::string& what) {
                  options.tilt_of_scanner = text == "scanner";
                  if (!options.tilt_of_scanner) options.tilt = Angle::degrees(parse_number(text, what, kTilts));
                })
        .checked([](const Options& options, const std::string& what) {
          check_number(whole_degrees(options.tilt), what, kTilts);
        })
        .advanced()
        .custom("registration-surfaces", "surveyed|all",
                "Surfaces that scans register on: surveyed ones, or all; surveyed otherwise",
                [](Options& options, const std::string& text, const std::string& what) {
                  if (text != "all" && text != "surveyed")
                    throw Error(Errc::invalid_argument, what + ": '" + text + "' is neither surveyed nor all");
                  options.surfaces = text == "all" ? RegistrationSurfaces::all : RegistrationSurfaces::surveyed;
                })
        .advanced()
        .take();
  }();
  return table;
}

}  // namespace vantage
