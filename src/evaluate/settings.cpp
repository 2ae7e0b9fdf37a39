// SPDX-License-Identifier: Apache-2.0
#include "core/setting_table.hpp"
#include "vantage/on_site.hpp"
#include "vantage/targets.hpp"

namespace vantage {
namespace {

constexpr Interval minutes{.low = 0, .high = 1e6};

}  // namespace

const SettingTable<OnSiteOptions>& on_site_settings() {
  static const SettingTable<OnSiteOptions> table =
      SettingRows<OnSiteOptions>()
          .group("Problem")
          .number("set-up", "MIN", "Minutes at each station besides the scan itself", &OnSiteOptions::set_up_min,
                  minutes)
          .number("photos", "MIN", "Minutes at each station for pictures, where the scanner takes some",
                  &OnSiteOptions::photos_min, not_negative)
          .number("walking", "M/S", "Walking speed with the scanner, in metres per second",
                  &OnSiteOptions::walking_m_per_s, measurable)
          .optional("day", "T",
                    "Longest session, from the entrance and back: 8h or 450min. A longer round is split into sessions",
                    &OnSiteOptions::day_min,
                    [](const std::string& text, const std::string& what) { return parse_duration(text, what) / 60; })
          .checked([](const OnSiteOptions& options, const std::string& what) {
            if (options.day_min) check_number(*options.day_min, what, positive);
          })
          .count("crews", "N", "Crews that work side by side, a session each, every day; 1 otherwise. Takes a day",
                 &OnSiteOptions::crews, 1, 1000)
          .checked([](const OnSiteOptions& options, const std::string& what) {
            parse_count(std::to_string(options.crews), what, 1, 1000);
          })
          .take();
  return table;
}

const SettingTable<TargetOptions>& target_settings() {
  using Options = TargetOptions;
  static const SettingTable<Options> table = [] {
    return SettingRows<Options>()
        .group("Targets")
        .number("target-diameter", "M", "Diameter of a target, a sphere or checkerboard", &Options::diameter_m,
                {.low = 0.01, .high = 2})
        .number("target-height", "M", "Height of a proposed target's centre above the ground", &Options::height_m,
                {.low = 0.05, .high = 10})
        .number("target-sigma", "M",
                "Standard deviation of a target's centre in a scan, besides range noise and calibration; 0.0002 "
                "otherwise, or 0.001 by a scanner that states no calibration",
                &Options::sigma_m, {.low = 1e-5, .high = 0.1})
        .custom("accuracy-class", "LOA20|LOA30|LOA40|LOA50",
                "What the registration error is judged by, at 95 %: 50, 15, 5 or 1 mm; the class of --for, or LOA30 "
                "otherwise",
                [](Options& options, const std::string& text, const std::string& what) {
                  options.accuracy_class = named(what, [&] { return accuracy_class_from_string(text); });
                })
        .take();
  }();
  return table;
}

}  // namespace vantage
