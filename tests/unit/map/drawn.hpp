// SPDX-License-Identifier: Apache-2.0
// A picture as its reader sees it: the marks on the paper, by colour.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <utility>
#include <vector>

#include "map/colour.hpp"
#include "vantage/vantage.hpp"

namespace vantage::test {

class Drawn {
 public:
  explicit Drawn(const std::filesystem::path& png) {
    auto image = read_image(png);
    width_ = image.width;
    rgba_ = std::move(image.rgba);
  }

  std::size_t width() const { return width_; }
  std::size_t pixels() const { return rgba_.size() / 4; }

  // Pixels that are not paper.
  std::size_t ink() const { return pixels() - near({1, 1, 1}, 0); }

  // Pixels whose every channel is within `tolerance` (of 255) of a colour.
  std::size_t near(const Colour& colour, int tolerance) const {
    std::size_t count = 0;
    for (std::size_t p = 0; p < pixels(); ++p) count += is(p, colour, tolerance);
    return count;
  }

  // A connected patch of one colour.
  struct Patch {
    std::size_t pixels = 0, columns = 0;
  };
  // All of at least `least` pixels.
  std::vector<Patch> patches(const Colour& colour, std::size_t least, int tolerance = 1) const {
    std::vector<Patch> found;
    std::vector<bool> seen(pixels());
    std::vector<std::size_t> open;
    const std::size_t columns = width_;
    for (std::size_t start = 0; start < pixels(); ++start) {
      if (seen[start] || !is(start, colour, tolerance)) continue;
      Patch patch;
      std::size_t left = columns, right = 0;
      seen[start] = true;
      open.push_back(start);
      while (!open.empty()) {
        const std::size_t p = open.back(), x = p % columns;
        open.pop_back();
        ++patch.pixels;
        left = std::min(left, x), right = std::max(right, x);
        const auto go = [&](bool possible, std::size_t next) {
          if (!possible || seen[next] || !is(next, colour, tolerance)) return;
          seen[next] = true;
          open.push_back(next);
        };
        go(x > 0, p - 1), go(x + 1 < columns, p + 1), go(p >= columns, p - columns),
            go(p + columns < pixels(), p + columns);
      }
      patch.columns = right - left + 1;
      if (patch.pixels >= least) found.push_back(patch);
    }
    return found;
  }

 private:
  bool is(std::size_t pixel, const Colour& colour, int tolerance) const {
    const auto wanted = to_bytes(colour);
    for (std::size_t c = 0; c < 3; ++c)
      if (std::abs(int{rgba_[4 * pixel + c]} - int{wanted[c]}) > tolerance) return false;
    return true;
  }

  std::size_t width_ = 0;
  std::vector<std::uint8_t> rgba_;
};

}  // namespace vantage::test
