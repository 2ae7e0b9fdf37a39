// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "core/utf8.hpp"

namespace vantage {

// Escapes text as content of an XML 1.0 element. XML has no control characters, which are left out, and neither U+FFFE
// nor U+FFFF nor what is no UTF-8, which become U+FFFD.
inline std::string xml_text(std::string_view text) {
  constexpr const char* kReplacement = "\xEF\xBF\xBD";
  std::string escaped;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t size = utf8_character(text, at);
    const std::string_view one = text.substr(at, size > 0 ? size : 1);
    at += one.size();
    if (size == 0 || one == "\xEF\xBF\xBE" || one == "\xEF\xBF\xBF")
      escaped += kReplacement;
    else if (one == "&")
      escaped += "&amp;";
    else if (one == "<")
      escaped += "&lt;";
    else if (one == ">")
      escaped += "&gt;";
    else if (static_cast<unsigned char>(one.front()) >= 0x20)
      escaped += one;
  }
  return escaped;
}

}  // namespace vantage
