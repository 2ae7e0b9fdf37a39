// SPDX-License-Identifier: Apache-2.0
#include "core/closest_name.hpp"

#include <algorithm>
#include <vector>

namespace vantage {
namespace {

std::string plain(std::string_view text) {
  std::string letters;
  for (const char c : text) letters += c == '-' ? '_' : c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return letters;
}

}  // namespace

std::size_t edit_distance(std::string_view first, std::string_view second) {
  const std::string a = plain(first), b = plain(second);
  // rows i − 2, i − 1 and i of the distances between the first i and the first j letters
  std::vector<std::size_t> before(b.size() + 1), above(b.size() + 1), row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    before.swap(above);
    above.swap(row);
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      row[j] = std::min({above[j] + 1, row[j - 1] + 1, above[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1)});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) row[j] = std::min(row[j], before[j - 2] + 1);
    }
  }
  return row[b.size()];
}

std::string closest_name(std::string_view typed, std::span<const std::string> names) {
  const std::string wanted = plain(typed);
  std::string nearest;
  double least = 1;  // as a share of the largest distance that counts as near
  for (const std::string& name : names) {
    const std::string known = plain(name);
    const auto longer = std::max(wanted.size(), known.size());
    double distance =
        static_cast<double>(edit_distance(wanted, known)) / std::max(1.0, static_cast<double>(longer / 3));
    // half of a name is no misspelling: it ranks after a slip and before a name that is two thirds right
    constexpr double kHalf = 0.6;
    if (wanted.size() >= 3 && (known.starts_with(wanted) || known.ends_with(wanted)))
      distance = std::min(distance, kHalf);
    if (distance < least || (distance == least && nearest.empty())) nearest = name, least = distance;
  }
  return nearest;
}

std::string did_you_mean(std::string_view typed, std::span<const std::string> names) {
  const std::string name = closest_name(typed, names);
  return name.empty() ? "" : "; did you mean " + name + "?";
}

std::string names_there_are(std::string_view pattern, std::span<const std::string> names) {
  constexpr std::size_t kMostNames = 8;
  std::string letters(pattern);
  std::erase_if(letters, [](char c) { return c == '*' || c == '?' || c == '!' || c == '|'; });
  if (std::string near = did_you_mean(letters, names); !near.empty()) return near;
  std::string what = "; there are ";
  for (std::size_t k = 0; k < std::min(names.size(), kMostNames); ++k) what += (k == 0 ? "" : ", ") + names[k];
  if (names.size() > kMostNames) what += " and " + std::to_string(names.size() - kMostNames) + " more";
  return what;
}

}  // namespace vantage
