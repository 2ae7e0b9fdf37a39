// SPDX-License-Identifier: Apache-2.0
#include "report/station_pictures.hpp"

#include <algorithm>
#include <cmath>

#include "image/encode.hpp"
#include "vantage/error.hpp"
#include "vantage/panorama.hpp"

namespace vantage {
namespace {

constexpr std::uint32_t kWidest = 512, kNarrowest = 64;
constexpr std::size_t kOfWidest = 24;  // stations; if there are more, they share the pixels
constexpr std::size_t kMostBytes = 1'200'000;

std::uint32_t width_for(std::size_t stations) {
  const double share = std::sqrt(static_cast<double>(kOfWidest) / static_cast<double>(std::max(stations, kOfWidest)));
  return std::max(kNarrowest, 2 * static_cast<std::uint32_t>(kWidest * share / 2));
}

std::vector<std::vector<std::uint8_t>> encoded(std::span<const Image> images) {
  std::vector<std::vector<std::uint8_t>> files;
  for (const int quality : {80, 60, 40, 20}) {
    files.clear();
    std::size_t bytes = 0;
    for (const Image& image : images) {
      files.push_back(image.rgba.empty() ? std::vector<std::uint8_t>() : encode_jpeg(image, quality));
      bytes += files.back().size();
    }
    if (bytes <= kMostBytes) return files;
  }
  return {};
}

}  // namespace

std::vector<std::vector<std::uint8_t>> station_pictures(const Simulator& simulator,
                                                        std::span<const PlacedStation> stations, std::stop_token stop) {
  if (stations.empty()) return {};
  const Box bounds = simulator.scene().bounds();
  const Vec3 middle = (bounds.min + bounds.max) * 0.5;
  constexpr PanoramaView kView[] = {PanoramaView::colour};
  std::vector<Image> images;
  try {
    PanoramaRenderer renderer(simulator.scene(),
                              {.width = width_for(stations.size()),
                               .min_range_m = simulator.scanner().min_range_m,
                               .max_range_m = std::max(1000.0, simulator.scanner().max_range_m)},
                              simulator.config());
    for (const PlacedStation& station : stations) {
      images.emplace_back();
      if (station.status == StationStatus::hole) continue;
      const Vec3 towards = middle - station.position;
      auto drawn = renderer.render(station.position, kView, {.stop = stop},
                                   {.heading = Angle::radians(std::atan2(towards.y, towards.x))});
      if (drawn.empty()) return {};
      images.back() = std::move(drawn.front().image);
    }
  } catch (const Error& error) {
    if (const auto& warn = simulator.config().warn)
      warn(std::string("no pictures of the stations' views: ") + error.what());
    return {};
  }
  return encoded(images);
}

}  // namespace vantage
