// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "vantage/image.hpp"

namespace vantage {

// Size in the header of a PNG or JPEG, and an upper bound on the memory to decode it, including the pixels. All 0 if it
// is neither, or larger than the largest image that is read.
struct ImageHeader {
  std::uint32_t width = 0, height = 0;
  std::uint64_t decoding_bytes = 0;
};
ImageHeader read_image_header(std::span<const std::uint8_t> bytes);

// Decodes a PNG or JPEG to RGBA8. On failure, returns an empty image and gives the reason in `problem`.
Image decode_image(std::span<const std::uint8_t> bytes, std::string& problem);
// The same for JPEGs with sides of at most `largest_side`, by libjpeg-turbo, which withstands damaged files.
ImageHeader read_jpeg_header(std::span<const std::uint8_t> bytes, std::uint32_t largest_side);
Image decode_jpeg(std::span<const std::uint8_t> bytes, std::uint32_t largest_side, std::string& problem);

}  // namespace vantage
