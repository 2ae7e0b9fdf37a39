// SPDX-License-Identifier: Apache-2.0
#include "voxel/voxel_grid.hpp"

namespace vantage {
namespace {

// Moves bit k of a 21-bit number to bit 3k.
std::uint64_t spread(std::uint64_t v) {
  v &= 0x1FFFFF;
  v = (v | v << 32) & 0x001F00000000FFFF;
  v = (v | v << 16) & 0x001F0000FF0000FF;
  v = (v | v << 8) & 0x100F00F00F00F00F;
  v = (v | v << 4) & 0x10C30C30C30C30C3;
  return (v | v << 2) & 0x1249249249249249;
}

std::uint32_t gather(std::uint64_t v) {
  v &= 0x1249249249249249;
  v = (v | v >> 2) & 0x10C30C30C30C30C3;
  v = (v | v >> 4) & 0x100F00F00F00F00F;
  v = (v | v >> 8) & 0x001F0000FF0000FF;
  v = (v | v >> 16) & 0x001F00000000FFFF;
  return static_cast<std::uint32_t>((v | v >> 32) & 0x1FFFFF);
}

}  // namespace

std::uint64_t morton_encode(std::uint32_t x, std::uint32_t y, std::uint32_t z) {
  return spread(x) | spread(y) << 1 | spread(z) << 2;
}

std::array<std::uint32_t, 3> morton_decode(std::uint64_t key) {
  return {gather(key), gather(key >> 1), gather(key >> 2)};
}

}  // namespace vantage
