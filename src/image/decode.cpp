// SPDX-License-Identifier: Apache-2.0
#include "image/decode.hpp"

#include <cstdlib>
#include <limits>
#include <memory>
#include <vector>

namespace {

// A small PNG may inflate to gigabytes. So no buffer of its decoder may exceed the size that the header's picture can
// need; per thread.
thread_local std::size_t largest_buffer = 0;
void* bounded(void* old, std::size_t bytes) { return bytes <= largest_buffer ? std::realloc(old, bytes) : nullptr; }

}  // namespace

#define STBI_MALLOC(bytes) bounded(nullptr, bytes)
#define STBI_REALLOC(old, bytes) bounded(old, bytes)
#define STBI_FREE(old) std::free(old)
#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_PNG
#define STBI_NO_STDIO
#define STBI_MAX_DIMENSIONS 16384  // per side; 1 GiB of pixels: more means a broken header
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wold-style-cast"
#include <stb_image.h>
#pragma GCC diagnostic pop

namespace vantage {
namespace {

constexpr std::size_t chunk_frame = 12;  // length, name and checksum

bool is_jpeg(std::span<const std::uint8_t> bytes) { return bytes.size() >= 2 && bytes[0] == 0xff && bytes[1] == 0xd8; }
bool fits_int(std::size_t bytes) { return bytes > 0 && bytes <= std::size_t{std::numeric_limits<int>::max()}; }

// Visits each chunk of a PNG that lies within the bytes, up to the image's end, with its start, length and name.
// Returns false if a chunk claims more than there is. The decoder reports anything missing.
template <class Tell>
bool walk_chunks(std::span<const std::uint8_t> bytes, const Tell& tell) {
  const auto word = [&](std::size_t at) {
    return std::size_t{bytes[at]} << 24 | std::size_t{bytes[at + 1]} << 16 | std::size_t{bytes[at + 2]} << 8 |
           std::size_t{bytes[at + 3]};
  };
  constexpr std::size_t signature = 8, end = 0x49454e44;  // "IEND": anything after it is ignored
  for (std::size_t at = signature; at + chunk_frame <= bytes.size();) {
    const std::size_t length = word(at), name = word(at + 4);
    if (name == end) return true;
    if (length > bytes.size() - at - chunk_frame) return false;
    tell(at, length, name);
    at += chunk_frame + length;
  }
  return true;
}

// Copies all bytes except the empty chunks that begin at `empty`, in ascending order.
std::vector<std::uint8_t> without_chunks(std::span<const std::uint8_t> bytes, std::span<const std::size_t> empty) {
  std::vector<std::uint8_t> rest;
  std::size_t from = 0;
  const auto keep_to = [&](std::size_t end) {
    const auto kept = bytes.subspan(from, end - from);
    rest.insert(rest.end(), kept.begin(), kept.end());
  };
  for (const std::size_t at : empty) {
    keep_to(at);
    from = at + chunk_frame;
  }
  keep_to(bytes.size());
  return rest;
}

}  // namespace

ImageHeader read_image_header(std::span<const std::uint8_t> bytes) {
  if (!fits_int(bytes.size())) return {};
  if (is_jpeg(bytes)) return read_jpeg_header(bytes, STBI_MAX_DIMENSIONS);
  largest_buffer = bytes.size();
  const int size = static_cast<int>(bytes.size());
  int width = 0, height = 0, channels = 0;
  if (!stbi_info_from_memory(bytes.data(), size, &width, &height, &channels)) return {};
  // Interlaced images need three pictures at once: filtered, of a pass, and whole.
  const std::uint64_t pixel = stbi_is_16_bit_from_memory(bytes.data(), size) ? 3 * 8 : 3 * 4;
  const ImageHeader header{static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height), 0};
  return {header.width, header.height, pixel * header.width * header.height + 2 * bytes.size()};
}

Image decode_image(std::span<const std::uint8_t> bytes, std::string& problem) {
  if (!fits_int(bytes.size())) {
    problem = "it has " + std::to_string(bytes.size()) + " bytes";
    return {};
  }
  if (is_jpeg(bytes)) return decode_jpeg(bytes, STBI_MAX_DIMENSIONS, problem);
  // stb_image allocates what a chunk claims before looking for it. It also copies nothing to nowhere, which is
  // undefined, if the image's first data chunk is empty, as the format allows.
  constexpr std::size_t data = 0x49444154;  // "IDAT"
  std::vector<std::size_t> empty;
  const bool fit = walk_chunks(bytes, [&](std::size_t at, std::size_t length, std::size_t name) {
    if (name == data && length == 0) empty.push_back(at);
  });
  if (!fit) {
    problem = "it is cut short, or damaged: a part of it claims more bytes than there are";
    return {};
  }
  std::vector<std::uint8_t> rest;
  if (!empty.empty()) bytes = rest = without_chunks(bytes, empty);
  constexpr std::size_t tables = std::size_t{1} << 16;
  largest_buffer = static_cast<std::size_t>(read_image_header(bytes).decoding_bytes) + tables;
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
