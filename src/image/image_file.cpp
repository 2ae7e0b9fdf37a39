// SPDX-License-Identifier: Apache-2.0
#include <png.h>
#include <turbojpeg.h>

#include <memory>

#include "core/atomic_file.hpp"
#include "core/free_memory.hpp"
#include "core/read_file.hpp"
#include "image/decode.hpp"
#include "image/encode.hpp"
#include "vantage/error.hpp"
#include "vantage/image.hpp"

namespace vantage {

Image read_image(const std::filesystem::path& file) {
  const std::string bytes = read_file(file);
  const std::span content{reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()};
  const ImageHeader header = read_image_header(content);
  if (header.decoding_bytes > memory_limit(0))
    throw Error(Errc::out_of_memory, file.string() + ": decoding its " + std::to_string(header.width) + " × " +
                                         std::to_string(header.height) + " pixels would take about " +
                                         bytes_text(header.decoding_bytes) + " of memory; half of what is free is " +
                                         bytes_text(memory_limit(0)) + ". Make the picture smaller");
  std::string problem;
  Image image = decode_image(content, problem);
  if (image.rgba.empty())
    throw Error(Errc::malformed_file, file.string() + " is no PNG or JPEG that can be read: " + problem);
  return image;
}

namespace {

void require_pixels(const Image& image, const std::string& what) {
  const std::size_t size = std::size_t{4} * image.width * image.height;
  if (size > 0 && image.rgba.size() == size) return;
  throw Error(Errc::invalid_argument, what + ": an image of " + std::to_string(image.width) + " × " +
                                          std::to_string(image.height) + " pixels must have " + std::to_string(size) +
                                          " bytes and at least one pixel; it has " + std::to_string(image.rgba.size()));
}

}  // namespace

void write_png(const std::filesystem::path& file, const Image& image) {
  require_pixels(image, "cannot write " + file.string());
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  png.width = image.width, png.height = image.height;
  png.format = PNG_FORMAT_RGBA;
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(png);
  std::vector<std::uint8_t> bytes(size);
  if (!png_image_write_to_memory(&png, bytes.data(), &size, 0, image.rgba.data(), 0, nullptr))
    throw Error(Errc::invalid_argument, "cannot write " + file.string() + ": " + png.message);
  AtomicFile out(file);
  out.write(bytes.data(), size);
  out.commit();
}

std::vector<std::uint8_t> encode_jpeg(const Image& image, int quality) {
  require_pixels(image, "encode_jpeg");
  if (quality < 1 || quality > 100)
    throw Error(Errc::invalid_argument,
                "encode_jpeg: the quality is " + std::to_string(quality) + ", but must be 1 to 100");
  const std::unique_ptr<void, int (*)(tjhandle)> encoder(tjInitCompress(), tjDestroy);
  const auto width = static_cast<int>(image.width), height = static_cast<int>(image.height);
  unsigned long size = tjBufSize(width, height, TJSAMP_420);
  std::vector<std::uint8_t> bytes(size);
  std::uint8_t* out = bytes.data();
  if (!encoder || tjCompress2(encoder.get(), image.rgba.data(), width, 0, height, TJPF_RGBA, &out, &size, TJSAMP_420,
                              quality, TJFLAG_NOREALLOC) != 0)
    throw Error(Errc::invalid_argument,
                std::string("encode_jpeg: ") + (encoder ? tjGetErrorStr2(encoder.get()) : "not enough memory"));
  bytes.resize(size);
  return bytes;
}

}  // namespace vantage
