// SPDX-License-Identifier: Apache-2.0
#include "core/require_above_zero.hpp"
#include "core/setting_list.hpp"
#include "core/setting_table.hpp"
#include "core/text.hpp"
#include "vantage/on_site.hpp"
#include "vantage/targets.hpp"

namespace vantage {
namespace {

constexpr Interval kMinutes{.low = 0, .high = 1e6};
constexpr Interval kMinutesOfDay{.low = 0, .high = 24 * 60};  // minutes

[[noreturn]] void refuse_window(const std::string& text, const std::string& what) {
  throw Error(Errc::invalid_argument,
              what + ": '" + text + "' is no pattern of rooms and hours of the day, such as hall*=06:00-08:00");
}

}  // namespace

AccessWindow parse_access_window(const std::string& text, const std::string& what) {
  const auto equals = text.rfind('=');
  const auto dash = text.find('-', equals == std::string::npos ? 0 : equals);
  if (equals == std::string::npos || equals == 0 || dash == std::string::npos) refuse_window(text, what);
  const AccessWindow window{.rooms = text.substr(0, equals),
                            .from_min = parse_clock(text.substr(equals + 1, dash - equals - 1), what),
                            .to_min = parse_clock(text.substr(dash + 1), what)};
  if (window.from_min == window.to_min) refuse_window(text, what);
  return window;
}

std::string to_string(const AccessWindow& window) {
  constexpr double kMidnight_min = 24 * 60;
  return window.rooms + "=" + clock_text(window.from_min) + "-" +
         (window.to_min == kMidnight_min ? "24:00" : clock_text(window.to_min));
}

Settings settings(const OnSiteOptions& options) {
  SettingList list;
  list.add("set_up_min", options.set_up_min, {"set-up"})
      .add("photos_min", options.photos_min, {"photos"})
      .add("walking_m_per_s", options.walking_m_per_s, {"walking"})
      .add("detour", options.detour)
      .add("entrance", options.entrance);
  // Sessions are made of the answer's round, and decide nothing in a search for it.
  if (options.day_min)
    list.add("day", number(*options.day_min) + "min", {"day", false})
        .add("crews", options.crews, {"crews", false})
        .add("day_start", clock_text(options.day_start_min), {"day-start", false});
  if (!options.windows.empty()) {
    std::vector<std::string> windows;
    for (const AccessWindow& window : options.windows) windows.push_back(to_string(window));
    list.add("windows", windows, {"window", false});
  }
  return list.take();
}

const SettingTable<OnSiteOptions>& on_site_settings() {
  static const SettingTable<OnSiteOptions> table =
      SettingRows<OnSiteOptions>()
          .group("Problem")
          .number("set-up", "MIN", "Minutes at each station besides the scan itself", &OnSiteOptions::set_up_min,
                  kMinutes)
          .number("photos", "MIN", "Minutes at each station for pictures, where the scanner takes some",
                  &OnSiteOptions::photos_min, kNotNegative)
          .number("walking", "M/S", "Walking speed with the scanner, in metres per second",
                  &OnSiteOptions::walking_m_per_s, kMeasurable)
          .optional("day", "T",
                    "Longest session, from the entrance and back: 8h or 450min. A longer round is split into sessions",
                    &OnSiteOptions::day_min,
                    [](const std::string& text, const std::string& what) { return parse_duration(text, what) / 60; })
          .checked([](const OnSiteOptions& options, const std::string& what) {
            if (options.day_min) check_number(*options.day_min, what, kPositive);
          })
          .count("crews", "N", "Crews that work side by side, a session each, every day; 1 otherwise. Takes a day",
                 &OnSiteOptions::crews, 1, 1000)
          .checked([](const OnSiteOptions& options, const std::string& what) {
            parse_count(std::to_string(options.crews), what, 1, 1000);
          })
          .custom("day-start", "HH:MM", "Time at which a day's sessions leave the entrance; 08:00 otherwise",
                  [](OnSiteOptions& options, const std::string& text, const std::string& what) {
                    options.day_start_min = parse_clock(text, what);
                  })
          .checked([](const OnSiteOptions& options, const std::string& what) {
            check_number(options.day_start_min, what, kMinutesOfDay);
          })
          .repeated(
              "window", "ROOMS=HH:MM-HH:MM",
              "Hours of the day outside of which nobody may scan in rooms of such names: 'hall*=06:00-08:00'. "
              "Takes a day; may be repeated",
              [](OnSiteOptions & options) -> auto& { return options.windows; }, parse_access_window)
          .checked([](const OnSiteOptions& options, const std::string& what) {
            for (const AccessWindow& window : options.windows) {
              if (window.rooms.empty()) refuse_window(to_string(window), what);
              for (const double time : {window.from_min, window.to_min}) check_number(time, what, kMinutesOfDay);
            }
          })
          .take();
  return table;
}

Settings settings(const TargetOptions& options) {
  return SettingList()
      .add("target_diameter_m", options.diameter_m, {"target-diameter"})
      .add("target_height_m", options.height_m, {"target-height"})
      .add("target_sigma_m", options.sigma_m, {"target-sigma"})
      .add("target_points", options.least_points)
      .add("targets_least", options.least)
      .add("targets_most", options.most)
      .add("accuracy_class", to_string(wanted_class(options)), {"accuracy-class"})
      .add("target_largest_rms_m", options.largest_rms_m)
      .add("target_exact", options.exact)
      .take();
}

void check(const TargetOptions& options) {
  check_settings(target_settings(), options);
  if (options.largest_rms_m) require_above_zero("targets", "largest_rms_m", *options.largest_rms_m);
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
