// SPDX-License-Identifier: Apache-2.0
// Normal and uniform numbers in bulk. A Philox block gives two 53-bit uniforms and so, by Box–Muller, both normals of a
// pair, four times cheaper than one by one. The state is one counter, so it can be saved.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace vantage::optimise {

class NormalStream {
 public:
  explicit NormalStream(std::uint64_t seed) : seed_(seed) {}

  void fill_normal(std::span<double> out);
  double normal();
  double uniform();                      // [0, 1)
  std::size_t index(std::size_t count);  // [0, count)

  std::uint64_t seed() const { return seed_; }
  std::uint64_t block() const { return block_; }
  void seek(std::uint64_t seed, std::uint64_t block) {
    seed_ = seed;
    block_ = block;
  }

 private:
  struct Pair {
    double first, second;
  };
  Pair uniforms();
  Pair normals();

  std::uint64_t seed_, block_ = 0;
};

}  // namespace vantage::optimise
