// SPDX-License-Identifier: Apache-2.0
#include "core/atomic_file.hpp"
#include "core/free_memory.hpp"
#include "core/read_file.hpp"
#include "image/decode.hpp"
#include "image/encode.hpp"
#include "vantage/error.hpp"
#include "vantage/image.hpp"

#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#define STBI_WRITE_NO_STDIO
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"
#include <stb_image_write.h>
#pragma GCC diagnostic pop

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
  AtomicFile out(file);
  const auto append = [](void* context, void* data, int bytes) {
    static_cast<AtomicFile*>(context)->write(data, static_cast<std::size_t>(bytes));
  };
  if (!stbi_write_png_to_func(append, &out, static_cast<int>(image.width), static_cast<int>(image.height), 4,
                              image.rgba.data(), static_cast<int>(4 * image.width)))
    throw Error(Errc::out_of_memory, "cannot write " + file.string() + ": not enough memory to compress it");
  out.commit();
}

std::vector<std::uint8_t> encode_jpeg(const Image& image, int quality) {
  require_pixels(image, "encode_jpeg");
  if (quality < 1 || quality > 100)
    throw Error(Errc::invalid_argument,
                "encode_jpeg: the quality is " + std::to_string(quality) + ", but must be 1 to 100");
  std::vector<std::uint8_t> bytes;
  const auto append = [](void* context, void* data, int count) {
    const auto* first = static_cast<const std::uint8_t*>(data);
    auto* out = static_cast<std::vector<std::uint8_t>*>(context);
    out->insert(out->end(), first, first + count);
  };
  if (!stbi_write_jpg_to_func(append, &bytes, static_cast<int>(image.width), static_cast<int>(image.height), 4,
                              image.rgba.data(), quality))
    throw Error(Errc::out_of_memory, "encode_jpeg: not enough memory");
  return bytes;
}

}  // namespace vantage
