// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "core/parallel.hpp"
#include "panorama/false_colours.hpp"
#include "panorama/shading.hpp"
#include "vantage/error.hpp"
#include "vantage/panorama.hpp"
#include "vantage/simulator.hpp"

namespace vantage {
namespace {

constexpr LinearColour kBackdrop{0.85f, 0.85f, 0.85f, 1};  // background of false colours

// Ranges as 16 bits: 0 for no hit, otherwise log2 of the range from 2^−10 m to 2^15 m, in steps of 0.03 %.
constexpr double kLowestLog = -10, kLogs = 25, kCodes = 65534;
std::uint16_t range_code(float range) {
  if (!std::isfinite(range)) return 0;
  const double share = (std::log2(std::max(static_cast<double>(range), 1e-6)) - kLowestLog) / kLogs;
  return static_cast<std::uint16_t>(1 + std::lround(std::clamp(share, 0.0, 1.0) * kCodes));
}
double log_of_code(double code) { return kLowestLog + (code - 1) / kCodes * kLogs; }

Scanner panorama_scanner(const PanoramaOptions& options) {
  if (options.width < 4 || options.width > 16384 || options.width % 2 != 0)
    throw Error(Errc::invalid_argument,
                "panorama: the width is " + std::to_string(options.width) + ", but must be even, from 4 to 16384");
  if (options.supersample < 1 || options.supersample > 8)
    throw Error(Errc::invalid_argument,
                "panorama: supersample is " + std::to_string(options.supersample) + ", but must be 1 to 8");
  Scanner scanner;
  scanner.name = "panorama";
  scanner.heading = options.heading;
  scanner.horizontal_angle = scanner.vertical_angle = Angle::degrees(360);
  scanner.azimuth_step = scanner.zenith_step = Angle::degrees(360.0 / (options.width * options.supersample));
  scanner.min_range_m = options.min_range_m;
  scanner.max_range_m = options.max_range_m;
  scanner.check();
  return scanner;
}

double extent_of(const Scene& scene) {
  const Vec3 size = scene.bounds().size();
  return std::max({size.x, size.y, size.z, 1e-6});
}

// Rays are traced as in a scan; voxels are not used, so there are as few as possible.
Simulator make_simulator(const Scene& scene, const PanoramaOptions& options, const SimulatorConfig& config) {
  SimulatorConfig own = config;
  own.noise = false;
  own.user_size_m = extent_of(scene) / 4;
  own.point_spacing_m = extent_of(scene) * 1e-6;
  return Simulator(scene, panorama_scanner(options), own);
}

bool wants(std::span<const PanoramaView> views, std::initializer_list<PanoramaView> any) {
  return std::any_of(any.begin(), any.end(),
                     [&](PanoramaView v) { return std::find(views.begin(), views.end(), v) != views.end(); });
}

// Range codes of all rays of the picture, until the scale is known.
struct RangeRecord {
  std::vector<std::uint16_t> codes;
  std::uint32_t columns = 0;

  // Scale from the first to the 99th percentile, so that one near wire does not darken the rest.
  std::pair<double, double> log_scale() const {
    std::vector<std::uint64_t> counts(65536, 0);
    for (const std::uint16_t code : codes) ++counts[code];
    const std::uint64_t hits = codes.size() - counts[0];
    const auto percentile = [&](double share) {
      std::uint64_t below = 0;
      std::uint32_t code = 1;
      while (code < 65535 && (below += counts[code]) < static_cast<std::uint64_t>(share * static_cast<double>(hits)))
        ++code;
      return log_of_code(code);
    };
    if (hits == 0) return {0, 1};
    const double low = percentile(0.01), high = percentile(0.99);
    return {low, std::max(high, low + 0.1)};
  }
};

}  // namespace

struct PanoramaRenderer::Impl {
  Impl(const Scene& scene, const PanoramaOptions& o, const SimulatorConfig& config)
      : options(o),
        simulator(make_simulator(scene, o, config)),
        shading(simulator.scanner().rows(), simulator.scanner().columns(), o.supersample,
                simulator.scanner().angles(0).azimuth.in_radians(), extent_of(scene)) {
    for (const MeshInfo& mesh : scene.meshes()) largest_reflectivity = std::max(largest_reflectivity, mesh.diffuse);
  }

  // One pixel of one view: the mean over its rays, in linear light.
  LinearColour pixel(PanoramaView view, const RowWindow& window, std::uint32_t x, std::uint32_t y) const {
    const std::uint32_t side = options.supersample, columns = simulator.scanner().columns();
    LinearColour sum(0);
    for (std::uint32_t i = 0; i < side; ++i)
      for (std::uint32_t j = 0; j < side; ++j)  // columns run against the image: azimuth grows to the left
        sum += ray_colour(view, window, y * side + i, columns - 1 - (x * side + j));
    return sum / static_cast<float>(side * side);
  }

  LinearColour ray_colour(PanoramaView view, const RowWindow& window, std::uint32_t row, std::uint32_t column) const {
    const PanoramaRow& rays = window[row];
    const float range = rays.range[column];
    if (!std::isfinite(range)) return view == PanoramaView::colour ? shading.sky(row, column) : kBackdrop;
    LinearColour colour{0, 0, 0, 1};
    if (view == PanoramaView::reflectivity)
      return reflectivity_colour(
          largest_reflectivity > 0 ? static_cast<double>(rays.reflectivity[column]) / largest_reflectivity : 0);
    if (view == PanoramaView::normal) {
      for (int i = 0; i < 3; ++i)
        colour[i] = linear_from_srgb8(
            static_cast<std::uint8_t>(std::clamp(127.5f + 127.5f * rays.normal[column][i], 0.0f, 255.0f) + 0.5f));
      return colour;
    }
    const float light = shading.light(window, row, column);
    if (view == PanoramaView::mesh) {
      colour = mesh_colour(static_cast<std::uint32_t>(rays.mesh[column]));
      return {glm::vec3(colour) * light, 1};
    }
    const float clear = shading.clearness(range);
    const LinearColour haze = shading.haze();
    for (int i = 0; i < 3; ++i) {
      const float own = linear_from_srgb8(static_cast<std::uint8_t>(rays.colour[column] >> (8 * i)));
      colour[i] = haze[i] + (own * light - haze[i]) * clear;
    }
    return colour;
  }

  void draw_row(std::span<PanoramaImage> images, const RowWindow& window, std::uint32_t y) const {
    for (PanoramaImage& image : images) {
      if (image.view == PanoramaView::range) continue;
      parallel::for_all(std::uint32_t{0}, options.width,
                        [&](std::uint32_t x) { set(image.image, x, y, pixel(image.view, window, x, y)); });
    }
  }

  void draw_ranges(PanoramaImage& image, const RangeRecord& record) const {
    const auto [low, high] = record.log_scale();
    image.scale_low = std::exp2(low);
    image.scale_high = std::exp2(high);
    std::vector<LinearColour> scale(4096);
    for (std::size_t k = 0; k < scale.size(); ++k)
      scale[k] = range_colour((log_of_code(static_cast<double>(k) * 16 + 8) - low) / (high - low));
    const std::uint32_t side = options.supersample;
    parallel::for_all(std::uint32_t{0}, image.image.height, [&](std::uint32_t y) {
      for (std::uint32_t x = 0; x < image.image.width; ++x) {
        LinearColour sum(0);
        for (std::uint32_t k = 0; k < side * side; ++k) {
          const std::uint32_t column = record.columns - 1 - (x * side + k % side);
          const std::uint16_t code = record.codes[std::size_t{y * side + k / side} * record.columns + column];
          const LinearColour& ray = code == 0 ? kBackdrop : scale[code / 16];
          sum += ray / static_cast<float>(side * side);
        }
        set(image.image, x, y, sum);
      }
    });
  }

  static void set(Image& image, std::uint32_t x, std::uint32_t y, const LinearColour& colour) {
    const std::uint32_t packed = pack_srgb(colour);
    for (std::size_t c = 0; c < 4; ++c)
      image.rgba[(std::size_t{y} * image.width + x) * 4 + c] = static_cast<std::uint8_t>(packed >> (8 * c));
  }

  std::vector<PanoramaImage> render(const Vec3& position, std::span<const PanoramaView> views, const Progress& progress,
                                    const StationSetup& setup) {
    shading.turn(setup);
    std::vector<PanoramaImage> images;
    for (const PanoramaView view : views) {
      PanoramaImage image{.view = view, .image = {options.width, options.width / 2, {}}};
      image.image.rgba.resize(std::size_t{4} * image.image.width * image.image.height);
      if (view == PanoramaView::reflectivity) image.scale_high = largest_reflectivity;
      images.push_back(std::move(image));
    }
    const bool shaded = wants(views, {PanoramaView::colour, PanoramaView::mesh});
    std::uint32_t outputs = scan_range;
    if (shaded || wants(views, {PanoramaView::normal})) outputs |= scan_normal;
    if (wants(views, {PanoramaView::colour})) outputs |= scan_colour;
    if (wants(views, {PanoramaView::mesh})) outputs |= scan_ids;
    if (wants(views, {PanoramaView::reflectivity})) outputs |= scan_reflectivity;

    const std::uint32_t columns = simulator.scanner().columns(), rows = simulator.scanner().rows(),
                        side = options.supersample;
    const std::uint32_t reach = shaded ? shading.reach() : 0;
    RangeRecord record;
    record.columns = columns;
    const bool ranges = wants(views, {PanoramaView::range});
    if (ranges) record.codes.resize(std::size_t{rows} * columns);
    RowWindow window;
    std::uint32_t drawn = 0;  // rows of pixels
    const auto draw_what_can_be = [&](std::uint32_t rows_at_hand) {
      for (; (drawn + 1) * side + reach <= rows_at_hand || (rows_at_hand == rows && drawn * side < rows); ++drawn) {
        window.drop_before(std::max(drawn * side, reach) - reach);
        draw_row(images, window, drawn);
      }
    };
    const auto sink = [&](const ScanChunk& chunk) {
      for (std::uint64_t start = 0; start < chunk.ray_count; start += columns) {
        const auto cut = [&](const auto& array) {
          using Array = std::decay_t<decltype(array)>;
          if (array.empty()) return Array{};
          const auto first = array.begin() + static_cast<std::ptrdiff_t>(start);
          return Array(first, first + columns);
        };
        if (ranges) {
          std::transform(chunk.range_m.begin() + static_cast<std::ptrdiff_t>(start),
                         chunk.range_m.begin() + static_cast<std::ptrdiff_t>(start + columns),
                         record.codes.begin() + static_cast<std::ptrdiff_t>(chunk.first_ray + start), range_code);
        }
        window.push(
            {cut(chunk.range_m), cut(chunk.normal), cut(chunk.reflectivity), cut(chunk.mesh), cut(chunk.colour)});
        draw_what_can_be(window.end());
      }
    };
    if (simulator.scan({.position = position, .setup = setup}, {.outputs = outputs}, sink, progress).cancelled)
      return {};
    for (PanoramaImage& image : images) {
      if (image.view == PanoramaView::range) draw_ranges(image, record);
    }
    return images;
  }

  PanoramaOptions options;
  Simulator simulator;
  PanoramaShading shading;
  double largest_reflectivity = 0;
};

PanoramaRenderer::PanoramaRenderer(const Scene& scene, const PanoramaOptions& options, const SimulatorConfig& config)
    : impl_(std::make_unique<Impl>(scene, options, config)) {}
PanoramaRenderer::PanoramaRenderer(PanoramaRenderer&&) noexcept = default;
PanoramaRenderer& PanoramaRenderer::operator=(PanoramaRenderer&&) noexcept = default;
PanoramaRenderer::~PanoramaRenderer() = default;

std::vector<PanoramaImage> PanoramaRenderer::render(const Vec3& position, std::span<const PanoramaView> views,
                                                    const Progress& progress, const StationSetup& setup) {
  return impl_->render(position, views, progress, {.heading = setup.heading, .tilt = setup.tilt});
}

}  // namespace vantage
