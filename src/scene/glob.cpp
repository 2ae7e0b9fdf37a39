// SPDX-License-Identifier: Apache-2.0
#include "scene/glob.hpp"

namespace vantage {

bool glob_matches(std::string_view pattern, std::string_view text) {
  // On a mismatch only the last star must take one more character, so the cost is at most |pattern| · |text|.
  std::size_t p = 0, t = 0, star = std::string_view::npos, star_text = 0;
  while (t < text.size()) {
    if (p < pattern.size() && pattern[p] == '*') {
      star = p++;
      star_text = t;
    } else if (p < pattern.size() && (pattern[p] == '?' || pattern[p] == text[t])) {
      ++p;
      ++t;
    } else if (star != std::string_view::npos) {
      p = star + 1;
      t = ++star_text;
    } else {
      return false;
    }
  }
  while (p < pattern.size() && pattern[p] == '*') ++p;
  return p == pattern.size();
}

}  // namespace vantage
