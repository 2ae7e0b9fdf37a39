// SPDX-License-Identifier: Apache-2.0
// A page of its parts: markup with places for the others, style, scripts and data.
#pragma once

#include <nlohmann/json.hpp>
#include <span>
#include <string>

namespace vantage {

// `html` holds {{title}}, {{style}}, {{scripts}} and {{data}}. Nothing in title or data ends the element it stands in.
std::string make_page(const char* html, std::span<const char* const> styles, std::span<const char* const> scripts,
                      const std::string& title, const nlohmann::ordered_json& data);

}  // namespace vantage
