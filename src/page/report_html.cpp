// SPDX-License-Identifier: Apache-2.0
#include <string_view>

#include "core/atomic_file.hpp"
#include "page/page_files.hpp"
#include "page/report_json.hpp"

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

void write_report_html(const std::filesystem::path& file, const Report& report, const ReportSite& site,
                       const Progress& progress) {
  nlohmann::ordered_json json = report_json(report);
  json["view"] = view_json(report, site, progress);
  std::string page = page_report_html;
  put(page, "{{title}}", within_html(report.title));
  put(page, "{{style}}", page_report_css);
  std::string scripts;
  for (const char* script :
       {page_three, page_orbit, page_unpack, page_site_view, page_chart, page_tables, page_report_js})
    scripts += std::string("<script>") + script + "</script>\n";
  put(page, "{{scripts}}", scripts);
  put(page, "{{report}}", within_script(json));
  write_atomically(file, page);
}

}  // namespace vantage
