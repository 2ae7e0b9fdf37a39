// SPDX-License-Identifier: Apache-2.0
#include "cli/station_scanners.hpp"

namespace vantage::cli {

std::uint32_t scanner_of(Site& site, const std::string& name, std::optional<Angle> step) {
  Scanner scanner = site.scanner();
  if (!name.empty() && name != scanner.name) {
    const double height = scanner.height_m;
    scanner = load_scanner(name, own_presets_file());
    scanner.height_m = height;
  }
  if (step) scanner.azimuth_step = scanner.zenith_step = *step;
  return site.place_of(scanner);
}

}  // namespace vantage::cli
