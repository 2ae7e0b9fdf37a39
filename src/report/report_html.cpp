// SPDX-License-Identifier: Apache-2.0
#include <array>

#include "core/atomic_file.hpp"
#include "report/page.hpp"
#include "report/page_files.hpp"
#include "report/report_json.hpp"

namespace vantage {

bool write_report_html(const std::filesystem::path& file, const Report& report, Site& site, const Progress& progress) {
  nlohmann::ordered_json json = report_json(report);
  json["view"] = view_json(report, site, progress);
  if (progress.stop.stop_requested()) return false;
  const std::array scripts{page_three, page_orbit,  page_unpack,   page_site_view,
                           page_chart, page_tables, page_report_js};
  write_atomically(file, make_page(page_report_html, {&page_report_css, 1}, scripts, report.options.title, json));
  return true;
}

}  // namespace vantage
