// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace vantage {

// The JSON object in a file. Throws Error: io, malformed_file.
nlohmann::json read_json(const std::string& file);

// The text of a setting's value that is written in JSON: a number, a text, true or false, or a list of them with commas
// between. `what` opens the message. Throws Error invalid_argument for anything else.
std::string setting_text(const nlohmann::json& value, const std::string& what);

}  // namespace vantage
