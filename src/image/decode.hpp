// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "vantage/image.hpp"

namespace vantage {

// What the header of a PNG or JPEG says, and what decoding it takes at most, the pixels included; all 0 where it is
// neither, or larger than any that is read.
struct ImageHeader {
  std::uint32_t width = 0, height = 0;
  std::uint64_t decoding_bytes = 0;
};
ImageHeader read_image_header(std::span<const std::uint8_t> bytes);

// Decodes a PNG or JPEG to RGBA8. Returns an empty image and says why in `problem` where that fails.
Image decode_image(std::span<const std::uint8_t> bytes, std::string& problem);
// The same of JPEGs of at most so many pixels a side, by libjpeg-turbo, which withstands damaged ones.
ImageHeader read_jpeg_header(std::span<const std::uint8_t> bytes, std::uint32_t largest_side);
Image decode_jpeg(std::span<const std::uint8_t> bytes, std::uint32_t largest_side, std::string& problem);

}  // namespace vantage
