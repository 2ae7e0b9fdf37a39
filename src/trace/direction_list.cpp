// SPDX-License-Identifier: Apache-2.0
#include "trace/direction_list.hpp"

#include <numeric>

#include "core/parallel.hpp"

namespace vantage {

DirectionList::DirectionList(std::span<const double> zeniths, std::span<const double> azimuths) {
  const std::size_t rays = zeniths.size();
  const auto [low, high] = std::ranges::minmax_element(zeniths);
  const double tall = *high - *low;
  // Chooses the number of bands so that a band's part with one ray is about square, on a full turn.
  constexpr double kMostBands = 65'536;
  const double many = std::clamp(std::round(std::sqrt(static_cast<double>(rays) * tall / kTurn)), 1.0, kMostBands);
  first_zenith_ = *low;
  // Rounding puts no ray beyond the last band.
  band_ = tall > 0 ? tall / many * (1 + 0x1p-40) : 1;

  std::vector<std::uint32_t> band(rays);
  std::vector<double> azimuth(rays);
  sin_azimuth.reserve(rays), cos_azimuth.reserve(rays);
  offset_.assign(static_cast<std::size_t>(many) + 1, 0);
  for (std::size_t k = 0; k < rays; ++k) {
    band[k] = static_cast<std::uint32_t>(std::min(band_at(zeniths[k]), many - 1));
    azimuth[k] = turned_once(azimuths[k]);
    sin_azimuth.push_back(static_cast<float>(std::sin(azimuths[k])));
    cos_azimuth.push_back(static_cast<float>(std::cos(azimuths[k])));
    ++offset_[band[k] + 1];
  }
  std::partial_sum(offset_.begin(), offset_.end(), offset_.begin());
  rays_.resize(rays), azimuth_.resize(rays);
  std::vector<std::size_t> next(offset_.begin(), offset_.end() - 1);
  for (std::uint32_t k = 0; k < rays; ++k) rays_[next[band[k]]++] = k;
  parallel::for_all(std::size_t{0}, bands(), [&](std::size_t own) {
    const auto begin = static_cast<std::ptrdiff_t>(offset_[own]), end = static_cast<std::ptrdiff_t>(offset_[own + 1]);
    std::stable_sort(rays_.begin() + begin, rays_.begin() + end,
                     [&](std::uint32_t a, std::uint32_t b) { return azimuth[a] < azimuth[b]; });
    for (auto at = offset_[own]; at < offset_[own + 1]; ++at) azimuth_[at] = azimuth[rays_[at]];
  });
}

std::size_t DirectionList::longest_band() const {
  std::size_t longest = 0;
  for (std::size_t band = 0; band < bands(); ++band) longest = std::max(longest, offset_[band + 1] - offset_[band]);
  return longest;
}

}  // namespace vantage
