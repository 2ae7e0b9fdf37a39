// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "vantage/image.hpp"

namespace vantage {

// Decodes a PNG or JPEG to RGBA8. Returns an empty image and says why in `problem` where that fails.
Image decode_image(std::span<const std::uint8_t> bytes, std::string& problem);

}  // namespace vantage
