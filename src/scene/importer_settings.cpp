// SPDX-License-Identifier: Apache-2.0
#include "scene/importer_settings.hpp"

#include <nlohmann/json.hpp>

#include "vantage/error.hpp"

namespace vantage {

bool takes_setting(const importers::Format& format, const std::string& name) {
  return (std::string(" ") + format.settings + " ").find(" " + name + " ") != std::string::npos;
}

std::vector<std::string> importer_settings(const SceneOptions& options, const importers::Format& format,
                                           const std::string& name) {
  std::vector<std::string> words;
  const auto add = [&](const std::string& setting, const std::string& value) {
    if (!takes_setting(format, setting))
      throw Error(Errc::invalid_argument,
                  name + ": the setting " + setting + " is for floor plans, and this is " + format.name);
    words.push_back(setting + "=" + value);
  };
  if (options.unit && takes_setting(format, "unit")) words.push_back(std::string("unit=") + to_string(*options.unit));
  if (options.up && takes_setting(format, "up")) words.push_back(std::string("up=") + to_string(*options.up));
  for (const std::string& layer : options.wall_layers) add("wall-layer", layer);
  if (options.wall_height_m) {
    if (!(*options.wall_height_m > 0 && *options.wall_height_m <= 1000))
      throw Error(Errc::invalid_argument, "wall_height_m must be above 0 and at most 1000; " +
                                              nlohmann::json(*options.wall_height_m).dump() + " was given");
    add("wall-height", nlohmann::json(*options.wall_height_m).dump());
  }
  return words;
}

}  // namespace vantage
