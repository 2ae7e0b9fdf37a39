// SPDX-License-Identifier: Apache-2.0
// Numbers as text that reads back to the same bits, in any locale.
#pragma once

#include <charconv>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <string>

namespace vantage {

inline std::string number(double value) {
  char buffer[32];
  return {buffer, std::to_chars(buffer, buffer + sizeof buffer, value).ptr};
}
inline std::string number(std::integral auto value) { return std::to_string(value); }

// Writes `digits` digits after the point, for people.
inline std::string fixed(double value, int digits) {
  char buffer[400];
  return {buffer, std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::fixed, digits).ptr};
}

// "1 234 567", for people.
inline std::string grouped(std::uint64_t value) {
  std::string text = std::to_string(value);
  for (std::size_t at = text.size(); at > 3;) text.insert(at -= 3, "\u2009");  // a thin space
  return text;
}

// Returns minutes after midnight as "08:05", also those of a later day.
inline std::string clock_text(double minutes) {
  constexpr std::int64_t kDay_min = 24 * 60;
  const std::int64_t whole = std::llround(minutes), of_day = (whole % kDay_min + kDay_min) % kDay_min;
  const std::string hours = std::to_string(of_day / 60), rest = std::to_string(of_day % 60);
  return (hours.size() < 2 ? "0" : "") + hours + ":" + (rest.size() < 2 ? "0" : "") + rest;
}

// Converts only ASCII letters.
inline std::string lower_case(std::string text) {
  for (char& c : text)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return text;
}

// Returns "85.3 %" for a share of 0.853.
inline std::string percent(double share) { return fixed(100 * share, 1) + " %"; }

}  // namespace vantage
