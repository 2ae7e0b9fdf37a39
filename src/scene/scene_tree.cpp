// SPDX-License-Identifier: Apache-2.0
#include "scene/scene_tree.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <map>
#include <tuple>
#include <utility>

#include "scene/local_from_mesh.hpp"

namespace vantage {
SceneTree::SceneTree(RTCDevice device, const SceneData& scene, std::uint32_t first, std::uint32_t end,
                     const Filters& filters, const std::string& what)
    : scene_(scene), first_(first), tree_(embree::new_scene(device)) {
  if (!scene.shares()) {
    if (end > first) add_triangles(device, tree_.get(), first, end - first, 0, filters);
  } else {
    for (MeshInstance run : scene.instances) {
      const std::uint32_t skipped = std::max(first, run.first_triangle) - run.first_triangle;
      const std::uint32_t last = std::min(end, run.first_triangle + run.triangle_count);
      if (run.place != MeshInstance::kNoPlace || run.first_triangle + skipped >= last) continue;
      run.first_triangle += skipped, run.first_stored += skipped;
      run.triangle_count = last - run.first_triangle;
      own_.push_back(run);
    }
    if (!own_.empty())  // they are stored one after the other
      add_triangles(device, tree_.get(), own_.front().first_stored,
                    own_.back().first_stored + own_.back().triangle_count - own_.front().first_stored,
                    static_cast<unsigned>(scene.instances.size()), filters);
    add_instances(device, end, filters);
    add_boxes(device);
  }
  rtcCommitScene(tree_.get());
  embree::check(device, "building the tree " + what + " over " + std::to_string(end - first) + " triangles");
}

SceneTree::SceneTree(RTCDevice device, const SceneData& scene, std::span<const KeptRun> runs, const Filters& filters,
                     const std::string& what)
    : scene_(scene), first_(0), tree_(embree::new_scene(device)) {
  // Makes one geometry with only the corners of these triangles.
  std::uint32_t low = 0xFFFFFFFFu, high = 0, count = 0;
  for (const KeptRun& run : runs) {
    const auto [first, last] = corner_range(std::span(scene.triangles).subspan(run.first, run.count));
    low = std::min(low, first), high = std::max(high, last);
    numbers_.push_back({count, run.count, run.first});
    count += run.count;
  }
  const embree::Geometry geometry(rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE));
  std::vector<std::uint32_t> place(std::size_t{high} - low + 1, 0);
  for (const KeptRun& run : runs)
    for (const Triangle& t : std::span(scene.triangles).subspan(run.first, run.count))
      for (const std::uint32_t v : t) place[v - low] = 1;
  std::uint32_t corners = 0;
  for (std::uint32_t& p : place) p = p ? corners++ : kInNone;
  auto* const vertices = static_cast<Float3*>(
      rtcSetNewGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(Float3), corners));
  auto* triangle = static_cast<Triangle*>(
      rtcSetNewGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, sizeof(Triangle), count));
  embree::check(device, "taking the triangles of meshes that changed");
  for (std::size_t v = 0; v < place.size(); ++v)
    if (place[v] != kInNone) vertices[place[v]] = scene.positions[v + low];
  for (const KeptRun& run : runs)
    for (const Triangle& t : std::span(scene.triangles).subspan(run.first, run.count))
      *triangle++ = {place[t[0] - low], place[t[1] - low], place[t[2] - low]};
  rtcSetGeometryIntersectFilterFunction(geometry.get(), filters.intersect);
  rtcSetGeometryOccludedFilterFunction(geometry.get(), filters.occluded);
  rtcCommitGeometry(geometry.get());
  rtcAttachGeometryByID(tree_.get(), geometry.get(), 0);
  rtcCommitScene(tree_.get());
  embree::check(device, "building the tree " + what + " over " + std::to_string(count) + " triangles");
}

void SceneTree::renumber(std::vector<KeptRun> numbers) noexcept { numbers_ = std::move(numbers); }

std::uint32_t SceneTree::number_by_runs(unsigned primitive) const {
  const auto after = std::ranges::upper_bound(numbers_, primitive, {}, &KeptRun::first);
  if (after == numbers_.begin()) return kInNone;
  const KeptRun& run = *(after - 1);
  return primitive - run.first < run.count ? run.other + (primitive - run.first) : kInNone;
}

std::uint32_t SceneTree::number_of_own(std::uint32_t primitive) const {
  const std::uint32_t stored = own_.front().first_stored + primitive;
  const auto after = std::ranges::upper_bound(own_, stored, {}, &MeshInstance::first_stored);
  const MeshInstance& run = *(after - 1);
  return stored - run.first_stored + run.first_triangle;
}

// Adds triangles that are stored from `first` on.
void SceneTree::add_triangles(RTCDevice device, RTCScene to, std::uint32_t first, std::uint32_t count, unsigned id,
                              const Filters& filters) {
  const auto triangles = std::span(scene_.triangles).subspan(first, count);
  std::uint32_t low = 0, end = static_cast<std::uint32_t>(scene_.positions.size());
  if (scene_.shares()) {
    std::tie(low, end) = corner_range(triangles);
    ++end;
  }
  const embree::Geometry geometry(rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE));
  // Vertices are copied, since Embree reads past the end of a shared buffer.
  void* const vertices =
      rtcSetNewGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(Float3), end - low);
  embree::check(device, "taking the scene's vertices");
  std::memcpy(vertices, scene_.positions.data() + low, (end - low) * sizeof(Float3));
  if (low == 0) {
    rtcSetSharedGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, triangles.data(), 0,
                               sizeof(Triangle), count);
  } else {
    auto* const indices = static_cast<Triangle*>(
        rtcSetNewGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, sizeof(Triangle), count));
    embree::check(device, "taking the triangles of a shared mesh");
    std::ranges::transform(triangles, indices, [&](const Triangle& t) {
      return Triangle{t[0] - low, t[1] - low, t[2] - low};
    });
  }
  rtcSetGeometryIntersectFilterFunction(geometry.get(), filters.intersect);
  rtcSetGeometryOccludedFilterFunction(geometry.get(), filters.occluded);
  rtcCommitGeometry(geometry.get());
  rtcAttachGeometryByID(to, geometry.get(), id);
}

void SceneTree::add_instances(RTCDevice device, std::uint32_t end, const Filters& filters) {
  std::map<std::uint32_t, RTCScene> known;  // by first stored triangle
  meshes_.resize(scene_.instances.size());
  for (std::size_t k = 0; k < scene_.instances.size(); ++k) {
    const MeshInstance& instance = scene_.instances[k];
    if (instance.place == MeshInstance::kNoPlace || instance.first_triangle < first_ || instance.first_triangle >= end)
      continue;
    RTCScene& mesh = known[instance.first_stored];
    if (!mesh) {
      shared_.push_back(embree::new_scene(device));
      mesh = shared_.back().get();
      add_triangles(device, mesh, instance.first_stored, instance.triangle_count, 0, filters);
      rtcCommitScene(mesh);
    }
    meshes_[k] = mesh;
    const embree::Geometry geometry(rtcNewGeometry(device, RTC_GEOMETRY_TYPE_INSTANCE));
    rtcSetGeometryInstancedScene(geometry.get(), mesh);
    const std::array<float, 12> columns = local_from_mesh(scene_, scene_.places[instance.place]);
    rtcSetGeometryTransform(geometry.get(), 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, columns.data());
    rtcCommitGeometry(geometry.get());
    rtcAttachGeometryByID(tree_.get(), geometry.get(), static_cast<unsigned>(k));
  }
}

// Instances that are not in the tree have an empty box.
void SceneTree::add_boxes(RTCDevice device) {
  boxes_ = embree::new_scene(device);
  const auto count = static_cast<unsigned>(scene_.instances.size());
  if (!own_.empty()) rtcAttachGeometryByID(boxes_.get(), rtcGetGeometry(tree_.get(), count), count);
  const embree::Geometry geometry(rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER));
  rtcSetGeometryUserPrimitiveCount(geometry.get(), count);
  rtcSetGeometryUserData(geometry.get(), this);
  rtcSetGeometryBoundsFunction(
      geometry.get(),
      [](const RTCBoundsFunctionArguments* arguments) {
        const auto& tree = *static_cast<const SceneTree*>(arguments->geometryUserPtr);
        RTCBounds& out = *arguments->bounds_o;
        if (!tree.meshes_[arguments->primID]) {
          out.lower_x = 1, out.upper_x = -1;
          return;
        }
        // The box's corners are floats, since those of triangles are.
        const Box& box = tree.scene_.instances[arguments->primID].bounds;
        out.lower_x = static_cast<float>(box.min.x), out.upper_x = static_cast<float>(box.max.x);
        out.lower_y = static_cast<float>(box.min.y), out.upper_y = static_cast<float>(box.max.y);
        out.lower_z = static_cast<float>(box.min.z), out.upper_z = static_cast<float>(box.max.z);
      },
      nullptr);
  rtcCommitGeometry(geometry.get());
  rtcAttachGeometryByID(boxes_.get(), geometry.get(), count + 1);
  rtcCommitScene(boxes_.get());
}

}  // namespace vantage
