// SPDX-License-Identifier: Apache-2.0
#include "map/search_tint.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/parallel.hpp"

namespace vantage {
namespace {

constexpr std::size_t kRim = 4;  // pixels

enum Cover : std::uint8_t { none, hidden, shown };

std::vector<std::uint8_t> cover_of(const HeightBuffer& heights, double origin_z, const SearchMesh& mesh) {
  const MapWindow& window = heights.window;
  std::vector<std::uint8_t> cover(window.columns * window.rows, none);
  for_row_bands(window, [&](const RowBand& band) {
    const auto put = [&](std::size_t pixel, double z) {
      const bool shows = !(double{heights.z[pixel]} > z + kHidden_m);
      cover[pixel] = std::max<std::uint8_t>(cover[pixel], shows ? shown : hidden);
    };
    for (const auto& t : mesh.triangles) for_each_pixel(window, mesh, t, -origin_z, put, band);
  });
  return cover;
}

// Sets in `near` the pixels less than `r` pixels, along their line, from a `wanted` one or from the line's end.
template <class Wanted>
void spread_along(std::size_t lines, std::size_t line_step, std::size_t length, std::size_t step, std::size_t r,
                  Wanted&& wanted, std::vector<std::uint8_t>& near) {
  parallel::for_all(std::size_t{0}, lines, [&](std::size_t line) {
    for (const bool forth : {true, false}) {
      std::size_t since = 0;
      for (std::size_t i = 0; i < length; ++i) {
        const std::size_t k = line * line_step + (forth ? i : length - 1 - i) * step;
        since = wanted(k) ? 0 : since + 1;
        if (since < r) near[k] = 1;
      }
    }
  });
}

// Pixels of the set that are less than `r` columns and rows from a pixel outside of it, or from the map's border.
std::vector<std::uint8_t> rim_of(const std::vector<std::uint8_t>& set, std::size_t columns, std::size_t r) {
  const std::size_t rows = set.size() / columns;
  std::vector<std::uint8_t> across(set.size(), 0), rim(set.size(), 0);
  spread_along(
      rows, columns, columns, 1, r, [&](std::size_t k) { return !set[k]; }, across);
  spread_along(
      columns, 1, rows, columns, r, [&](std::size_t k) { return across[k]; }, rim);
  for (std::size_t k = 0; k < set.size(); ++k) rim[k] = rim[k] && set[k];
  return rim;
}

}  // namespace

void tint_search_area(std::vector<std::uint32_t>& pixels, const HeightBuffer& heights, double origin_z,
                      const SearchMesh& mesh) {
  const std::vector<std::uint8_t> cover = cover_of(heights, origin_z, mesh),
                                  rim = rim_of(cover, heights.window.columns, kRim);
  parallel::for_all(tbb::blocked_range<std::size_t>(0, pixels.size()), [&](const auto& range) {
    for (std::size_t k = range.begin(); k != range.end(); ++k) {
      if (rim[k])
        pixels[k] = laid_over(pixels[k], kSearchTint, cover[k] == shown ? kSearchRim : kHiddenRim);
      else if (cover[k] == shown)
        pixels[k] = laid_over(pixels[k], kSearchTint, kSearchOpacity);
    }
  });
}

}  // namespace vantage
