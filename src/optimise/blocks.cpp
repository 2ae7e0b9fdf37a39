// SPDX-License-Identifier: Apache-2.0
#include "optimise/blocks.hpp"

#include <algorithm>
#include <string>
#include <tuple>

#include "vantage/error.hpp"

namespace vantage::optimise {

void require_blocks(const Blocks& blocks, const BoxConstraints& box, std::size_t dimension) {
  const auto fail = [](const std::string& what) { throw Error(Errc::invalid_argument, "optimiser: " + what); };
  std::vector<char> met(dimension, 0);
  for (const auto& block : blocks) {
    if (block.empty() || block.size() != blocks.front().size())
      fail("blocks of " + std::to_string(block.size()) + " and " + std::to_string(blocks.front().size()) +
           " coordinates; they must have one length, at least 1");
    for (std::size_t d = 0; d < block.size(); ++d) {
      const std::size_t i = block[d], like = blocks.front()[d];
      if (i >= dimension) fail("a block holds coordinate " + std::to_string(i) + " of " + std::to_string(dimension));
      if (met[i]) fail("coordinate " + std::to_string(i) + " stands in two blocks");
      met[i] = 1;
      if (box.bounded() && (box.lower()[i] != box.lower()[like] || box.upper()[i] != box.upper()[like]))
        fail("coordinates " + std::to_string(like) + " and " + std::to_string(i) +
             " have the same place in two blocks but other bounds");
    }
  }
}

std::vector<std::size_t> match_blocks(std::span<const double> first, std::span<const double> second,
                                      const Blocks& blocks) {
  const std::size_t count = blocks.size();
  std::vector<std::tuple<double, std::size_t, std::size_t>> pairs;  // squared distance, block of first, block of second
  pairs.reserve(count * count);
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t j = 0; j < count; ++j) {
      double squared = 0;
      for (std::size_t d = 0; d < blocks[i].size(); ++d) {
        const double difference = first[blocks[i][d]] - second[blocks[j][d]];
        squared += difference * difference;
      }
      pairs.emplace_back(squared, i, j);
    }
  }
  std::sort(pairs.begin(), pairs.end());
  std::vector<std::size_t> result(count, count);
  std::vector<char> taken(count, 0);
  for (const auto& [squared, i, j] : pairs) {
    if (result[i] != count || taken[j]) continue;
    result[i] = j;
    taken[j] = 1;
  }
  return result;
}

void align_blocks(std::span<const double> first, std::span<double> second, std::span<double> along,
                  const Blocks& blocks) {
  if (blocks.empty()) return;
  const auto match = match_blocks(first, second, blocks);
  const std::vector<double> old(second.begin(), second.end()), old_along(along.begin(), along.end());
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    for (std::size_t d = 0; d < blocks[b].size(); ++d) {
      second[blocks[b][d]] = old[blocks[match[b]][d]];
      along[blocks[b][d]] = old_along[blocks[match[b]][d]];
    }
  }
}

void save_blocks(StateWriter& w, const Blocks& blocks) {
  w.put(std::uint64_t{blocks.size()});
  for (const auto& block : blocks)
    for (const std::size_t i : block) w.put(std::uint64_t{i});
}

void expect_blocks(StateReader& r, const Blocks& blocks) {
  r.expect(std::uint64_t{blocks.size()}, "number of blocks");
  for (const auto& block : blocks)
    for (const std::size_t i : block) r.expect(std::uint64_t{i}, "coordinate of a block");
}

}  // namespace vantage::optimise
