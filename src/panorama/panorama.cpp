// SPDX-License-Identifier: Apache-2.0
#include "vantage/panorama.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/closest_name.hpp"
#include "vantage/error.hpp"

namespace vantage {
namespace {

constexpr std::array<PanoramaView, 5> kViews{PanoramaView::colour, PanoramaView::range, PanoramaView::normal,
                                             PanoramaView::reflectivity, PanoramaView::mesh};

}  // namespace

Panorama::Panorama(Image image, Angle heading) : image_(std::move(image)), heading_(heading) {
  if (image_.width == 0 || image_.height == 0 || image_.rgba.size() != std::size_t{4} * image_.width * image_.height)
    throw Error(Errc::invalid_argument, "a panorama needs an image with pixels");
}

Panorama Panorama::load(const std::filesystem::path& file, Angle heading) {
  return Panorama(read_image(file), heading);
}

std::uint32_t Panorama::colour(Angle zenith, Angle azimuth) const {
  constexpr double kTurn = 2 * std::numbers::pi;
  const double across = 0.5 - (azimuth.in_radians() - heading_.in_radians()) / kTurn;
  const double x = (across - std::floor(across)) * image_.width - 0.5;
  const double y = std::clamp(zenith.in_radians() / std::numbers::pi * image_.height - 0.5, 0.0, image_.height - 1.0);
  const double left = std::floor(x), top = std::floor(y);
  const double right_share = x - left, bottom_share = y - top;
  const auto column = [&](double at) {
    return static_cast<std::size_t>(at < 0 ? at + image_.width : at >= image_.width ? at - image_.width : at);
  };
  const std::size_t x0 = column(left), x1 = column(left + 1);
  const auto y0 = static_cast<std::size_t>(top), y1 = std::min<std::size_t>(y0 + 1, image_.height - 1);
  std::uint32_t packed = 0;
  for (std::size_t c = 0; c < 4; ++c) {
    const auto at = [&](std::size_t px, std::size_t py) {
      return static_cast<double>(image_.rgba[(py * image_.width + px) * 4 + c]);
    };
    const double upper = at(x0, y0) + (at(x1, y0) - at(x0, y0)) * right_share;
    const double lower = at(x0, y1) + (at(x1, y1) - at(x0, y1)) * right_share;
    packed |= static_cast<std::uint32_t>(upper + (lower - upper) * bottom_share + 0.5) << (8 * c);
  }
  return packed;
}

std::string to_string(PanoramaView view) {
  switch (view) {
    case PanoramaView::colour: return "colour";
    case PanoramaView::range: return "range";
    case PanoramaView::normal: return "normal";
    case PanoramaView::reflectivity: return "reflectivity";
    case PanoramaView::mesh: return "mesh";
  }
  return "unknown";
}

PanoramaView panorama_view_from_string(const std::string& name) {
  std::string names;
  std::vector<std::string> all;
  for (const PanoramaView view : kViews) {
    all.push_back(to_string(view));
    if (all.back() == name) return view;
    names += (names.empty() ? "" : ", ") + all.back();
  }
  throw Error(Errc::invalid_argument,
              "there is no panorama view \"" + name + "\"; choose one of " + names + did_you_mean(name, all));
}

std::span<const PanoramaView> panorama_views() noexcept { return kViews; }

}  // namespace vantage
