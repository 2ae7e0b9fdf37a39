// SPDX-License-Identifier: Apache-2.0
#include "core/setting_list.hpp"
#include "core/setting_table.hpp"
#include "core/text.hpp"
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
      .take();
}

const SettingTable<NextConfig>& next_settings() {
  using Options = NextConfig;
  static const SettingTable<Options> table = [] {
    const Options usual;
    const auto number_of = [](double Options::*member, Interval interval) {
      return [member, interval](Options& options, const std::string& text, const std::string& what) {
        options.*member = parse_number(text, what, interval);
      };
    };
    const auto otherwise = [](const std::string& help, const std::string& usually) {
      return help + "; " + usually + " otherwise";
    };
    return SettingRows<Options>()
        .group("Next stations")
        .custom("capture", "SHARE",
                otherwise("Wanted share of what is attainable, above 0 and at most 1", number(usual.capture)),
                number_of(&Options::capture, {.low = 0.01, .high = 1}))
        .custom("link", "SHARE",
                otherwise("Least scan overlap of links that connect all stations; 0: they need not be connected",
                          number(usual.link)),
                number_of(&Options::link, {.low = 0, .high = 1}))
        .count("most", "N", otherwise("Most further stations", number(usual.most)), &Options::most, 1, 1000)
        .custom("tolerance", "M",
                otherwise("Points of scans farther than this from the model are of something else, in metres",
                          number(usual.tolerance_m)),
                number_of(&Options::tolerance_m, {.low = 0.02, .high = 1}))
        .custom(
            "taken-within", "M",
            otherwise("A scan this near to a planned station is that station, in metres", number(usual.taken_within_m)),
            number_of(&Options::taken_within_m, {.low = 0.01, .high = 100}))
        .take();
  }();
  return table;
}

}  // namespace vantage
