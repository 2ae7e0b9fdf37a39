// SPDX-License-Identifier: Apache-2.0
#include "scene/changed_scene.hpp"

#include <algorithm>
#include <memory>
#include <utility>

#include "scene/scene_data.hpp"
#include "vantage/error.hpp"

namespace vantage {
namespace {

// A cube's face: the neighbour behind it, and corners (bit 0: x, 1: y, 2: z), counter-clockwise from outside.
struct CellFace {
  SolidCell towards;
  std::array<int, 4> corners;
};
constexpr std::array kCellFaces{CellFace{{-1, 0, 0}, {0, 4, 6, 2}}, CellFace{{1, 0, 0}, {1, 3, 7, 5}},
                                CellFace{{0, -1, 0}, {0, 1, 5, 4}}, CellFace{{0, 1, 0}, {2, 6, 7, 3}},
                                CellFace{{0, 0, -1}, {0, 2, 3, 1}}, CellFace{{0, 0, 1}, {4, 5, 7, 6}}};

// Appends the faces between solid cells and free space, as `mesh`.
void add_cells(SceneData& data, const SolidCells& solid, MeshInfo mesh) {
  const auto first_triangle = static_cast<std::uint32_t>(data.triangles.size());
  const Vec3 corner = solid.corner - data.origin;
  for (const SolidCell& cell : solid.cells)
    for (const CellFace& face : kCellFaces) {
      const SolidCell beside{cell[0] + face.towards[0], cell[1] + face.towards[1], cell[2] + face.towards[2]};
      if (std::ranges::binary_search(solid.cells, beside)) continue;
      const auto first = static_cast<std::uint32_t>(data.positions.size());
      for (const int k : face.corners)
        data.positions.push_back(
            narrow(corner + Vec3{static_cast<double>(cell[0] + (k & 1)), static_cast<double>(cell[1] + (k >> 1 & 1)),
                                 static_cast<double>(cell[2] + (k >> 2 & 1))} *
                                solid.cell_m));
      data.triangles.push_back({first, first + 1, first + 2});
      data.triangles.push_back({first, first + 2, first + 3});
    }
  const auto count = static_cast<std::uint32_t>(data.triangles.size()) - first_triangle;
  if (count == 0) return;
  data.materials.emplace_back();
  data.ranges.push_back({first_triangle, count, static_cast<std::uint32_t>(data.materials.size() - 1)});
  mesh.triangle_count = count;
  data.meshes.push_back(std::move(mesh));
  if (!data.normals.empty()) data.normals.resize(data.positions.size());
  if (!data.texcoords.empty()) data.texcoords.resize(data.positions.size());
  if (!data.colours.empty()) data.colours.resize(data.positions.size(), 0xFFFFFFFF);
}

}  // namespace

Scene changed_scene(const Scene& scene, const SolidCells& cells, std::span<const std::uint32_t> removed,
                    const SolidCells& unknown, std::uint32_t unknown_weight) {
  const std::shared_ptr<SceneData> after = flat_copy(scene.data());
  const std::vector<Triangle> triangles = std::exchange(after->triangles, {});
  const std::vector<MeshRange> ranges = std::exchange(after->ranges, {});
  const std::vector<MeshInfo> meshes = std::exchange(after->meshes, {});
  after->local_bounds = {};
  bool added = false;
  const auto add = [&] {
    if (std::exchange(added, true)) return;
    add_cells(*after, cells, {.name = kNotInModel, .role = Role::blocking});
    add_cells(*after, unknown, {.name = kUnknown, .role = Role::surveyed, .weight = unknown_weight});
  };
  for (std::uint32_t m = 0; m < meshes.size(); ++m) {
    if (meshes[m].glass) add();  // meshes of glass come last
    if (std::ranges::find(removed, m) != removed.end()) continue;
    const MeshRange& range = ranges[m];
    const auto first = triangles.begin() + range.first_triangle;
    after->ranges.push_back(
        {static_cast<std::uint32_t>(after->triangles.size()), range.triangle_count, range.material});
    after->meshes.push_back(meshes[m]);
    after->triangles.insert(after->triangles.end(), first, first + range.triangle_count);
  }
  add();
  if (std::ranges::none_of(after->meshes, [](const MeshInfo& mesh) { return mesh.role == Role::surveyed; }))
    throw Error(Errc::malformed_file, "the scans saw through all that is to be surveyed: are they of another site?");
  for (const Triangle& t : after->triangles)
    for (const std::uint32_t v : t) after->local_bounds.extend(widen(after->positions[v]));
  return Scene(after);
}

}  // namespace vantage
