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
namespace {

// Whether a PNG's chunks lie within its bytes: stb_image makes room for what a chunk claims before it looks for it.
bool chunks_fit(std::span<const std::uint8_t> bytes) {
  constexpr std::size_t signature = 8, frame = 12;  // length, type and checksum of a chunk
  const auto word = [&](std::size_t at) {
    return std::size_t{bytes[at]} << 24 | std::size_t{bytes[at + 1]} << 16 | std::size_t{bytes[at + 2]} << 8 |
           std::size_t{bytes[at + 3]};
  };
  constexpr std::size_t end = 0x49454e44;  // "IEND": what follows is not looked at
  for (std::size_t at = signature; at + frame <= bytes.size();) {
    const std::size_t length = word(at);
    if (word(at + 4) == end) return true;
    if (length > bytes.size() - at - frame) return false;
    at += frame + length;
  }
  return true;  // whatever is missing is told by the decoder
}

}  // namespace

Image decode_image(std::span<const std::uint8_t> bytes, std::string& problem) {
  if (bytes.empty() || bytes.size() > static_cast<std::size_t>(std::numeric_limits<int>::max())) {
    problem = "it has " + std::to_string(bytes.size()) + " bytes";
    return {};
  }
  if (bytes.size() >= 2 && bytes[0] == 0xff && bytes[1] == 0xd8)
    return decode_jpeg(bytes, STBI_MAX_DIMENSIONS, problem);
  if (!chunks_fit(bytes)) {
    problem = "it is cut short, or damaged: a part of it claims more bytes than there are";
    return {};
  }
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
