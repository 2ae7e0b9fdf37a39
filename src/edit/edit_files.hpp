// SPDX-License-Identifier: Apache-2.0
// Files that the editor's page is made of besides those of the report, embedded when vantage is built.
#pragma once

namespace vantage {

extern const char* const page_edit_html;
extern const char* const page_edit_css;
extern const char* const page_edit_js;

}  // namespace vantage
