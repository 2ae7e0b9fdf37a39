// SPDX-License-Identifier: Apache-2.0
// Deliberately awkward sites on which every way of counting must agree in every voxel.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "trace/tracer.hpp"

namespace vantage::test {

struct RandomSite {
  TraceScene scene;
  std::vector<TraceStation> stations;
};
// Triangles of all sizes, slivers, walls, coincident walls of both roles, grazing planes and balls; seven heads
// anywhere, also on surfaces.
RandomSite random_site(std::uint64_t seed);
// The same, seen by a scanner of uneven rows.
RandomSite random_uneven_site(std::uint64_t seed);
// The same, seen by a scanner whose rays form no grid: some aim anywhere, most along a curve, some twice.
RandomSite random_listed_site(std::uint64_t seed);
// A room with boards and slats, and a scanner of which thousands of rays may cross a voxel; some with normals that
// lean.
RandomSite random_fine_site(std::uint64_t seed);
// Walls, and folded meshes that are stored once and placed turned, mirrored and scaled unequally.
RandomSite random_placed_site(std::uint64_t seed);

// Rays traced by exact evaluations.
struct RaysTraced {
  std::uint64_t all = 0, skipping = 0;
};

// Compares exact evaluations, with and without skipping, and a sample of all voxels, with and without stopping at the
// goal, with and without noise. `make` makes the engine. Uses seeds `first` to `last`, or those of
// VANTAGE_SEEDS=first..last.
RaysTraced expect_every_way_agrees(const std::function<std::unique_ptr<Tracer>(const TraceScene&)>& make,
                                   std::uint64_t first, std::uint64_t last,
                                   RandomSite (*site_of)(std::uint64_t seed) = random_site);

}  // namespace vantage::test
