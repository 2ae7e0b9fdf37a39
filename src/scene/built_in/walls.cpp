// SPDX-License-Identifier: Apache-2.0
// The two simple cases of the method (sections 5.1.1 and 5.1.2). Nothing but the walls can be hit: the paper's point
// counts hold no point of the ground, and its search area is not intersectable.
#include <cmath>

#include "scene/built_in/model.hpp"

namespace vantage::built_in {
namespace {

constexpr double kWallDiffuse = 0.1;
constexpr std::array<float, 3> kWallColour{0.55F, 0.5F, 0.45F}, kFloorColour{0.3F, 0.32F, 0.3F};

Float3 rounded(const Vec3& p) { return {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)}; }

// A rectangle from `corner` over the edges `across` and `up`, in columns × rows cells of two triangles; its normal is
// across × up.
void add_rectangle(Mesh& mesh, const Vec3& corner, const Vec3& across, const Vec3& up, int columns, int rows) {
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  const Vec3 n = cross(across, up);
  const Float3 normal = rounded(n * (1 / std::sqrt(dot(n, n))));
  for (int j = 0; j <= rows; ++j)
    for (int i = 0; i <= columns; ++i) {
      mesh.positions.push_back(
          rounded(corner + across * (static_cast<double>(i) / columns) + up * (static_cast<double>(j) / rows)));
      mesh.normals.push_back(normal);
    }
  const auto width = static_cast<std::uint32_t>(columns) + 1;
  for (std::uint32_t j = 0; j < static_cast<std::uint32_t>(rows); ++j)
    for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(columns); ++i) {
      const std::uint32_t a = first + j * width + i, b = a + 1, c = a + width, d = c + 1;
      mesh.indices.insert(mesh.indices.end(), {a, b, d, a, d, c});
    }
}

Part wall(const std::string& name, const Vec3& corner, const Vec3& across, double height, int columns, int rows) {
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

Model three_walls() {
  constexpr double kWidth = 5, kHeight = 2.5, kNear = 10, kFar = 30, kAside = 20 * 0.017453292519943295;
  // A wall across the line of sight at `azimuth`, facing the origin.
  const auto facing = [&](const std::string& name, double distance, double azimuth) {
    const Vec3 towards{std::cos(azimuth), std::sin(azimuth), 0}, left{-towards.y, towards.x, 0};
    return wall(name, towards * distance + left * (kWidth / 2), left * -kWidth, kHeight, 1, 1);
  };
  Model model;
  model.parts = {facing("wall-centre", kNear, 0), facing("wall-left", kFar, kAside),
                 facing("wall-right", kFar, -kAside), floor(6, 0)};
  model.defaults = to_json({.step = 0.0356, .height = 1.5, .noise = "off", .spacing = 0.006, .user_size = 0.01});
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
