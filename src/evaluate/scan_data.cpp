// SPDX-License-Identifier: Apache-2.0
#include "evaluate/scan_data.hpp"

namespace vantage {
namespace {

// Bytes of a point as point_cloud_writer.cpp writes it, with its reflectivity: point format 7 of LAS 1.4; three
// coordinates, a row, a column and an intensity of E57, in pages of 1020 bytes with a checksum of four.
constexpr double kLas = 36, kPages = 1024.0 / 1020;
constexpr double kSinglesReach_m = 256;
constexpr std::uint32_t kShort = 65'536;

double e57_bytes(const Scanner& scanner) {
  const auto index = [](std::uint32_t count) { return count > kShort ? 4 : 2; };
  const int coordinate = scanner.max_range_m > kSinglesReach_m ? 8 : 4;
  return kPages * (3 * coordinate + index(scanner.rows()) + index(scanner.columns()) + 4);
}

}  // namespace

std::optional<ScanData> scan_data(const CountedNetwork& network, const Simulator& simulator,
                                  const Simulator* surroundings) {
  const std::size_t stations = network.stations.size();
  const bool counted = network.surveyed.points.size() == stations && network.surveyed.voxels >= simulator.voxel_count();
  const NetworkCounts* const around = network.surroundings;
  const bool shared = around && surroundings && around->points_on_surveyed.size() == stations &&
                      around->voxels >= surroundings->voxel_count();
  if (stations == 0 || (!counted && !shared)) return std::nullopt;
  ScanData data;
  for (std::size_t k = 0; k < stations; ++k) {
    const PlacedStation& station = network.stations[k];
    if (station.existing || !active(station)) continue;
    const Scanner& scanner = simulator.scanners()[station.setup.scanner];
    double points = 0;
    if (counted)
      points = static_cast<double>(network.surveyed.points[k]);
    else if (const std::uint64_t rays = surroundings->scanners()[station.setup.scanner].rays(); rays > 0)
      points = static_cast<double>(around->points_on_surveyed[k]) / static_cast<double>(rays) *
               static_cast<double>(scanner.rays());
    data.points += points, data.las_bytes += kLas * points, data.e57_bytes += e57_bytes(scanner) * points;
  }
  return data;
}

}  // namespace vantage
