// SPDX-License-Identifier: Apache-2.0
// Makes the list of settings of a struct, one line per field.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/json_text.hpp"
#include "vantage/settings.hpp"
#include "vantage/station_setup.hpp"
#include "vantage/types.hpp"

namespace vantage {

class SettingList {
 public:
  struct Traits {
    std::string option = {};
    bool decides = true;
  };
  template <class Value>
  SettingList& add(std::string name, const Value& value, Traits traits) {
    list_.push_back({std::move(name), json_text(to_json(value)), std::move(traits.option), traits.decides});
    return *this;
  }
  template <class Value>
  SettingList& add(std::string name, const Value& value) {
    return add(std::move(name), value, Traits{});
  }
  Settings take() { return std::move(list_); }

 private:
  using Json = nlohmann::ordered_json;
  template <class Value>
  static Json to_json(const Value& value) {
    return value;
  }
  static Json to_json(const Angle& angle) { return angle.in_degrees(); }
  static Json to_json(const Vec3& v) { return {v.x, v.y, v.z}; }
  static Json to_json(const StationSetup& setup) {
    return {
        {"heading_deg", setup.heading.in_degrees()}, {"tilt_deg", setup.tilt.in_degrees()}, {"scanner", setup.scanner}};
  }
  template <class Value>
  static Json to_json(const std::optional<Value>& value) {
    return value ? to_json(*value) : Json();
  }
  template <class Value>
  static Json to_json(const std::vector<Value>& values) {
    Json array = Json::array();
    for (const Value& value : values) array.push_back(to_json(value));
    return array;
  }
  Settings list_;
};

}  // namespace vantage
