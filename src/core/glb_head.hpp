// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <limits>
#include <stdexcept>
#include <string>

namespace vantage {

// Returns the bytes of a GLB before its binary chunk, which has `binary` bytes, a multiple of four: header, document,
// and the chunk's own header. Throws std::length_error above 4 GiB, the limit of GLB.
inline std::string glb_head(std::string document, std::size_t binary) {
  constexpr std::uint32_t kMagic = 0x46546C67, kVersion = 2, kJson = 0x4E4F534A, kBinary = 0x004E4942;
  document.resize((document.size() + 3) / 4 * 4, ' ');
  const std::size_t total = 12 + 8 + document.size() + 8 + binary;
  if (total > std::numeric_limits<std::uint32_t>::max()) throw std::length_error(std::to_string(total));
  std::string head;
  const auto words = [&head](std::initializer_list<std::size_t> values) {
    for (const std::size_t value : values)
      for (int shift = 0; shift < 32; shift += 8) head += static_cast<char>((value >> shift) & 0xFF);
  };
  words({kMagic, kVersion, total, document.size(), kJson});
  head += document;
  words({binary, kBinary});
  return head;
}

}  // namespace vantage
