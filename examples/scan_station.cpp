// SPDX-License-Identifier: Apache-2.0
// Scans a site from the first free spot of its search area and writes the points: scan_station SCENE POINTS.ply
#include <array>
#include <cstdio>
#include <optional>
#include <vantage/vantage.hpp>

using namespace vantage;

// The head of a scanner on the first spot of a 16 × 16 grid over (u, v) that has ground below it and nothing close to
// it.
static std::optional<Vec3> free_spot(Site& site) {
  const SearchArea& area = site.area();
  const Uv low = area.uv_min(), high = area.uv_max();
  for (int k = 0; k < 256; ++k) {
    const Uv uv{low.u + (high.u - low.u) * (k % 16 + 0.5) / 16, low.v + (high.v - low.v) * (k / 16 + 0.5) / 16};
    const std::optional<Vec3> ground = area.locate(uv);
    if (ground && !site.clash().clashes(*ground)) return *ground + Vec3{0, 0, site.scanner().height_m};
  }
  return std::nullopt;
}

int main(int argc, char** argv) try {
  if (argc != 3) return std::fprintf(stderr, "usage: scan_station SCENE POINTS.ply\n"), 2;

  const std::array steps{Angle::degrees(0.2), Angle::degrees(0.2)};
  Site site = Site::open(argv[1], {.steps = steps, .height_m = 1.5});
  const std::optional<Vec3> head = free_spot(site);
  if (!head) return std::fprintf(stderr, "no place to stand\n"), 1;

  Simulator& simulator = site.simulator();
  constexpr std::uint32_t outputs = scan_position | scan_normal | scan_colour;
  PointCloudWriter points(argv[2], simulator.origin(), outputs);
  const ScanSummary scan = simulator.scan({.position = *head}, {.outputs = outputs},
                                          [&](const ScanChunk& chunk) { points.write(chunk, /*station=*/0); });
  points.close();
  std::printf("%llu rays, %llu points from (%.3f, %.3f, %.3f)\n", static_cast<unsigned long long>(scan.rays),
              static_cast<unsigned long long>(scan.points), head->x, head->y, head->z);
  return 0;
} catch (const Error& error) {
  std::fprintf(stderr, "error: %s\n", error.what());
  for (const auto& line : error.details()) std::fprintf(stderr, "  - %s\n", line.c_str());
  return 1;
}
