// SPDX-License-Identifier: Apache-2.0
#include "image/srgb.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace vantage {
namespace {

double decode(double s) { return s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4); }

struct Tables {
  static constexpr int kCells = 4096;
  std::array<float, 256> linear;
  std::array<float, 256> next;             // code k ends where linear light reaches next[k]
  std::array<std::uint8_t, kCells> first;  // code at the start of each 4096th of linear light

  Tables() {
    for (int code = 0; code < 256; ++code) {
      linear[code] = static_cast<float>(decode(code / 255.0));
      next[code] = code < 255 ? static_cast<float>(decode((code + 0.5) / 255.0)) : HUGE_VALF;
    }
    int code = 0;
    for (int cell = 0; cell < kCells; ++cell) {
      while (next[code] <= static_cast<float>(cell) / kCells) ++code;
      first[cell] = static_cast<std::uint8_t>(code);
    }
  }
};

const Tables& tables() {
  static const Tables made;
  return made;
}

std::uint32_t byte(float share) { return static_cast<std::uint32_t>(std::clamp(share, 0.0f, 1.0f) * 255.0f + 0.5f); }

}  // namespace

float linear_from_srgb8(std::uint8_t code) { return tables().linear[code]; }

std::uint8_t srgb8_from_linear(float linear) {
  if (!(linear > 0)) return 0;
  if (linear >= 1) return 255;
  const Tables& t = tables();
  std::uint8_t code = t.first[static_cast<std::size_t>(linear * Tables::kCells)];
  while (t.next[code] <= linear) ++code;
  return code;
}

std::uint32_t pack_srgb(const LinearColour& colour) {
  return std::uint32_t{srgb8_from_linear(colour[0])} | std::uint32_t{srgb8_from_linear(colour[1])} << 8 |
         std::uint32_t{srgb8_from_linear(colour[2])} << 16 | byte(colour[3]) << 24;
}

}  // namespace vantage
