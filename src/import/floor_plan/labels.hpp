// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace vantage::floor_plan {

// Returns text of a DXF as UTF-8 on one line, without escapes and MTEXT's formatting. `code_page` is $DWGCODEPAGE, such
// as ANSI_1252, for text that is not UTF-8.
std::string plain_text(const std::string& text, const std::string& code_page);

// Returns a name of a layer or block as UTF-8.
std::string plain_name(const std::string& name, const std::string& code_page);

// Meaning of a text in a room.
struct Label {
  enum Kind { name, number, nothing } kind = nothing;  // nothing: an area, a length, a level
};
Label::Kind label_of(const std::string& text);

// Returns the direction in which a text at a stair leads from there, such as UP or DN 16R: 1 up, -1 down, 0 for any
// other text.
int stair_way(const std::string& text);

}  // namespace vantage::floor_plan
