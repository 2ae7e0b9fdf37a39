// SPDX-License-Identifier: Apache-2.0
#include "report/packed.hpp"

#include <gtest/gtest.h>
#include <zlib.h>

#include <random>

namespace vantage {
namespace {

// Decodes by the definition of base64, and zlib's own inflate.
std::vector<std::uint8_t> unpacked(const std::string& text, std::size_t size) {
  static const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::vector<std::uint8_t> bytes;
  std::uint32_t bits = 0;
  int held = 0;
  for (const char c : text) {
    if (c == '=') break;
    bits = bits << 6 | static_cast<std::uint32_t>(digits.find(c));
    if ((held += 6) >= 8) bytes.push_back(static_cast<std::uint8_t>(bits >> (held -= 8)));
  }
  std::vector<std::uint8_t> inflated(size + 1);
  uLongf length = inflated.size();
  EXPECT_EQ(uncompress(inflated.data(), &length, bytes.data(), bytes.size()), Z_OK);
  inflated.resize(length);
  return inflated;
}

TEST(Packed, IsReadBackByte) {
  std::mt19937 random(5);
  for (std::size_t size = 0; size < 70; ++size) {
    std::vector<std::uint8_t> bytes(size);
    for (auto& byte : bytes) byte = static_cast<std::uint8_t>(random());
    const std::string text = packed(bytes);
    EXPECT_EQ(text.size() % 4, 0u) << size;
    EXPECT_EQ(unpacked(text, size), bytes) << size;
  }
}

TEST(Packed, PlanesHaveLowestBytesFirst) {
  const std::vector<std::uint32_t> values{0x04030201, 0x14131211};
  EXPECT_EQ(byte_planes<std::uint32_t>(values),
            (std::vector<std::uint8_t>{0x01, 0x11, 0x02, 0x12, 0x03, 0x13, 0x04, 0x14}));
}

}  // namespace
}  // namespace vantage
