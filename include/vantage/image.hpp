// SPDX-License-Identifier: Apache-2.0
/// Images in memory and in files.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

namespace vantage {

/// An image in sRGB with 8 bits a channel, row by row from the top.
struct Image {
  std::uint32_t width = 0, height = 0;  ///< Pixels.
  std::vector<std::uint8_t> rgba;       ///< Red, green, blue, alpha: 4 · width · height bytes.
};

/// Reads a PNG or JPEG. Throws Error: io, malformed_file.
Image read_image(const std::filesystem::path& file);
/// Writes a PNG, whole or not at all. Throws Error: io, invalid_argument (pixels missing).
void write_png(const std::filesystem::path& file, const Image& image);

}  // namespace vantage
