// SPDX-License-Identifier: Apache-2.0
#include "stress/moved_scene.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "support/glb_builder.hpp"
#include "support/temporary_folder.hpp"
#include "vantage/objective.hpp"
#include "voxel/voxel_grid.hpp"

namespace vantage::test {
namespace {

using nlohmann::json;
using std::numbers::pi;

const std::vector<Vec3> heads{{0.3, -3.4, 1.6}, {3.7, 1.2, 1.4}, {-2.9, 2.6, 1.8}};

// A grid of columns × rows quads over at(u, v), survey frame, written in glTF axes.
template <class At>
void add_sheet(GlbBuilder& builder, int root, const char* name, const char* role, const Move* baked, int columns,
               int rows, const At& at) {
  std::vector<float> points;
  std::vector<std::uint32_t> indices;
  for (int j = 0; j <= rows; ++j) {
    for (int i = 0; i <= columns; ++i) {
      Vec3 p = at(static_cast<double>(i) / columns, static_cast<double>(j) / rows);
      if (baked) p = (*baked)(p);
      for (const double c : {p.x, p.z, -p.y}) points.push_back(static_cast<float>(c));
    }
  }
  const auto index = [&](int i, int j) { return static_cast<std::uint32_t>(j * (columns + 1) + i); };
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < columns; ++i) {
      for (const std::uint32_t k :
           {index(i, j), index(i + 1, j), index(i + 1, j + 1), index(i, j), index(i + 1, j + 1), index(i, j + 1)})
        indices.push_back(k);
    }
  }
  const json primitive{{"attributes", {{"POSITION", builder.positions(points)}}},
                       {"indices", builder.accessor(indices, 5125, "SCALAR")}};
  builder.child(root, {{"name", name},
                       {"mesh", builder.mesh(primitive)},
                       {"extras", {{"vantage", {{"role", role}, {"diffuse", 0.4}}}}}});
}

struct Survey {
  Scene scene;
  Simulator simulator;
  Network network;
  std::vector<std::vector<std::array<float, 3>>> points;
  std::vector<std::vector<std::uint32_t>> primitives, voxels;
  VoxelField field;
  double coverage = 0, user_size_m = 0;

  static Scanner scanner(const Move& move, double step_degrees) {
    Scanner s;
    s.heading = Angle::degrees(11 + move.turn_degrees);
    s.azimuth_step = s.zenith_step = Angle::degrees(step_degrees);
    s.min_range_m = 0.3 * move.scale;
    s.max_range_m = 40 * move.scale;
    return s;
  }

  Survey(const EngineInfo& engine, const Move& move, double step_degrees)
      : scene(yard(move)),
        simulator(scene, scanner(move, step_degrees),
                  {.engine = engine.engine,
                   .device_index = engine.device_index,
                   .user_size_m = 0.06 * move.scale,
                   .point_spacing_m = 0.02 * move.scale}),
        user_size_m(0.06 * move.scale) {
    for (const Vec3& head : heads) network.push_back({move(head)});
    for (std::uint32_t s = 0; s < network.size(); ++s) {
      auto& p = points.emplace_back();
      auto& t = primitives.emplace_back();
      auto& v = voxels.emplace_back();
      simulator.scan(network[s], {.outputs = scan_position | scan_ids | scan_voxel, .place = s},
                     [&](const ScanChunk& chunk) {
                       p.insert(p.end(), chunk.position.begin(), chunk.position.end());
                       t.insert(t.end(), chunk.primitive.begin(), chunk.primitive.end());
                       v.insert(v.end(), chunk.voxel.begin(), chunk.voxel.end());
                     });
    }
    const NetworkCounts counts = simulator.evaluate(network, {.field = &field});
    coverage = vantage::coverage(counts, simulator.goal_density());
  }

  Vec3 point(std::size_t station, std::size_t ray) const {
    const auto& p = points[station][ray];
    return simulator.origin() + Vec3{p[0], p[1], p[2]};
  }
};

double predicted_coverage(const Survey& original, const Survey& moved, const Move& move) {
  const SceneData& data = moved.scene.data();
  const VoxelGrid grid = VoxelGrid::build(data, moved.user_size_m);
  std::vector<double> counts(grid.size());
  for (std::size_t s = 0; s < original.points.size(); ++s) {
    for (std::size_t k = 0; k < original.points[s].size(); ++k) {
      if (original.voxels[s][k] == kNoVoxel) continue;
      const Vec3 p = move(original.point(s, k)) - data.origin;
      const std::uint32_t voxel_index =
          grid.index_of({static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)});
      if (voxel_index != kNoVoxel) counts[voxel_index] += 1;
    }
  }
  double sum = 0;
  for (const double n : counts) sum += std::min(n / moved.simulator.goal_density(), 1.0);
  return sum / static_cast<double>(grid.size());
}

}  // namespace

Vec3 Move::operator()(const Vec3& p) const {
  const double a = turn_degrees * pi / 180, c = std::cos(a), s = std::sin(a);
  return shift + Vec3{c * p.x - s * p.y, s * p.x + c * p.y, p.z} * scale;
}

std::vector<Move> shifts_and_scales() {
  return {{"1 km", {1000, -1000, 0}},
          {"100 km", {100'000, 100'000, 100}},
          {"UTM (500 000, 4 500 000)", {500'000, 4'500'000, 230}},
          {"UTM, centimetres in the seventh digit", {512'345.67, 5'403'210.98, 471.23}},
          {"× 0.001", {}, 0.001},
          {"× 1000", {}, 1000},
          {"× 0.001 at UTM", {500'000, 4'500'000, 230}, 0.001}};
}

std::vector<Move> turns() {
  std::vector<Move> all;
  for (const double degrees : {0.37, 7.3, 33.3, 91.7, 201.9}) {
    Move move{"", {}, 1, degrees};
    move.name = std::to_string(degrees).substr(0, std::to_string(degrees).find_last_not_of('0') + 1) + "°";
    all.push_back(move);
  }
  return all;
}

Scene yard(const Move& move, bool baked) {
  GlbBuilder builder;
  const double half = move.turn_degrees * pi / 360, s = move.scale;
  const int root = builder.node(baked ? json{{"name", "root"}}
                                      : json{{"name", "root"},
                                             {"translation", {move.shift.x, move.shift.z, -move.shift.y}},
                                             {"rotation", {0, std::sin(half), 0, std::cos(half)}},
                                             {"scale", {s, s, s}}});
  const Move* bake = baked ? &move : nullptr;
  add_sheet(builder, root, "ground", "blocking", bake, 20, 20, [](double u, double v) {
    const double x = 12 * u - 6, y = 12 * v - 6;
    return Vec3{x, y, 0.13 * std::sin(0.7 * x) * std::cos(0.9 * y) - 0.2};
  });
  add_sheet(builder, root, "boiler", "surveyed", bake, 28, 14, [](double u, double v) {
    return Vec3{0.7, 0.4, 1.31} +
           Vec3{std::sin(pi * v) * std::cos(2 * pi * u), std::sin(pi * v) * std::sin(2 * pi * u), std::cos(pi * v)} *
               1.1;
  });
  add_sheet(builder, root, "leaning wall", "surveyed", bake, 5, 4, [](double u, double v) {
    return Vec3{-2.3 + 0.31 * v, -2.1 + 4.1 * u + 0.13 * v, 2.3 * v};
  });
  add_sheet(builder, root, "fence", "blocking", bake, 6, 1, [](double u, double v) {
    return Vec3{2.6, -3.1 + 5.2 * u, 1.1 * v};
  });
  const TemporaryFolder folder;
  builder.write_glb(folder / "yard.glb");
  return Scene::load(folder / "yard.glb");
}

MovedFigures compare_moved(const EngineInfo& engine, const Move& move, double step_degrees) {
  const Survey original(engine, {}, step_degrees), moved(engine, move, step_degrees);
  const Vec3 zero = move({}), x = move({1, 0, 0}) - zero, y = move({0, 1, 0}) - zero;
  MovedFigures figures;
  figures.coverage = original.coverage;
  figures.moved_coverage = moved.coverage;
  figures.counts_equal = original.field.count == moved.field.count && original.field.stations == moved.field.stations;
  for (std::size_t s = 0; s < heads.size(); ++s) {
    figures.rays += original.primitives[s].size();
    for (std::size_t k = 0; k < original.primitives[s].size(); ++k) {
      const bool same_hit = original.primitives[s][k] == moved.primitives[s][k];
      figures.differing_hits += !same_hit;
      figures.differing += !same_hit || original.voxels[s][k] != moved.voxels[s][k];
      if (!same_hit || original.primitives[s][k] == 0xFFFFFFFFu) continue;
      const Vec3 d = moved.point(s, k) - zero, p = original.point(s, k);
      const double square = move.scale * move.scale;
      const Vec3 back{dot(d, x) / square, dot(d, y) / square, d.z / move.scale};
      figures.farthest_m = std::max(figures.farthest_m, std::sqrt(dot(back - p, back - p)));
    }
  }
  figures.predicted_coverage = predicted_coverage(original, moved, move);
  return figures;
}

}  // namespace vantage::test
