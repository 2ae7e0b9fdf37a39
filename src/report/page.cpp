// SPDX-License-Identifier: Apache-2.0
#include "report/page.hpp"

#include <string_view>

namespace vantage {
namespace {

// As the content of a script element: nothing in it ends that, or begins a comment.
std::string within_script(const nlohmann::ordered_json& json) {
  std::string text;
  for (const char c : json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace))
    text += c == '<' ? std::string("\\u003c") : std::string(1, c);
  return text;
}

std::string within_html(std::string_view text) {
  std::string html;
  for (const char c : text)
    html += c == '&' ? std::string("&amp;") : c == '<' ? std::string("&lt;") : std::string(1, c);
  return html;
}

void put(std::string& page, std::string_view mark, const std::string& text) {
  page.replace(page.find(mark), mark.size(), text);
}

}  // namespace

std::string make_page(const char* html, std::span<const char* const> styles, std::span<const char* const> scripts,
                      const std::string& title, const nlohmann::ordered_json& data) {
  std::string page = html, style, script;
  for (const char* text : styles) style += text;
  for (const char* text : scripts) script += std::string("<script>") + text + "</script>\n";
  put(page, "{{title}}", within_html(title));
  put(page, "{{style}}", style);
  put(page, "{{scripts}}", script);
  put(page, "{{data}}", within_script(data));
  return page;
}

}  // namespace vantage
