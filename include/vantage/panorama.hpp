// SPDX-License-Identifier: Apache-2.0
/// Equirectangular images around a station: colours for its points, and pictures of what it sees.
///
/// Every image covers the full sphere as someone at the station sees it: heading in the middle, azimuth falling from
/// left to right (what lies to the right is on the right), zenith at the top, nadir at the bottom. If the station is
/// turned (`StationSetup`), angles are in the scanner's frame, as with its own camera.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "vantage/image.hpp"
#include "vantage/progress.hpp"
#include "vantage/station_setup.hpp"
#include "vantage/types.hpp"

namespace vantage {

class Scene;
struct SimulatorConfig;

/// A panoramic photograph that gives a scan its colours (section 3.2). Immutable; safe to read from any thread.
class Panorama {
 public:
  /// `heading` is the azimuth of the image's middle. Throws Error invalid_argument for an empty image.
  explicit Panorama(Image image, Angle heading = {});
  /// Throws Error: io, malformed_file.
  static Panorama load(const std::filesystem::path& file, Angle heading = {});
  /// Colour in a direction, 0xAABBGGRR: bilinear in the stored values, around the seam and up to the poles.
  std::uint32_t colour(Angle zenith, Angle azimuth) const;
  const Image& image() const noexcept { return image_; }  ///< The photograph.
  Angle heading() const noexcept { return heading_; }     ///< Azimuth of its middle.

 private:
  Image image_;
  Angle heading_;
};

/// View of a rendered panorama (figure 2).
enum class PanoramaView {
  colour,        ///< Material colours, shaded by a lamp at the station, so that form shows.
  range,         ///< Distance on a logarithmic scale.
  normal,        ///< (1 + n) / 2 as red, green, blue.
  reflectivity,  ///< R·(I·(−N)).
  mesh,          ///< One colour a mesh, shaded.
};
std::string to_string(PanoramaView);  ///< The name of the enumerator.
/// Throws Error invalid_argument and lists the views.
PanoramaView panorama_view_from_string(const std::string&);
/// All views.
std::span<const PanoramaView> panorama_views() noexcept;

/// Size and limits of rendered panoramas.
struct PanoramaOptions {
  std::uint32_t width = 2048;     ///< Pixels; even. The height is half of it.
  std::uint32_t supersample = 2;  ///< Rays per pixel and direction, 1 to 8, to smooth edges.
  Angle heading = {};             ///< Azimuth of the image's middle.
  double min_range_m = 0.1;       ///< Anything nearer is not seen.
  double max_range_m = 1000;      ///< Anything farther is sky.
};

/// A rendered view and the scale of its colours.
struct PanoramaImage {
  PanoramaView view = PanoramaView::colour;  ///< Content of the image.
  Image image;                               ///< Twice as wide as high.
  double scale_low = 0, scale_high = 0;      ///< `range`: metres at the ends of the scale. `reflectivity`: 0 and the
                                             ///< largest value.
};

/// Renders panoramas of a scene. Not thread-safe. Memory grows with the image, not with supersampling (except 2 bytes a
/// ray for `range`).
class PanoramaRenderer {
 public:
  /// Uses only engine and device of `config`. Throws Error: invalid_argument, no_suitable_device.
  PanoramaRenderer(const Scene& scene, const PanoramaOptions& options, const SimulatorConfig& config);
  PanoramaRenderer(PanoramaRenderer&&) noexcept;
  PanoramaRenderer& operator=(PanoramaRenderer&&) noexcept;
  ~PanoramaRenderer();
  /// Returns the views in the order asked for, from `position` (survey frame), turned by `setup`; its scanner is
  /// ignored. Empty if `progress` stopped it.
  std::vector<PanoramaImage> render(const Vec3& position, std::span<const PanoramaView> views,
                                    const Progress& progress = {}, const StationSetup& setup = {});

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace vantage
