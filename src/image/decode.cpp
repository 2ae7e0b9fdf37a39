// SPDX-License-Identifier: Apache-2.0
#include "image/decode.hpp"

#include <png.h>

namespace vantage {
namespace {

constexpr std::uint32_t kLargestSide = 16384;  // 1 GiB of pixels: more is a broken header

bool is_jpeg(std::span<const std::uint8_t> bytes) { return bytes.size() >= 2 && bytes[0] == 0xff && bytes[1] == 0xd8; }

// A PNG whose header libpng has read.
class Png {
 public:
  explicit Png(std::span<const std::uint8_t> bytes) {
    image_.version = PNG_IMAGE_VERSION;
    read_ = png_image_begin_read_from_memory(&image_, bytes.data(), bytes.size()) != 0;
    image_.flags |= PNG_IMAGE_FLAG_16BIT_sRGB;  // 16 bits a channel are sRGB, as 8 bits are
  }
  Png(const Png&) = delete;
  Png& operator=(const Png&) = delete;
  ~Png() { png_image_free(&image_); }

  bool fits() const { return read_ && image_.width <= kLargestSide && image_.height <= kLargestSide; }
  std::uint32_t width() const { return image_.width; }
  std::uint32_t height() const { return image_.height; }
  std::string problem() const {
    if (!read_) return image_.message;
    return "it is " + std::to_string(image_.width) + " × " + std::to_string(image_.height) + " pixels, and at most " +
           std::to_string(kLargestSide) + " a side are read";
  }
  // Empty if the data is damaged; `problem` says how.
  Image pixels(std::string& problem) {
    image_.format = PNG_FORMAT_RGBA;
    Image image{image_.width, image_.height, std::vector<std::uint8_t>(PNG_IMAGE_SIZE(image_))};
    if (png_image_finish_read(&image_, nullptr, image.rgba.data(), 0, nullptr)) return image;
    problem = image_.message;
    return {};
  }

 private:
  png_image image_{};
  bool read_ = false;
};

}  // namespace

ImageHeader read_image_header(std::span<const std::uint8_t> bytes) {
  if (is_jpeg(bytes)) return read_jpeg_header(bytes, kLargestSide);
  const Png png(bytes);
  if (!png.fits()) return {};
  // The pixels, some rows, and what libpng allows itself for a chunk and zlib for its window.
  constexpr std::uint64_t kRowBytes = 4 * 8, kOtherBytes = PNG_USER_CHUNK_MALLOC_MAX + (std::uint64_t{1} << 18);
  return {png.width(), png.height(),
          std::uint64_t{4} * png.width() * png.height() + kRowBytes * png.width() + kOtherBytes};
}

Image decode_image(std::span<const std::uint8_t> bytes, std::string& problem) {
  if (is_jpeg(bytes)) return decode_jpeg(bytes, kLargestSide, problem);
  Png png(bytes);
  if (png.fits()) return png.pixels(problem);
  problem = png.problem();
  return {};
}

}  // namespace vantage
