// SPDX-License-Identifier: Apache-2.0
// Makes a page from its parts: markup with placeholders, style, scripts and data.
#pragma once

#include <nlohmann/json.hpp>
#include <span>
#include <string>

#include "report/page_files.hpp"

namespace vantage {

// Content security policy of a page: only these parts run. Nothing is loaded, sent or submitted.
std::string page_policy(std::span<const PageText> styles, std::span<const PageText> scripts);

// `html` has some of {{title}}, {{policy}}, {{styles}}, {{scripts}} and {{data}}. Nothing in title or data ends its
// element.
std::string make_page(const PageText& html, std::span<const PageText> styles, std::span<const PageText> scripts,
                      const std::string& title, const nlohmann::ordered_json& data);

}  // namespace vantage
