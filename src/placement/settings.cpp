// SPDX-License-Identifier: Apache-2.0
#include "core/setting_list.hpp"
#include "vantage/placement.hpp"

namespace vantage {

Settings settings(const WalkableOptions& options) {
  return SettingList()
      .add("max_slope_deg", options.max_slope, {"slope"})
      .add("headroom_m", options.headroom_m, {"headroom"})
      .add("min_area_m2", options.min_area_m2, {"min-area"})
      .take();
}

Settings settings(const SecurityVolume& volume) {
  return SettingList()
      .add("lower_m", volume.lower_m, {"security"})
      .add("upper_m", volume.upper_m, {"security"})
      .add("radius_m", volume.radius_m, {"security"})
      .take();
}

}  // namespace vantage
