// SPDX-License-Identifier: Apache-2.0
#include "core/setting_list.hpp"
#include "vantage/scene.hpp"

namespace vantage {

Settings settings(const SceneOptions& options) {
  // Writes in the format of the program's options, with numbers to the last bit.
  const auto listed = [](const auto& values) {
    std::vector<std::string> texts;
    for (const auto& [pattern, value] : values) texts.push_back(pattern + "=" + nlohmann::json(value).dump());
    return texts;
  };
  return SettingList()
      .add("beside", options.beside, {"beside", false})
      .add("surveyed", options.surveyed, {"surveyed", false})
      .add("blocking", options.blocking, {"blocking", false})
      .add("search", options.search, {"search", false})
      .add("ignore", options.ignore, {"ignore", false})
      .add("weights", listed(options.weights), {"weight", false})
      .add("details_mm", listed(options.details_mm), {"detail", false})
      .add("accuracies_mm", listed(options.accuracies_mm), {"accuracy", false})
      .add("doors", options.doors, {"doors", false})
      .add("station_area", options.station_area, {"station-area", false})
      .add("glass", options.glass, {"glass", false})
      .add("mirror", options.mirror, {"mirror", false})
      .add("scene_index", options.scene_index, {"scene-index", false})
      .add("default_diffuse", options.default_diffuse, {"diffuse", false})
      .add("unit", options.unit ? std::optional<std::string>(to_string(*options.unit)) : std::nullopt, {"unit", false})
      .add("up", options.up ? std::optional<std::string>(to_string(*options.up)) : std::nullopt, {"up", false})
      .add("wall_layers", options.wall_layers, {"wall-layer", false})
      .add("wall_height_m", options.wall_height_m, {"wall-height", false})
      .add("shared_meshes", to_string(options.shared_meshes), {"shared-meshes", false})
      .add("allow_outside", options.allow_outside, {options.allow_outside ? "allow-outside" : "", false})
      .take();
}

}  // namespace vantage
