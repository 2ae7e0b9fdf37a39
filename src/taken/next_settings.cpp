// SPDX-License-Identifier: Apache-2.0
#include "core/setting_list.hpp"
#include "core/setting_table.hpp"
#include "vantage/taken_scans.hpp"

namespace vantage {

Settings settings(const NextConfig& config) {
  return SettingList()
      .add("next_capture", config.capture, {"capture"})
      .add("next_link", config.link, {"link"})
      .add("next_tolerance_m", config.tolerance_m, {"tolerance"})
      .add("next_taken_within_m", config.taken_within_m, {"taken-within"})
      .add("next_sample_voxels", config.sample_voxels)
      .add("next_most", config.most, {"most"})
      .add("next_unknown", config.unknown, {"unknown"})
      .take();
}

const SettingTable<NextConfig>& next_settings() {
  using Options = NextConfig;
  static const SettingTable<Options> table =
      SettingRows<Options>()
          .group("Next stations")
          .number("capture", "SHARE", "Wanted share of what is attainable, above 0 and at most 1", &Options::capture,
                  {.low = 0.01, .high = 1})
          .number("link", "SHARE",
                  "Least scan overlap of links that connect all stations; 0: they need not be connected",
                  &Options::link, {.low = 0, .high = 1})
          .count("most", "N", otherwise("Most further stations", static_cast<double>(Options().most)), &Options::most,
                 1, 1000)
          .flag("unknown", "The edge of space that no scan saw is a goal; so it is if the scans are the site",
                &Options::unknown)
          .number("tolerance", "M", "Points of scans farther than this from the model are of something else, in metres",
                  &Options::tolerance_m, {.low = 0.02, .high = 1})
          .number("taken-within", "M", "A scan this near to a planned station is that station, in metres",
                  &Options::taken_within_m, {.low = 0.01, .high = 100})
          .take();
  return table;
}

}  // namespace vantage
