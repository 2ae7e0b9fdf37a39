// SPDX-License-Identifier: Apache-2.0
// Where the lines of a text have coordinates, and how their numbers are written.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace vantage::importer {

// How numbers are written. Thousands may be set apart by the other of point and comma, an apostrophe or a blank.
struct NumberStyle {
  char decimal = '.';
  bool thousands = false;

  // The value of a word; empty if it is no number of this style.
  std::optional<double> value(std::string_view word) const;
};

struct TextColumns {
  std::array<std::size_t, 3> place{0, 1, 2};  // of x, y and z among the words of a line
  char between = 0;                           // words; 0: blanks, commas or semicolons, any number of them
  NumberStyle numbers = {};
  double metres = 0;      // in a unit, if the title of a column tells it; else 0
  std::string note = {};  // what was recognised, if it is not the usual

  bool usual() const {
    return place == std::array<std::size_t, 3>{0, 1, 2} && between == 0 && numbers.decimal == '.' && !numbers.thousands;
  }
  // Splits a line.
  void split(std::string_view line, std::vector<std::string_view>& words) const;
};

// By the first lines of a text, without empty ones. `told`: words x, y, z, and - for other columns, with commas
// between; empty: recognised by titles and values. Throws Refused, with a question that shows three lines, if it is not
// clear.
TextColumns columns_of(std::span<const std::string> lines, const std::string& told);

}  // namespace vantage::importer
