// SPDX-License-Identifier: Apache-2.0
#include "core/read_json.hpp"

#include "core/read_file.hpp"
#include "vantage/error.hpp"

namespace vantage {

std::string setting_text(const nlohmann::json& value, const std::string& what) {
  if (value.is_string()) return value.get<std::string>();
  if (value.is_number() || value.is_boolean()) return value.dump();
  if (!value.is_array())
    throw Error(Errc::invalid_argument, what + ": " + value.dump() + " is no number, text, true, false or list");
  std::string joined;
  for (const auto& item : value) {
    if (item.is_structured()) throw Error(Errc::invalid_argument, what + ": " + value.dump() + " is nested too deeply");
    joined += (joined.empty() ? "" : ",") + setting_text(item, what);
  }
  return joined;
}

nlohmann::json read_json(const std::string& file) {
  const std::string text = read_file(file);
  // Readers walk the document by recursion.
  constexpr int kDeepest = 64;
  const auto shallow = [&](int depth, nlohmann::json::parse_event_t, const nlohmann::json&) {
    if (depth > kDeepest) throw Error(Errc::malformed_file, file + ": is nested too deeply");
    return true;
  };
  try {
    auto value = nlohmann::json::parse(text, shallow);
    if (value.is_object()) return value;
  } catch (const nlohmann::json::exception& error) {
    throw Error(Errc::malformed_file, file + ": is not JSON: " + error.what());
  }
  throw Error(Errc::malformed_file, file + ": must hold a JSON object");
}

}  // namespace vantage
