// SPDX-License-Identifier: Apache-2.0
// Shows the predicted registration error on the surface.

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "core/parallel.hpp"
#include "core/text.hpp"
#include "export/voxel_errors.hpp"
#include "export/voxel_map.hpp"
#include "export/voxel_ply.hpp"
#include "vantage/error.hpp"
#include "vantage/export.hpp"

namespace vantage {
namespace {

constexpr Colour kUnseen{0.86, 0.86, 0.87};
// More voxels than a picture has pixels for.
constexpr std::uint64_t kMostDrawn = 200'000;

void check(const Simulator& simulator, const VoxelField& field) {
  const std::uint64_t voxels = simulator.voxel_count();
  if (field.stations.voxels() != voxels)
    throw Error(Errc::invalid_argument, "registration map: the voxel field has stations of " +
                                            std::to_string(field.stations.voxels()) + " voxels, the scene " +
                                            std::to_string(voxels) + " surveyed ones");
}

double largest(std::span<const float> errors) {
  const double most = errors.empty() ? 0 : static_cast<double>(*std::ranges::max_element(errors));
  return most > 0 ? most : 1;
}

}  // namespace

std::vector<float> voxel_errors_mm(const Simulator& simulator, const VoxelField& field, const RegistrationError& error,
                                   std::span<const std::uint32_t> voxels) {
  std::vector<float> found(voxels.size());
  parallel::for_all(std::size_t{0}, voxels.size(), [&](std::size_t k) {
    const Vec3 place = simulator.voxel_centre(voxels[k]) - simulator.origin();
    double squares = 0;
    int seen = 0;
    field.stations.for_each_station(voxels[k], [&](std::size_t station) {
      const double one = error.at(station, place);
      squares += one * one;
      ++seen;
    });
    found[k] = seen > 0 ? static_cast<float>(1000 * std::sqrt(squares / seen)) : -1;
  });
  return found;
}

void write_registration_ply(const std::filesystem::path& file, const Simulator& simulator, const VoxelField& field,
                            const RegistrationError& error, PlyCoordinates coordinates) {
  check(simulator, field);
  std::vector<std::uint32_t> voxels;
  for (std::uint32_t voxel = 0; voxel < simulator.voxel_count(); ++voxel) {
    bool seen = false;
    field.stations.for_each_station(voxel, [&](std::size_t) { seen = true; });
    if (seen) voxels.push_back(voxel);
  }
  const std::vector<float> errors = voxel_errors_mm(simulator, field, error, voxels);
  const double most = largest(errors);
  write_voxel_ply(file, coordinates, simulator, {{"float", "error_mm"}}, voxels.size(),
                  [&](std::uint64_t k, std::string& bytes) {
                    append(bytes, errors[k]);
                    return VoxelVertex{voxels[k], ramp(kRisingRamp, static_cast<double>(errors[k]) / most)};
                  });
}

void draw_registration(const std::filesystem::path& file, Site& site, const VoxelField& field,
                       const RegistrationError& error, std::span<const PlacedStation> stations,
                       const std::string& title) {
  const Simulator& simulator = site.simulator();
  check(simulator, field);
  const std::vector<std::uint32_t> sample = simulator.sampled_voxels(std::min(kMostDrawn, simulator.voxel_count()));
  const std::vector<float> errors = voxel_errors_mm(simulator, field, error, sample);
  const double most = largest(errors);
  // The worst on top, so that nothing hides it.
  std::vector<std::size_t> order(sample.size());
  for (std::size_t k = 0; k < order.size(); ++k) order[k] = k;
  std::ranges::stable_sort(order, {}, [&](std::size_t k) { return errors[k]; });
  std::vector<ColouredVoxel> voxels;
  for (const std::size_t k : order)
    voxels.push_back({sample[k], errors[k] < 0 ? kUnseen : ramp(kRisingRamp, static_cast<double>(errors[k]) / most)});
  const auto legend = [&](Canvas& canvas, Point at) {
    canvas.text(at, "Predicted error", {.size = 12.5, .bold = true});
    canvas.text({at.x, at.y + 17}, "one sigma, after registration", {.size = 12.5});
    at.y += 38;
    constexpr int kSteps = 60;
    constexpr double kHeight = 150;
    for (int step = 0; step < kSteps; ++step)
      canvas.fill({at.x, at.y + kHeight * (kSteps - 1 - step) / kSteps, 24, kHeight / kSteps + 0.5},
                  ramp(kRisingRamp, (step + 0.5) / kSteps));
    for (const double share : {0.0, 0.5, 1.0})
      canvas.text({at.x + 34, at.y + kHeight * (1 - share)}, fixed(share * most, most < 10 ? 1 : 0) + " mm",
                  {.size = 12.5});
    at.y += kHeight + 24;
    canvas.fill({at.x, at.y - 7, 24, 14}, kUnseen);
    canvas.text({at.x + 34, at.y}, "not seen", {.size = 12.5});
    return Point{at.x, at.y + 24};
  };
  constexpr double kLegend = 230;
  draw_voxel_map(file, site, voxels, stations, title, "Surveyed surfaces from above, the largest error on top", kLegend,
                 legend);
}

}  // namespace vantage
