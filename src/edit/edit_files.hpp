// SPDX-License-Identifier: Apache-2.0
// Files of the editor's page besides those of the report, embedded when vantage is built.
#pragma once

#include "report/page_files.hpp"

namespace vantage {

extern const PageText page_edit_html;
extern const PageText page_edit_css;
extern const PageText page_edit_js;

}  // namespace vantage
