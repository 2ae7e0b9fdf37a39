// SPDX-License-Identifier: Apache-2.0
// Counter-based random numbers: Philox4x32-10 (Salmon, Moraes, Dror, Shaw: Parallel Random Numbers: As Easy as 1, 2, 3,
// 2011). The same (key, counter) gives the same numbers everywhere, in every order; shaders/lib/philox.glsl is the same
// function.
#pragma once

#include <array>
#include <cstdint>

namespace vantage {

constexpr std::array<std::uint32_t, 4> philox4x32(std::uint64_t key, std::array<std::uint32_t, 4> c) {
  std::uint32_t k0 = static_cast<std::uint32_t>(key), k1 = static_cast<std::uint32_t>(key >> 32);
  for (int round = 0; round < 10; ++round) {
    const std::uint64_t p0 = std::uint64_t{0xD2511F53u} * c[0], p1 = std::uint64_t{0xCD9E8D57u} * c[2];
    c = {static_cast<std::uint32_t>(p1 >> 32) ^ c[1] ^ k0, static_cast<std::uint32_t>(p1),
         static_cast<std::uint32_t>(p0 >> 32) ^ c[3] ^ k1, static_cast<std::uint32_t>(p0)};
    k0 += 0x9E3779B9u;
    k1 += 0xBB67AE85u;
  }
  return c;
}

// Returns 32 random bits of a ray, by its number and its station's place, as random_bits() of the shaders does.
constexpr std::uint32_t random_bits(std::uint64_t seed, std::uint64_t ray, std::uint32_t place, std::uint32_t stream) {
  return philox4x32(seed, {static_cast<std::uint32_t>(ray), static_cast<std::uint32_t>(ray >> 32), place, stream})[0];
}

// A stream of numbers from Philox blocks, for code that draws sequentially. Its state is two integers, so it can be
// saved.
class RandomStream {
 public:
  explicit RandomStream(std::uint64_t seed, std::uint64_t stream = 0) : seed_(seed), stream_(stream) {}

  std::uint32_t bits() {
    const auto block =
        philox4x32(seed_, {static_cast<std::uint32_t>(count_ >> 2), static_cast<std::uint32_t>(count_ >> 34),
                           static_cast<std::uint32_t>(stream_), static_cast<std::uint32_t>(stream_ >> 32)});
    return block[count_++ & 3];
  }
  double uniform() {  // [0, 1), 53 bits
    const std::uint64_t high = bits() >> 5, low = bits() >> 6;
    return static_cast<double>((high << 26) | low) * 0x1p-53;
  }
  double normal();  // Box–Muller, one of the pair, so that the state stays one counter
  std::uint64_t count() const { return count_; }
  void seek(std::uint64_t count) { count_ = count; }

 private:
  std::uint64_t seed_, stream_, count_ = 0;
};

}  // namespace vantage
