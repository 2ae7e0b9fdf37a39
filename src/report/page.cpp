// SPDX-License-Identifier: Apache-2.0
#include "report/page.hpp"

#include <algorithm>
#include <cstdint>
#include <map>
#include <string_view>
#include <vector>

#include "core/json_text.hpp"
#include "report/packed.hpp"

namespace vantage {
namespace {

// JSON as content of a script element: nothing in it ends the element or begins a comment.
std::string within_script(const nlohmann::ordered_json& json) {
  std::string text;
  for (const char c : json_text(json)) text += c == '<' ? std::string("\\u003c") : std::string(1, c);
  return text;
}

std::string within_html(std::string_view text) {
  std::string html;
  for (const char c : text)
    html += c == '&' ? std::string("&amp;") : c == '<' ? std::string("&lt;") : std::string(1, c);
  return html;
}

// "'sha256-…'", in base64.
std::string hash_source(const PageText& part) {
  std::vector<std::uint8_t> bytes;
  const std::string_view digits = part.sha256;
  for (std::size_t k = 0; k + 1 < digits.size(); k += 2)
    bytes.push_back(static_cast<std::uint8_t>(std::stoul(std::string(digits.substr(k, 2)), nullptr, 16)));
  return "'sha256-" + base64(bytes) + "'";
}

}  // namespace

std::string page_policy(std::span<const PageText> styles, std::span<const PageText> scripts) {
  std::string policy = "default-src 'none'; script-src";
  for (const PageText& part : scripts) policy += " " + hash_source(part);
  policy += "; style-src";
  for (const PageText& part : styles) policy += " " + hash_source(part);
  return policy + "; img-src data: blob:; base-uri 'none'; form-action 'none'";
}

std::string make_page(const PageText& html, std::span<const PageText> styles, std::span<const PageText> scripts,
                      const std::string& title, const nlohmann::ordered_json& data) {
  std::map<std::string_view, std::string> parts{
      {"title", within_html(title)}, {"policy", page_policy(styles, scripts)}, {"data", within_script(data)}};
  for (const PageText& part : styles) parts["styles"] += std::string("<style>") + part.text + "</style>\n";
  for (const PageText& part : scripts) parts["scripts"] += std::string("<script>") + part.text + "</script>\n";
  // Replaces marks of the markup only, since inserted parts may contain some, too.
  std::string page;
  for (std::string_view rest = html.text; !rest.empty();) {
    const std::size_t begin = std::min(rest.find("{{"), rest.size()), end = rest.find("}}", begin);
    page += rest.substr(0, begin);
    if (end == std::string_view::npos) break;
    page += parts.at(rest.substr(begin + 2, end - begin - 2));
    rest.remove_prefix(end + 2);
  }
  return page;
}

}  // namespace vantage
