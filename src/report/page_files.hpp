// SPDX-License-Identifier: Apache-2.0
// Files that pages are made of, embedded when vantage is built.
#pragma once

namespace vantage {

extern const char* const page_three;  // three.js and its orbit controls, as packaged
extern const char* const page_orbit;
extern const char* const page_report_html;
extern const char* const page_report_css;
extern const char* const page_unpack;
extern const char* const page_site_view;
extern const char* const page_chart;
extern const char* const page_tables;
extern const char* const page_report_js;

}  // namespace vantage
