// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace vantage {

// Returns the JSON object in a file. Throws Error: io, malformed_file.
nlohmann::json read_json(const std::string& file);

// Returns the text of a setting's value in JSON: a number, a text, true or false, or a comma-separated list of them.
// Messages begin with `what`. Throws Error invalid_argument for other values.
std::string setting_text(const nlohmann::json& value, const std::string& what);

}  // namespace vantage
