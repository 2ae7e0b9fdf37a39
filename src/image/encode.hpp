// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "vantage/image.hpp"

namespace vantage {

// A JPEG, without alpha. `quality`: 1 to 100. Throws Error invalid_argument (pixels missing, a bad quality).
std::vector<std::uint8_t> encode_jpeg(const Image& image, int quality);

}  // namespace vantage
