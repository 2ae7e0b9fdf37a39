// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace vantage::floor_plan {

// Text of a DXF as UTF-8 on one line: escapes and MTEXT's formatting are resolved. `code_page` is $DWGCODEPAGE, such as
// ANSI_1252, for text that is not UTF-8.
std::string plain_text(const std::string& text, const std::string& code_page);

// A name of a layer or block as UTF-8.
std::string plain_name(const std::string& name, const std::string& code_page);

// What a text in a room says about it.
struct Label {
  enum Kind { name, number, nothing } kind = nothing;  // nothing: an area, a length, a level
};
Label::Kind label_of(const std::string& text);

// Which way a text at a stair says that it leads from there, such as UP or DN 16R: 1 up, -1 down, 0 if it is another
// text.
int stair_way(const std::string& text);

}  // namespace vantage::floor_plan
