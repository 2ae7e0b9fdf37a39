// SPDX-License-Identifier: Apache-2.0
#include "core/setting_list.hpp"
#include "vantage/placement.hpp"

namespace vantage {
namespace {

// Returns regions by their content, whatever file they came from.
std::vector<std::vector<std::vector<std::array<double, 2>>>> rings_of(const std::vector<PlanRegion>& regions) {
  std::vector<std::vector<std::vector<std::array<double, 2>>>> rings;
  for (const PlanRegion& region : regions) rings.push_back(region.rings);
  return rings;
}

std::optional<std::vector<Vec3>> entries_of(const WalkableOptions& options) {
  if (options.enter.empty()) return std::nullopt;
  return options.enter;
}

}  // namespace

Settings settings(const WalkableOptions& options) {
  return SettingList()
      .add("max_slope_deg", options.max_slope, {"slope"})
      .add("headroom_m", options.headroom_m, {"headroom"})
      .add("min_area_m2", options.min_area_m2, {"min-area"})
      .add("passage_width_m", options.passage_width_m, {"passage"})
      .add("passage_height_m", options.passage_height_m, {"passage"})
      .add("climb_m", options.climb_m, {"climb"})
      .add("enter", entries_of(options), {"enter"})
      .add("enter_closed", options.enter_closed)
      .add("levels", options.levels, {"levels"})
      .add("within", rings_of(options.within))
      .add("without", rings_of(options.without))
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
