// SPDX-License-Identifier: Apache-2.0
// Columns of coordinates in the lines of a text, and the style of their numbers.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace vantage::importer {

// Style of numbers. Thousands may be separated by the other of point and comma, an apostrophe or a blank.
struct NumberStyle {
  char decimal = '.';
  bool thousands = false;

  // Returns the value of a word; empty if it is no number of this style.
  std::optional<double> value(std::string_view word) const;
};

struct TextColumns {
  std::array<std::size_t, 3> place{0, 1, 2};  // of x, y and z among the words of a line
  char between = 0;                           // separator of words; 0: blanks, commas or semicolons, any number of them
  NumberStyle numbers = {};
  double metres = 0;      // in a unit, if a column's title tells it; else 0
  std::string note = {};  // what was recognised, if it is unusual

  bool usual() const {
    return place == std::array<std::size_t, 3>{0, 1, 2} && between == 0 && numbers.decimal == '.' && !numbers.thousands;
  }
  // Splits a line.
  void split(std::string_view line, std::vector<std::string_view>& words) const;
};

// Recognises columns by the first lines of a text, without empty ones. `told`: the words x, y, z, and - for other
// columns, separated by commas; if it is empty, titles and values decide. Throws Refused, with a question that shows
// three lines, if they are not clear.
TextColumns columns_of(std::span<const std::string> lines, const std::string& told);

}  // namespace vantage::importer
