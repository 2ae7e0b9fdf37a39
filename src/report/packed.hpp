// SPDX-License-Identifier: Apache-2.0
// Arrays as text within a page: deflated (RFC 1950), then base64 (RFC 4648). Browsers can undo both.
#pragma once

#include <concepts>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace vantage {

std::string base64(std::span<const std::uint8_t> bytes);

// Throws Error out_of_memory.
std::string packed(std::span<const std::uint8_t> bytes);

// Little-endian values by bytes: first all lowest bytes, then all next ones. Slowly changing values deflate well in
// this order.
template <std::unsigned_integral T>
std::vector<std::uint8_t> byte_planes(std::span<const T> values) {
  std::vector<std::uint8_t> bytes;
  bytes.reserve(values.size_bytes());
  for (std::size_t plane = 0; plane < sizeof(T); ++plane)
    for (const T value : values) bytes.push_back(static_cast<std::uint8_t>(value >> (8 * plane)));
  return bytes;
}

}  // namespace vantage
