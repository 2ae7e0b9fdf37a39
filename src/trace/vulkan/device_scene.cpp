// SPDX-License-Identifier: Apache-2.0
#include "trace/vulkan/device_scene.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <type_traits>
#include <vector>

#include "core/normal_table.hpp"
#include "core/parallel.hpp"
#include "scene/local_from_mesh.hpp"
#include "trace/glass_faces.hpp"
#include "trace/triangle_neighbours.hpp"
#include "trace/vulkan/compute_bvh/bvh.hpp"
#include "trace/vulkan/placed_meshes.hpp"

namespace vantage::vulkan {

static_assert(std::is_trivially_copyable_v<TraceParameters> && sizeof(Float3) == sizeof(vec3));

namespace {

// Share of the distances involved. A ray that is moved into the mesh's frame is rounded by some 2^-22 of them, times
// the condition of the place; so are placed corners, and the way to them.
constexpr double kDoubtOfPlace = 0x1p-20;

MeshTransform mesh_transform(const SceneData& scene, std::size_t k) {
  const MeshPlace& place = scene.places[k];
  const MeshPlacement matrix{0, 0, local_from_mesh(scene, place)};
  const auto& m = matrix.columns;
  const auto size = [](const Vec3& v) { return std::sqrt(dot(v, v)); };
  const double scale = 1 / std::max({size(place.normal_x), size(place.normal_y), size(place.normal_z)});
  const auto column = [&](const Vec3& v) {
    const Float3 f = narrow(v * scale);
    return vec3{f.x, f.y, f.z};
  };
  const Box& bounds = scene.local_bounds;
  const Vec3 farthest{std::max(std::abs(bounds.min.x), std::abs(bounds.max.x)),
                      std::max(std::abs(bounds.min.y), std::abs(bounds.max.y)),
                      std::max(std::abs(bounds.min.z), std::abs(bounds.max.z))};
  return {.x = {m[0], m[1], m[2]},
          .y = {m[3], m[4], m[5]},
          .z = {m[6], m[7], m[8]},
          .origin = {m[9], m[10], m[11]},
          .normal_x = column(place.normal_x),
          .normal_y = column(place.normal_y),
          .normal_z = column(place.normal_z),
          .doubt = static_cast<float>(kDoubtOfPlace * matrix.condition()),
          .size = static_cast<float>(size(farthest) + length(matrix.origin())),
          .mirrored = place.mirrored ? 1u : 0u};
}

// Fills triangle_neighbours() of those stored from `first` on, by their stored numbers.
void fill_neighbours(const SceneData& scene, std::uint32_t first, std::uint32_t count,
                     std::vector<std::uint32_t>& neighbours) {
  std::vector<Triangle> own(scene.triangles.begin() + first, scene.triangles.begin() + first + count);
  const auto [low, high] = corner_range(own);
  for (Triangle& t : own)
    for (std::uint32_t& v : t) v -= low;
  const auto found = triangle_neighbours(std::span(scene.positions).subspan(low, high - low + 1), own);
  for (std::size_t k = 0; k < found.size(); ++k)
    neighbours[3 * std::size_t{first} + k] = found[k] == no_primitive ? no_primitive : found[k] + first;
}

// Returns three neighbours for each stored triangle: numbers in the scene for triangles stored in place, stored numbers
// for those of shared meshes (lib/scene_triangle.glsl).
std::vector<std::uint32_t> stored_neighbours(const SceneData& scene) {
  if (!scene.shares()) return triangle_neighbours(scene.positions, scene.opaque_triangles());
  std::vector<std::uint32_t> neighbours(3 * scene.triangles.size(), no_primitive);
  std::vector<MeshInstance> own;  // ascending
  std::set<std::uint32_t> known;
  for (const MeshInstance& instance : scene.instances) {
    if (instance.first_triangle >= scene.opaque_count()) continue;
    if (instance.place == MeshInstance::kNoPlace)
      own.push_back(instance);
    else if (known.insert(instance.first_stored).second)
      fill_neighbours(scene, instance.first_stored, instance.triangle_count, neighbours);
  }
  if (own.empty()) return neighbours;
  const std::uint32_t count = own.back().first_stored + own.back().triangle_count;
  fill_neighbours(scene, 0, count, neighbours);
  for (std::uint32_t& other : std::span(neighbours).first(3 * std::size_t{count})) {
    if (other == no_primitive) continue;
    const MeshInstance& run = *(std::ranges::upper_bound(own, other, {}, &MeshInstance::first_stored) - 1);
    other = other - run.first_stored + run.first_triangle;
  }
  return neighbours;
}

}  // namespace

DeviceScene::DeviceScene(Device& device, Commands& commands, const TraceScene& scene, const Traversal& traversal,
                         std::span<const DeviceScanner> scanners)
    : device_(device), commands_(commands), scene_(scene), scanners_(scanners), watertight_(traversal.is_watertight()) {
  std::ranges::copy(traversal.binding().arrays, parameters_.traversal);
  upload_grid();
  TraceParameters& p = parameters_;
  p.has_normals = scene_.scene->normals.empty() ? 0 : 1;
  if (scene_.scene->shares()) upload_places();
  if (weakens_through_glass(scene_)) upload_glass();
  const auto noisy = [](const DeviceScanner& scanner) { return scanner.noise(); };
  const auto limited = [](const DeviceScanner& scanner) { return scanner.limits(); };
  if (std::ranges::any_of(scanners_, noisy)) {
    normal_table_ = make_device_buffer<float>(device_, commands_, normal_table(), "normal table");
    p.normal_table = normal_table_.address();
  }
  if (std::ranges::any_of(scanners_, noisy) || std::ranges::any_of(scanners_, limited)) {
    upload_shading();
  } else {
    write_parameters();
  }
}

void DeviceScene::take(const SceneDifference& difference, std::span<const KeptRun> moved) {
  const SceneData& scene = *scene_.scene;
  upload_grid();
  for (const KeptRun& run : moved) {
    const auto [low, high] = corner_range(std::span(scene.triangles).subspan(run.first, run.count));
    const auto write = [&, low = low, count = high - low + 1](const Buffer& to, const std::vector<Float3>& from) {
      if (to) commands_.upload(to, &from[low], count * sizeof(Float3), low * sizeof(Float3));
    };
    write(positions_, scene.positions);
    write(normals_, scene.normals);
  }
  if (neighbours_) {
    std::vector<std::uint32_t> neighbours(std::size_t{3} * scene.opaque_count());
    commands_.download(neighbours_, neighbours.data(), std::span(neighbours).size_bytes());
    neighbours = neighbours_after(neighbours, scene, difference);
    commands_.upload(neighbours_, neighbours.data(), std::span(neighbours).size_bytes());
  }
  write_parameters();
}

void DeviceScene::upload_grid() {
  const VoxelGrid& grid = *scene_.grid;
  demands_ = make_device_demands(device_, commands_, grid.demands());
  bricks_ = make_device_buffer<VoxelBrick>(device_, commands_, grid.bricks(), "voxel bricks");
  slots_ = make_device_buffer<BrickSlot>(device_, commands_, grid.slots(), "brick slots");
  TraceParameters& p = parameters_;
  p.bricks = bricks_.address();
  p.slots = slots_.address();
  p.voxel_min = {grid.min()[0], grid.min()[1], grid.min()[2]};
  p.voxel_inverse_size = grid.inverse_size();
  p.voxel_cells = 1u << grid.depth();
  p.slot_mask = static_cast<std::uint32_t>(grid.slots().size() - 1);
  p.brick_count = static_cast<std::uint32_t>(grid.bricks().size());
  p.brick_size = static_cast<float>(grid.voxel_size() * (1u << brick_bits));
  const Box& bounds = scene_.scene->local_bounds;
  p.bounds_min = {static_cast<float>(bounds.min.x), static_cast<float>(bounds.min.y), static_cast<float>(bounds.min.z)};
  p.bounds_max = {static_cast<float>(bounds.max.x), static_cast<float>(bounds.max.y), static_cast<float>(bounds.max.z)};
}

void DeviceScene::write_parameters() {
  for (const DeviceScanner& scanner : scanners_) scanner.write(commands_, parameters_);
}

// Uploads runs of the scene's triangles, and places of meshes that nodes share.
void DeviceScene::upload_places() {
  static_assert(run_block_bits == SceneData::kBlockBits && no_place == MeshInstance::kNoPlace);
  const SceneData& scene = *scene_.scene;
  std::vector<TriangleRun> runs;
  for (const MeshInstance& instance : scene.instances)
    runs.push_back({instance.first_triangle, instance.first_stored - instance.first_triangle, instance.place});
  runs.push_back({no_primitive, 0, no_place});
  std::vector<MeshTransform> places(scene.places.size());
  parallel::for_all(std::size_t{0}, places.size(), [&](std::size_t k) { places[k] = mesh_transform(scene, k); });
  runs_ = make_device_buffer<TriangleRun>(device_, commands_, runs, "runs of triangles");
  run_at_ = make_device_buffer<std::uint32_t>(device_, commands_, scene.instance_at, "runs of blocks");
  places_ = make_device_buffer<MeshTransform>(device_, commands_, places, "places of meshes");
  parameters_.runs = runs_.address();
  parameters_.run_at = run_at_.address();
  parameters_.places = places_.address();
}

// Uploads glass for all engines, since it is small.
void DeviceScene::upload_glass() {
  const SceneData& scene = *scene_.scene;
  const std::uint32_t first = scene.opaque_count();
  const std::vector<bool> of_solid = faces_of_solids(scene);
  std::vector<std::uint32_t> ids(of_solid.size());
  for (std::size_t k = 0; k < ids.size(); ++k)
    ids[k] = (first + static_cast<std::uint32_t>(k)) | (of_solid[k] ? surveyed_bit : 0);
  const Bvh bvh = build_bvh(scene.positions, glass_triangles(scene), ids);
  glass_nodes_ = make_device_buffer<BvhNode>(device_, commands_, bvh.nodes, "nodes of glass");
  glass_corners_ = make_device_buffer<BvhTriangle>(device_, commands_, bvh.triangles, "triangles of glass");
  parameters_.glass_nodes = glass_nodes_.address();
  parameters_.glass_corners = glass_corners_.address();
}

void DeviceScene::upload_triangles() {
  if (positions_) return;
  triangles_ = make_device_buffer<Triangle>(device_, commands_, scene_.scene->triangles, "triangles");
  positions_ = make_device_buffer<Float3>(device_, commands_, scene_.scene->positions, "positions");
  parameters_.positions = positions_.address();
  parameters_.triangles = triangles_.address();
  write_parameters();
}

void DeviceScene::upload_neighbours() {
  if (neighbours_ || !watertight_) return;
  neighbours_ =
      make_device_buffer<std::uint32_t>(device_, commands_, stored_neighbours(*scene_.scene), "triangle neighbours");
  parameters_.neighbours = neighbours_.address();
  write_parameters();
}

void DeviceScene::upload_shading() {
  if (diffuse_) return;
  upload_triangles();
  const SceneData& scene = *scene_.scene;
  const auto diffuse =
      per_surface<float>(scene, [&](std::size_t m) { return static_cast<float>(scene.meshes[m].diffuse); });
  diffuse_ = make_device_buffer<float>(device_, commands_, diffuse, "diffuse coefficients");
  if (!scene.normals.empty()) normals_ = make_device_buffer<Float3>(device_, commands_, scene.normals, "normals");
  parameters_.diffuse = diffuse_.address();
  parameters_.normals = scene.normals.empty() ? 0 : normals_.address();
  write_parameters();
}

}  // namespace vantage::vulkan
