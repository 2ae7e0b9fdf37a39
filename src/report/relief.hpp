// SPDX-License-Identifier: Apache-2.0
// A site from straight above: what a map shows of it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "report/colour.hpp"
#include "scene/scene_data.hpp"

namespace vantage {

inline constexpr Colour kSurveyedTint{0.93, 0.78, 0.52}, kBlockingTint{0.87, 0.88, 0.89};

// A window of the survey frame's x-y plane, cut into square pixels; row 0 is the northernmost (largest y).
struct MapWindow {
  double x_min = 0, y_max = 0;
  double pixel_m = 1;
  std::size_t columns = 0, rows = 0;
};

// The topmost surface below `z_cut` (survey frame) under each pixel's centre.
struct HeightBuffer {
  MapWindow window;
  std::vector<float> z;                  // local frame; −infinity where there is nothing
  std::vector<std::uint32_t> triangle;   // of the scene; 2^32 − 1 where there is nothing
};

HeightBuffer look_from_above(const SceneData& scene, const MapWindow& window, double z_cut);

// Shaded relief, light from the north-west, surveyed meshes tinted. 0xAARRGGBB, premultiplied; transparent where there is nothing.
std::vector<std::uint32_t> shade(const SceneData& scene, const HeightBuffer& heights);

// Halves both sides by averaging two by two. REQUIRES: even numbers of columns and rows.
std::vector<std::uint32_t> halve(const std::vector<std::uint32_t>& pixels, std::size_t columns);

}  // namespace vantage
