// SPDX-License-Identifier: Apache-2.0
// The two simple cases of the method (sections 5.1.1 and 5.1.2). Only the walls can be hit: the paper's point counts
// include no ground, and its search area is not intersectable.
#include <cmath>

#include "generate/shapes.hpp"

namespace vantage::built_in {
namespace {

constexpr double kWallDiffuse = 0.1;
constexpr std::array<float, 3> kWallColour{0.55F, 0.5F, 0.45F}, kFloorColour{0.3F, 0.32F, 0.3F};

Part wall(const std::string& name, const dvec3& corner, const dvec3& across, double height, int columns, int rows) {
  Part part{name, Role::surveyed, kWallDiffuse, kWallColour, {}};
  add_rectangle(part.mesh, corner, across, {0, 0, height}, columns, rows);
  return part;
}

// A square floor around the origin, without the square hole; (u, v) spans [0, 1]² over the whole square.
Part floor(double side, double hole) {
  Part part{"floor", Role::search, {}, kFloorColour, {}};
  const double outer = side / 2, inner = hole / 2;
  if (hole > 0) {
    const double cuts[4] = {-outer, -inner, inner, outer};
    for (int j = 0; j < 3; ++j)
      for (int i = 0; i < 3; ++i)
        if (i != 1 || j != 1)
          add_rectangle(part.mesh, {cuts[i], cuts[j], 0}, {cuts[i + 1] - cuts[i], 0, 0}, {0, cuts[j + 1] - cuts[j], 0},
                        1, 1);
  } else {
    add_rectangle(part.mesh, {-outer, -outer, 0}, {side, 0, 0}, {0, side, 0}, 1, 1);
  }
  for (const Float3& p : part.mesh.positions)
    part.mesh.uvs.push_back({static_cast<float>((static_cast<double>(p.x) + outer) / side),
                             static_cast<float>((static_cast<double>(p.y) + outer) / side)});
  return part;
}

}  // namespace

nlohmann::json to_json(const Defaults& d) {
  return {{"scanner",
           {{"step", d.step},
            {"horizontal", 360},
            {"vertical", 300},
            {"height", d.height},
            {"range", {0.1, 130}},
            {"noise", d.noise}}},
          {"spacing", d.spacing},
          {"user-size", d.user_size},
          {"security", {0.6, 1.35, 0.5}}};
}

// The paper says "5 m wide and 2.5 m high, placed at 10 m (center) and 30 m (sides)", names voxels of 1 cm that hold
// 2.8 points 6 mm apart, and counts 383 659 points. These figures determine where the sides stand. With walls
// perpendicular to one axis, equation 2 gives voxels of 1 cm if the middles of the sides are 17.84 to 17.93 m aside;
// there, steps of 6 mm at 10 m catch 383 360 to 383 654 points. Within these centimetres the position decides the
// walls' depth in their voxels, and so how many points noise moves out of them: at 17.875 m about as many as in the
// paper.
Model three_walls() {
  constexpr double kWidth = 5, kHeight = 2.5, kNear = 10, kFar = 30, kAside = 17.875, kSpacing = 0.006;
  constexpr double kDegrees = 57.295779513082323;
  // Perpendicular to the x axis, its front towards the scanner.
  const auto facing = [&](const std::string& name, double x, double y) {
    return wall(name, {x, y + kWidth / 2, 0}, {0, -kWidth, 0}, kHeight, 1, 1);
  };
  Model model;
  model.parts = {facing("wall-centre", kNear, 0), facing("wall-left", kFar, kAside),
                 facing("wall-right", kFar, -kAside), floor(6, 0)};
  model.defaults = to_json(
      {.step = kSpacing / kNear * kDegrees, .height = 1.5, .noise = "off", .spacing = kSpacing, .user_size = 0.01});
  model.defaults["station"] = {0, 0, 1.5};
  return model;
}

Model four_walls() {
  constexpr double kSide = 10, kHeight = 5, kHalf = kSide / 2;
  Model model;
  model.parts = {wall("wall-south", {-kHalf, -kHalf, 0}, {kSide, 0, 0}, kHeight, 10, 5),
                 wall("wall-east", {kHalf, -kHalf, 0}, {0, kSide, 0}, kHeight, 10, 5),
                 wall("wall-north", {kHalf, kHalf, 0}, {-kSide, 0, 0}, kHeight, 10, 5),
                 wall("wall-west", {-kHalf, kHalf, 0}, {0, -kSide, 0}, kHeight, 10, 5), floor(30, kSide)};
  model.defaults = to_json({.step = 0.1, .height = 1.5, .noise = "off", .spacing = 0.01, .user_size = 0.1});
  return model;
}

}  // namespace vantage::built_in
