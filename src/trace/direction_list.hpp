// SPDX-License-Identifier: Apache-2.0
// Directions of a scanner whose rays form no grid, such as a rosette, and a search for those near a direction. Rays are
// sorted into bands of zenith, and by azimuth in each band.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <span>
#include <vector>

namespace vantage {

// A range of zeniths, and the azimuths in [azimuth, azimuth + width], in radians; all azimuths if the width is a full
// turn or more.
struct AngleWindow {
  double least_zenith = 0, most_zenith = 0, azimuth = 0, width = 0;
};

class DirectionList {
 public:
  // Takes the angles of each ray, radians. REQUIRES: at least one and fewer than 2^32 rays; finite angles.
  DirectionList(std::span<const double> zeniths, std::span<const double> azimuths);

  // Sine and cosine for each ray, computed in double and rounded once, as in RayPattern for rows and columns.
  std::vector<float> sin_azimuth, cos_azimuth;

  // Calls visit(rays) with spans of rays. Each ray in the window is in exactly one span; other rays may be, too.
  template <class Visit>
  void each_near(const AngleWindow& window, const Visit& visit) const {
    const double first = band_at(window.least_zenith), last = band_at(window.most_zenith);
    if (last < 0 || first >= static_cast<double>(bands())) return;
    const auto begin = static_cast<std::size_t>(std::max(first, 0.0)),
               end = static_cast<std::size_t>(std::min(last + 1, static_cast<double>(bands())));
    const double low = turned_once(window.azimuth), high = low + window.width;
    for (std::size_t band = begin; band < end; ++band) {
      if (window.width >= kTurn) {
        visit(rays_between(offset_[band], offset_[band + 1]));
        continue;
      }
      const std::size_t from = place_of(band, low, false), to = place_of(band, high, true);
      if (from < to) visit(rays_between(from, to));
      if (high < kTurn) continue;
      const std::size_t wrapped = std::min(place_of(band, high - kTurn, true), from);
      if (wrapped > offset_[band]) visit(rays_between(offset_[band], wrapped));
    }
  }

  // Tables for engines that search rays themselves: rays by band, then azimuth; their azimuths in a full turn from 0;
  // where each band begins among them, and an end; the zenith at which the first band begins, and the height of each.
  std::span<const std::uint32_t> sorted_rays() const { return rays_; }
  std::span<const double> sorted_azimuths() const { return azimuth_; }
  std::span<const std::size_t> band_offsets() const { return offset_; }
  std::size_t longest_band() const;
  double first_zenith() const { return first_zenith_; }
  double band_height() const { return band_; }

 private:
  static constexpr double kTurn = 2 * std::numbers::pi;

  static double turned_once(double azimuth) { return azimuth - std::floor(azimuth / kTurn) * kTurn; }
  std::size_t bands() const { return offset_.size() - 1; }
  double band_at(double zenith) const { return std::floor((zenith - first_zenith_) / band_); }
  // Returns the place in rays_ of a band's first ray at the azimuth or above; `beyond`: only above.
  std::size_t place_of(std::size_t band, double azimuth, bool beyond) const {
    const auto begin = azimuth_.begin() + static_cast<std::ptrdiff_t>(offset_[band]),
               end = azimuth_.begin() + static_cast<std::ptrdiff_t>(offset_[band + 1]);
    const auto found = beyond ? std::upper_bound(begin, end, azimuth) : std::lower_bound(begin, end, azimuth);
    return static_cast<std::size_t>(found - azimuth_.begin());
  }
  std::span<const std::uint32_t> rays_between(std::size_t from, std::size_t to) const {
    return std::span(rays_).subspan(from, to - from);
  }

  std::vector<std::uint32_t> rays_;     // by band, then by azimuth
  std::vector<double> azimuth_;         // of rays_, in a full turn from 0
  std::vector<std::size_t> offset_;     // [band] in rays_, and an end
  double first_zenith_ = 0, band_ = 1;  // radians
};

}  // namespace vantage
