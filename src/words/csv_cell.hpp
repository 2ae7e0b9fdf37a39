// SPDX-License-Identifier: Apache-2.0
// Text in cells of CSV files (RFC 4180). A spreadsheet runs a cell that begins with =, +, - or @ as a formula, and
// names come from other people's scenes. A leading apostrophe makes it text; our own reader removes it.
#pragma once

#include <string>

namespace vantage {

// True if a spreadsheet would run the text as a formula once its leading apostrophes are gone.
inline bool is_formula(const std::string& text) {
  const std::size_t at = text.find_first_not_of('\'');
  return at != std::string::npos && std::string("=+-@\t\r").find(text[at]) != std::string::npos;
}

inline std::string csv_cell(const std::string& text) {
  const std::string plain = is_formula(text) ? "'" + text : text;
  if (plain.find_first_of(",;\"\n\r\t") == std::string::npos) return plain;
  std::string cell = "\"";
  for (const char c : plain) cell += c == '"' ? std::string("\"\"") : std::string(1, c);
  return cell + "\"";
}

// Inverse: the original text of a cell without its quotes.
inline std::string text_of_csv_cell(const std::string& cell) {
  return cell.starts_with('\'') && is_formula(cell) ? cell.substr(1) : cell;
}

}  // namespace vantage
