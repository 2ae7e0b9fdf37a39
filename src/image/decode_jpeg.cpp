// SPDX-License-Identifier: Apache-2.0
#include <turbojpeg.h>

#include <memory>

#include "image/decode.hpp"

namespace vantage {

namespace {

using Decoder = std::unique_ptr<void, int (*)(tjhandle)>;

}  // namespace

ImageHeader read_jpeg_header(std::span<const std::uint8_t> bytes, std::uint32_t largest_side) {
  const Decoder decoder(tjInitDecompress(), tjDestroy);
  int width = 0, height = 0, subsampling = 0, colours = 0;
  if (!decoder || tjDecompressHeader3(decoder.get(), bytes.data(), static_cast<unsigned long>(bytes.size()), &width,
                                      &height, &subsampling, &colours) != 0)
    return {};
  const ImageHeader header{static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height), 0};
  if (header.width > largest_side || header.height > largest_side) return {};
  // Four bytes per pixel; in a progressive image, also two bytes for each coefficient of up to four colours.
  return {header.width, header.height, std::uint64_t{12} * header.width * header.height};
}

Image decode_jpeg(std::span<const std::uint8_t> bytes, std::uint32_t largest_side, std::string& problem) {
  const Decoder decoder(tjInitDecompress(), tjDestroy);
  if (!decoder) {
    problem = "there is not enough memory to decode it";
    return {};
  }
  const auto size = static_cast<unsigned long>(bytes.size());
  int width = 0, height = 0, subsampling = 0, colours = 0;
  // Before there is a picture, even a warning means damage.
  if (tjDecompressHeader3(decoder.get(), bytes.data(), size, &width, &height, &subsampling, &colours) != 0) {
    problem = tjGetErrorStr2(decoder.get());
    return {};
  }
  const auto fits = [&](int side) { return side > 0 && static_cast<std::uint32_t>(side) <= largest_side; };
  if (!fits(width) || !fits(height)) {
    problem = "it is " + std::to_string(width) + " × " + std::to_string(height) + " pixels, and at most " +
              std::to_string(largest_side) + " a side are read";
    return {};
  }
  Image image{static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height), {}};
  image.rgba.resize(std::size_t{4} * image.width * image.height);
  // Sets alpha to 255. Scans are limited, since a small file with thousands of them would take minutes.
  if (tjDecompress2(decoder.get(), bytes.data(), size, image.rgba.data(), width, 0, height, TJPF_RGBA,
                    TJFLAG_LIMITSCANS) != 0) {
    problem = tjGetErrorStr2(decoder.get());
    return {};
  }
  return image;
}

}  // namespace vantage
