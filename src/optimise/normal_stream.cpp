// SPDX-License-Identifier: Apache-2.0
#include "optimise/normal_stream.hpp"

#include <cmath>
#include <numbers>

#include "core/philox.hpp"

namespace vantage::optimise {
namespace {

constexpr std::uint32_t kStream = 0x6f707469;  // separates this stream from others of the same seed

double unit_interval(std::uint32_t high, std::uint32_t low) {
  return static_cast<double>((std::uint64_t{high >> 5} << 26) | (low >> 6)) * 0x1p-53;
}

}  // namespace

NormalStream::Pair NormalStream::uniforms() {
  const auto bits =
      philox4x32(seed_, {static_cast<std::uint32_t>(block_), static_cast<std::uint32_t>(block_ >> 32), kStream, 0});
  ++block_;
  return {unit_interval(bits[0], bits[1]), unit_interval(bits[2], bits[3])};
}

NormalStream::Pair NormalStream::normals() {
  const Pair u = uniforms();
  const double radius = std::sqrt(-2.0 * std::log(1.0 - u.first));  // 1 − u is never 0
  const double angle = 2.0 * std::numbers::pi * u.second;
  return {radius * std::cos(angle), radius * std::sin(angle)};
}

void NormalStream::fill_normal(std::span<double> out) {
  for (std::size_t i = 0; i < out.size(); i += 2) {
    const Pair pair = normals();
    out[i] = pair.first;
    if (i + 1 < out.size()) out[i + 1] = pair.second;
  }
}

double NormalStream::normal() { return normals().first; }

double NormalStream::uniform() { return uniforms().first; }

std::size_t NormalStream::index(std::size_t count) {
  return static_cast<std::size_t>(uniform() * static_cast<double>(count));
}

}  // namespace vantage::optimise
