// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "import/cloud/byte_file.hpp"
#include "import/program.hpp"

namespace vantage::importer {

// A number of a binary record, as in PLY and PCD.
struct ScalarField {
  std::string name;
  char kind = 'F';  // F: floating point, I: signed, U: unsigned
  std::size_t bytes = 4, at = 0;

  double value(const char* record, bool big_endian) const { return read(record + at, big_endian); }

  double read(const char* from, bool big_endian) const {
    if (kind == 'F') return bytes == 4 ? number<float>(from, big_endian) : number<double>(from, big_endian);
    switch (bytes) {
      case 1: return kind == 'I' ? number<std::int8_t>(from, big_endian) : number<std::uint8_t>(from, big_endian);
      case 2: return kind == 'I' ? number<std::int16_t>(from, big_endian) : number<std::uint16_t>(from, big_endian);
      case 4: return kind == 'I' ? number<std::int32_t>(from, big_endian) : number<std::uint32_t>(from, big_endian);
      default: return kind == 'I' ? number<std::int64_t>(from, big_endian) : number<std::uint64_t>(from, big_endian);
    }
  }

 private:
  template <class T>
  static double number(const char* from, bool big_endian) {
    return static_cast<double>(value_at<T>(from, big_endian));
  }
};

// Returns the place of the field of this lower-case name, ignoring the file's case; fields.size() if there is none.
inline std::size_t find_field(std::span<const ScalarField> fields, std::string_view name) {
  const auto lower = [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; };
  const auto same = [&](const ScalarField& field) { return std::ranges::equal(field.name, name, {}, lower); };
  return static_cast<std::size_t>(std::ranges::find_if(fields, same) - fields.begin());
}

// Returns the places of three fields; empty unless all are there.
inline std::vector<std::size_t> find_fields(std::span<const ScalarField> fields,
                                            const std::array<std::string_view, 3>& names) {
  std::vector<std::size_t> places;
  for (const std::string_view name : names) {
    places.push_back(find_field(fields, name));
    if (places.back() == fields.size()) return {};
  }
  return places;
}

inline bool are_floats(std::span<const ScalarField> fields, std::span<const std::size_t> places) {
  return std::ranges::all_of(places, [&](std::size_t k) { return fields[k].kind == 'F' && fields[k].bytes == 4; });
}

// Removes the next word from a line and returns it; empty at the end.
inline std::string_view next_word(std::string_view& line) {
  constexpr std::string_view kBetween = " \t,;";
  const auto first = line.find_first_not_of(kBetween);
  if (first == std::string_view::npos) return line = {};
  line.remove_prefix(first);
  const std::string_view word = line.substr(0, line.find_first_of(kBetween));
  line.remove_prefix(word.size());
  return word;
}

// Parses a whole number of a header. Throws Refused.
inline std::uint64_t count_of(std::string_view word, const std::string& what) {
  std::uint64_t value = 0;
  const auto [end, failure] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (failure != std::errc() || end != word.data() + word.size())
    throw Refused("its header has \"" + std::string(word.substr(0, 40)) + "\" for " + what + "; export it again");
  return value;
}

}  // namespace vantage::importer
