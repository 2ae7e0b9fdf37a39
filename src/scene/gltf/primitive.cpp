// SPDX-License-Identifier: Apache-2.0
#include "scene/gltf/primitive.hpp"

#include <algorithm>
#include <limits>

namespace vantage::gltf {
namespace {

// Returns the triangles of the three modes; `at` gives the i-th of n indices. Strips and fans restart at kRestart, or
// by repeated indices, which make no triangle.
template <class At>
std::vector<Triangle> triangulate(int mode, std::size_t n, At&& at) {
  std::vector<Triangle> out;
  if (n < 3) return out;
  if (mode == TINYGLTF_MODE_TRIANGLES) {
    out.resize(n / 3);
    for (std::size_t t = 0; t < out.size(); ++t) out[t] = {at(3 * t), at(3 * t + 1), at(3 * t + 2)};
    return out;
  }
  std::size_t first = 0;  // of the strip or fan
  for (std::size_t last = 0; last < n; ++last) {
    if (at(last) == kRestart) first = last + 1;
    if (last < first + 2) continue;
    const std::size_t i = last - 2, odd = (i - first) % 2;
    const Triangle t = mode == TINYGLTF_MODE_TRIANGLE_FAN ? Triangle{at(i + 1), at(i + 2), at(first)}
                                                          : Triangle{at(i), at(i + 1 + odd), at(i + 2 - odd)};
    if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) out.push_back(t);
  }
  return out;
}

}  // namespace

std::unique_ptr<Accessor> Primitive::texcoord(const File& file, int set) const {
  if (set < 0 || set > 1 || texcoords[set] < 0) return nullptr;
  const std::string semantic = "TEXCOORD_" + std::to_string(set);
  auto accessor =
      std::make_unique<Accessor>(file, texcoords[set], name + " " + semantic, std::initializer_list<int>{2});
  if (accessor->count() != position->count())
    throw file.malformed(accessor->name() + " has " + std::to_string(accessor->count()) + " elements for " +
                         std::to_string(position->count()) + " positions");
  return accessor;
}

PrimitiveSize primitive_size(const File& file, int mesh, std::size_t index) {
  const tinygltf::Primitive& primitive = file.model().meshes[static_cast<std::size_t>(mesh)].primitives[index];
  const auto count = [&](int accessor) -> std::uint64_t {
    const auto& accessors = file.model().accessors;
    const bool known = accessor >= 0 && static_cast<std::size_t>(accessor) < accessors.size();
    if (!known) return 0;
    // Claims no more than reading will accept: an accessor that claims more is refused there, by its name.
    const tinygltf::Accessor& claimed = accessors[static_cast<std::size_t>(accessor)];
    const auto& views = file.model().bufferViews;
    const bool viewed = claimed.bufferView >= 0 && static_cast<std::size_t>(claimed.bufferView) < views.size();
    return std::min(claimed.count,
                    viewed ? views[static_cast<std::size_t>(claimed.bufferView)].byteLength : kLargestWithoutBuffer);
  };
  const auto position = primitive.attributes.find("POSITION");
  if (primitive.mode < TINYGLTF_MODE_TRIANGLES || position == primitive.attributes.end()) return {};
  const std::uint64_t vertices = count(position->second),
                      corners = primitive.indices >= 0 ? count(primitive.indices) : vertices;
  return {vertices, primitive.mode == TINYGLTF_MODE_TRIANGLES ? corners / 3 : corners,
          primitive.attributes.contains("NORMAL"), primitive.attributes.contains("COLOR_0")};
}

std::unique_ptr<Primitive> read_primitive(const File& file, int mesh, std::size_t index, SkippedPrimitives& skipped) {
  const tinygltf::Primitive& primitive = file.model().meshes[static_cast<std::size_t>(mesh)].primitives[index];
  auto out = std::make_unique<Primitive>();
  out->name = "mesh " + std::to_string(mesh) + " primitive " + std::to_string(index);
  out->material = primitive.material;
  if (primitive.mode < TINYGLTF_MODE_POINTS || primitive.mode > TINYGLTF_MODE_TRIANGLE_FAN)
    throw file.malformed(out->name + " has the mode " + std::to_string(primitive.mode) + "; glTF has 0 to 6");
  if (primitive.mode < TINYGLTF_MODE_TRIANGLES) {
    ++skipped.points_or_lines;
    return nullptr;
  }
  const auto attribute = [&](const char* semantic) {
    const auto it = primitive.attributes.find(semantic);
    return it == primitive.attributes.end() ? -1 : it->second;
  };
  if (attribute("POSITION") < 0) {
    ++skipped.without_positions;
    return nullptr;
  }
  if (!primitive.targets.empty()) ++skipped.morphed;
  const auto read = [&](const char* semantic, std::initializer_list<int> components) -> std::unique_ptr<Accessor> {
    const int accessor_index = attribute(semantic);
    if (accessor_index < 0) return nullptr;
    auto accessor = std::make_unique<Accessor>(file, accessor_index, out->name + " " + semantic, components);
    if (out->position && accessor->count() != out->position->count())
      throw file.malformed(accessor->name() + " has " + std::to_string(accessor->count()) + " elements for " +
                           std::to_string(out->position->count()) + " positions");
    return accessor;
  };
  out->position = read("POSITION", {3});
  out->normal = read("NORMAL", {3});
  out->colour = read("COLOR_0", {4, 3});
  out->texcoords[0] = attribute("TEXCOORD_0");
  out->texcoords[1] = attribute("TEXCOORD_1");
  if (out->position->count() > std::numeric_limits<std::uint32_t>::max())
    throw file.malformed(out->position->name() + " has too many elements");
  std::size_t corners = out->position->count();
  if (primitive.indices >= 0) {
    const Accessor accessor(file, primitive.indices, out->name + " indices", {1});
    const bool restart = primitive.mode != TINYGLTF_MODE_TRIANGLES &&
                         (file.uses("KHR_mesh_primitive_restart") || file.uses("EXT_mesh_primitive_restart"));
    const auto indices = accessor.read_indices(out->position->count(), restart);
    corners = indices.size();
    out->triangles = triangulate(primitive.mode, corners, [&](std::size_t i) { return indices[i]; });
  } else {
    out->triangles = triangulate(primitive.mode, corners, [](std::size_t i) { return static_cast<std::uint32_t>(i); });
  }
  if (primitive.mode == TINYGLTF_MODE_TRIANGLES && corners % 3 != 0) ++skipped.cut_short;
  return out;
}

}  // namespace vantage::gltf
