// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "vantage/image.hpp"

namespace vantage {

// Decodes a PNG or JPEG to RGBA8. Returns an empty image and says why in `problem` where that fails.
Image decode_image(std::span<const std::uint8_t> bytes, std::string& problem);
// The same of a JPEG of at most so many pixels a side, by libjpeg-turbo, which withstands damaged ones.
Image decode_jpeg(std::span<const std::uint8_t> bytes, std::uint32_t largest_side, std::string& problem);

}  // namespace vantage
