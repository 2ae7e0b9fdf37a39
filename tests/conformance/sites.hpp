// SPDX-License-Identifier: Apache-2.0
// Sites on which every engine must give the same answers.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "support/reference_tracer.hpp"
#include "trace/tracer.hpp"

namespace vantage::test {

struct TestSite {
  std::string name;
  std::shared_ptr<const SceneData> scene;
  std::shared_ptr<const VoxelGrid> grid;
  std::shared_ptr<const RayPattern> pattern;
  std::shared_ptr<const NoiseModel> noise, no_noise;
  std::shared_ptr<const LimitModel> limits;  // several of each kind, so that each drops some points and passes others
  std::vector<TraceStation> stations;        // at least four, with places 0, 1, …; inside and outside

  TraceScene trace_scene(bool noisy, bool limited = false) const {
    return {
        .scene = scene, .grid = grid, .scanners = {{pattern, noisy ? noise : no_noise, limited ? limits : nullptr}}};
  }
  std::uint64_t rays() const { return std::uint64_t{pattern->rows()} * pattern->columns(); }
  // Computed once for each station and kind.
  const std::vector<ReferenceHit>& reference(std::size_t station, bool noisy, bool limited = false) const;
};

// three-walls, four-walls, boiler-house, pump-hall, whose pumps share a mesh. Made once.
const std::vector<TestSite>& sites();

}  // namespace vantage::test
