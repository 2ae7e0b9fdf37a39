// SPDX-License-Identifier: Apache-2.0
// Texts of numbers, taken word by word.
#pragma once

#include <charconv>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "import/program.hpp"

namespace vantage::importer {

inline bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == '\f' || c == '\v'; }

inline std::string_view trimmed_text(std::string_view text) {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

// Returns the next word and removes it; empty at the end.
inline std::string_view take_word(std::string_view& text) {
  std::size_t begin = 0;
  while (begin < text.size() && is_blank(text[begin])) ++begin;
  std::size_t end = begin;
  while (end < text.size() && !is_blank(text[end])) ++end;
  const std::string_view word = text.substr(begin, end - begin);
  text.remove_prefix(end);
  return word;
}

// Removes the next line and its end, a line feed, a carriage return, or both; returns the line. REQUIRES: not empty.
inline std::string_view take_line(std::string_view& text) {
  const std::size_t end = std::min(text.find_first_of("\r\n"), text.size());
  const std::string_view line = text.substr(0, end);
  const bool both = text.substr(end).starts_with("\r\n");
  text.remove_prefix(std::min(end + (both ? 2 : 1), text.size()));
  return line;
}

// Parses a whole word as a number; empty if it is none. Also reads nan and inf, which some programs write.
template <class T>
std::optional<T> value_of(std::string_view word) {
  if (word.starts_with('+')) word.remove_prefix(1);
  T value{};
  const auto [end, failure] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (failure != std::errc() || end != word.data() + word.size()) return std::nullopt;
  return value;
}

// Parses a list of numbers between blanks or commas. Throws Refused, which names the list by `what`.
template <class T>
std::vector<T> values_of(std::string_view text, const std::string& what) {
  std::vector<T> values;
  const auto between = [](char c) { return is_blank(c) || c == ','; };
  for (std::size_t at = 0;;) {
    while (at < text.size() && between(text[at])) ++at;
    if (at == text.size()) return values;
    std::size_t end = at;
    while (end < text.size() && !between(text[end])) ++end;
    const auto value = value_of<T>(text.substr(at, end - at));
    if (!value)
      throw Refused(what + " holds \"" + std::string(text.substr(at, std::min<std::size_t>(end - at, 40))) +
                    "\" where a number belongs; export it again");
    values.push_back(*value);
    at = end;
  }
}

inline std::string read_whole(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::string bytes;
  std::error_code failure;
  bytes.resize(std::filesystem::file_size(file, failure));
  if (!stream || failure || !stream.read(bytes.data(), static_cast<std::streamsize>(bytes.size())))
    throw Refused("the model cannot be read");
  return bytes;
}

}  // namespace vantage::importer
