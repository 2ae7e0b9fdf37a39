// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <utility>

#include "vantage/settings.hpp"

namespace vantage {

// Settings by their names.
inline nlohmann::ordered_json settings_json(const Settings& settings) {
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  for (const Setting& setting : settings) json[setting.name] = nlohmann::ordered_json::parse(setting.json);
  return json;
}

// Settings as options, so that they can be given to --config again.
inline nlohmann::json options_json(const Settings& settings) {
  nlohmann::json options = nlohmann::json::object();
  for (std::size_t k = 0; k < settings.size(); ++k) {
    const auto same = [&](std::size_t other) {
      return other < settings.size() && settings[other].option == settings[k].option;
    };
    if (settings[k].option.empty()) continue;
    auto value = nlohmann::json::parse(settings[k].json);
    if (value.is_null()) continue;
    if ((k > 0 && same(k - 1)) || same(k + 1))
      options[settings[k].option].push_back(std::move(value));
    else
      options[settings[k].option] = std::move(value);
  }
  return options;
}

}  // namespace vantage
