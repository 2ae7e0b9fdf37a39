// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace vantage::importer {

// Decompresses LZF (Lehmann, liblzf, 2000). Throws Refused unless the result has just so many bytes.
std::string unpack_lzf(std::string_view packed, std::size_t bytes);

}  // namespace vantage::importer
