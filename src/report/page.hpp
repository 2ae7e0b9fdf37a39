// SPDX-License-Identifier: Apache-2.0
// A page of its parts: markup with places for the others, style, scripts and data.
#pragma once

#include <nlohmann/json.hpp>
#include <span>
#include <string>

#include "report/page_files.hpp"

namespace vantage {

// Content security policy of a page of these parts: they run, and nothing else does, wherever it came from. Nothing is
// loaded, sent or submitted.
std::string page_policy(std::span<const PageText> styles, std::span<const PageText> scripts);

// `html` holds {{title}}, {{policy}}, {{styles}}, {{scripts}} and {{data}}, or some of them. Nothing in title or data
// ends the element that it stands in.
std::string make_page(const PageText& html, std::span<const PageText> styles, std::span<const PageText> scripts,
                      const std::string& title, const nlohmann::ordered_json& data);

}  // namespace vantage
