// SPDX-License-Identifier: Apache-2.0
#include "core/setting_list.hpp"
#include "vantage/scene.hpp"

namespace vantage {

Settings settings(const SceneOptions& options) {
  std::vector<std::string> weights;
  for (const auto& [pattern, weight] : options.weights) weights.push_back(pattern + "=" + std::to_string(weight));
  return SettingList()
      .add("surveyed", options.surveyed, {"surveyed", false})
      .add("blocking", options.blocking, {"blocking", false})
      .add("search", options.search, {"search", false})
      .add("ignore", options.ignore, {"ignore", false})
      .add("weights", weights, {"weight", false})
      .add("doors", options.doors, {"doors", false})
      .add("station_area", options.station_area, {"station-area", false})
      .add("scene_index", options.scene_index, {"scene-index", false})
      .add("default_diffuse", options.default_diffuse, {"diffuse", false})
      .add("unit", options.unit ? std::optional<std::string>(to_string(*options.unit)) : std::nullopt, {"unit", false})
      .add("up", options.up ? std::optional<std::string>(to_string(*options.up)) : std::nullopt, {"up", false})
      .add("allow_outside", options.allow_outside, {options.allow_outside ? "allow-outside" : "", false})
      .take();
}

}  // namespace vantage
