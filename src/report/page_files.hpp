// SPDX-License-Identifier: Apache-2.0
// Files of the pages, embedded when vantage is built.
#pragma once

namespace vantage {

struct PageText {
  const char* text;
  const char* sha256;  // of the text, 64 hexadecimal digits
};

extern const PageText page_three;  // three.js and its orbit controls, as packaged
extern const PageText page_orbit;
extern const PageText page_report_html;
extern const PageText page_report_css;
extern const PageText page_unpack;
extern const PageText page_site_view;
extern const PageText page_chart;
extern const PageText page_tables;
extern const PageText page_report_js;

}  // namespace vantage
