// SPDX-License-Identifier: Apache-2.0

#include <algorithm>

#include "core/parallel.hpp"
#include "vantage/trace.hpp"

namespace vantage {

StationMasks::StationMasks(std::size_t voxels, std::size_t stations) : voxels_(voxels), words_(mask_words(stations)) {
  if (words_ == 1)
    only_word_.assign(voxels, 0);
  else
    blocks_.resize(words_ * blocks());
}

void StationMasks::set_words(std::size_t w, std::span<const std::uint64_t> masks) {
  if (words_ == 1) {
    only_word_.assign(masks.begin(), masks.end());
    return;
  }
  parallel::for_all(std::size_t{0}, blocks(), [&](std::size_t k) {
    const std::size_t first = k * block_voxels;
    const auto own = masks.subspan(first, std::min(block_voxels, masks.size() - first));
    std::vector<std::uint64_t>& block = blocks_[w * blocks() + k];
    if (std::ranges::all_of(own, [](std::uint64_t mask) { return mask == 0; }))
      block.clear();
    else
      block.assign(own.begin(), own.end());
  });
}

std::vector<std::uint64_t> StationMasks::all_words() const {
  if (words_ == 1) return only_word_;
  std::vector<std::uint64_t> words(words_ * voxels_);
  for (std::size_t w = 0; w < words_; ++w)
    for (std::size_t k = 0; k < blocks(); ++k)
      std::ranges::copy(block(w, k), words.begin() + static_cast<std::ptrdiff_t>(w * voxels_ + k * block_voxels));
  return words;
}

}  // namespace vantage
