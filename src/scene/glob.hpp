// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace vantage {

// Shell glob over a whole string: `*` any run of characters, `?` exactly one byte. Case-sensitive.
bool glob_matches(std::string_view pattern, std::string_view text);

}  // namespace vantage
