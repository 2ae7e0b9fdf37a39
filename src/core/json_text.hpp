// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace vantage {

// Returns JSON as text. Bytes that are no UTF-8 become U+FFFD, as names may come from anywhere. `indent` -1: one line.
template <class Json>
std::string json_text(const Json& document, int indent = -1) {
  return document.dump(indent, ' ', false, Json::error_handler_t::replace);
}

}  // namespace vantage
