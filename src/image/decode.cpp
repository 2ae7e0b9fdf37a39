// SPDX-License-Identifier: Apache-2.0
#include "image/decode.hpp"

#include <limits>
#include <memory>

#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_PNG
#define STBI_NO_STDIO
#define STBI_MAX_DIMENSIONS 16384  // a side; 1 GiB of pixels: more is a broken header
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#include <stb_image.h>
#pragma GCC diagnostic pop

namespace vantage {

Image decode_image(std::span<const std::uint8_t> bytes, std::string& problem) {
  if (bytes.empty() || bytes.size() > static_cast<std::size_t>(std::numeric_limits<int>::max())) {
    problem = "it has " + std::to_string(bytes.size()) + " bytes";
    return {};
  }
  if (bytes.size() >= 2 && bytes[0] == 0xff && bytes[1] == 0xd8)
    return decode_jpeg(bytes, STBI_MAX_DIMENSIONS, problem);
  int width = 0, height = 0, channels = 0;
  const std::unique_ptr<stbi_uc, void (*)(void*)> pixels(
      stbi_load_from_memory(bytes.data(), static_cast<int>(bytes.size()), &width, &height, &channels, 4),
      stbi_image_free);
  if (!pixels) {
    const char* const reason = stbi_failure_reason();
    problem = reason && *reason ? reason : "it is damaged";
    return {};
  }
  const std::size_t size = std::size_t{4} * static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  return {static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height), {pixels.get(), pixels.get() + size}};
}

}  // namespace vantage
