// SPDX-License-Identifier: Apache-2.0
#include "scene/gltf/node_tree.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <span>
#include <string_view>

#include "scene/glob.hpp"
#include "scene/gltf/accessor.hpp"

namespace vantage::gltf {
namespace {

constexpr const char* kInstancing = "EXT_mesh_gpu_instancing";

// Patterns of names, with values for matching nodes and a flag for patterns that have matched.
template <class Value>
class Patterns {
 public:
  void add(const std::string& pattern, Value value) { entries_.push_back({pattern, value, letters_of(pattern)}); }
  // Returns the value of the matching pattern with most letters; among equals, the last one.
  std::optional<Value> find(const std::string& name) {
    const Entry* best = nullptr;
    for (Entry& entry : entries_) {
      if (!glob_matches(entry.pattern, name)) continue;
      entry.matched = true;
      if (!best || entry.letters >= best->letters) best = &entry;
    }
    return best ? std::optional(best->value) : std::nullopt;
  }
  void check(const std::vector<std::string>& names) const {
    for (const Entry& entry : entries_) {
      if (entry.matched) continue;
      std::vector<std::string> details;
      for (std::size_t i = 0; i < names.size() && i < 20; ++i) details.push_back("node " + quoted(names[i]));
      if (names.size() > details.size())
        details.push_back("and " + std::to_string(names.size() - details.size()) + " more");
      std::string some;
      for (std::size_t i = 0; i < names.size() && i < 3; ++i) some += (i ? ", " : "") + quoted(names[i]);
      throw Error(Errc::invalid_argument,
                  "the pattern " + quoted(entry.pattern) + " matches no node; nodes are " + some +
                      (names.size() > 3 ? ", …" : ""),
                  std::move(details));
    }
  }

 private:
  struct Entry {
    std::string pattern;
    Value value;
    std::ptrdiff_t letters;
    bool matched = false;
  };
  static std::ptrdiff_t letters_of(const std::string& pattern) {
    return std::ranges::count_if(pattern, [](char c) { return c != '*' && c != '?'; });
  }
  std::vector<Entry> entries_;
};

Patterns<Role> role_patterns(const SceneOptions& options) {
  Patterns<Role> roles;
  for (const std::string& pattern : options.surveyed) roles.add(pattern, Role::surveyed);
  for (const std::string& pattern : options.blocking) roles.add(pattern, Role::blocking);
  for (const std::string& pattern : options.search) roles.add(pattern, Role::search);
  for (const std::string& pattern : options.ignore) roles.add(pattern, Role::ignore);
  return roles;
}

constexpr std::uint32_t kMostWeight = 255;  // a byte per voxel

Patterns<std::uint32_t> weight_patterns(const SceneOptions& options) {
  Patterns<std::uint32_t> weights;
  for (const auto& [pattern, weight] : options.weights) {
    if (weight < 1 || weight > kMostWeight)
      throw Error(Errc::invalid_argument, "the weight of " + quoted(pattern) + " is " + std::to_string(weight) +
                                              "; it must be a whole number from 1 to 255");
    weights.add(pattern, weight);
  }
  return weights;
}

Patterns<bool> name_patterns(const std::vector<std::string>& patterns) {
  Patterns<bool> names;
  for (const std::string& pattern : patterns) names.add(pattern, true);
  return names;
}

// "detail" or "accuracy".
Patterns<double> length_patterns(const std::vector<std::pair<std::string, double>>& lengths_mm, const char* what) {
  Patterns<double> lengths;
  for (const auto& [pattern, length] : lengths_mm) {
    if (!(std::isfinite(length) && length > 0))
      throw Error(Errc::invalid_argument, std::string("the ") + what + " of " + quoted(pattern) + " is " +
                                              std::to_string(length) + " mm; it must be above 0");
    lengths.add(pattern, length);
  }
  return lengths;
}

// Shortens a name between characters of UTF-8.
std::string cut_name(const std::string& name) {
  if (name.size() <= kLongestName) return name;
  constexpr std::string_view kMore = "…";
  std::size_t end = kLongestName - kMore.size();
  while (end > 0 && (static_cast<unsigned char>(name[end]) & 0xC0u) == 0x80) --end;
  return name.substr(0, end).append(kMore);
}

// `above`: the name of the nearest named node above. Converters name a product and leave its meshes without.
std::string node_name(const tinygltf::Model& model, int index, const std::string& above) {
  const tinygltf::Node& node = model.nodes[static_cast<std::size_t>(index)];
  if (!node.name.empty()) return cut_name(node.name);
  if (node.mesh >= 0 && static_cast<std::size_t>(node.mesh) < model.meshes.size() &&
      !model.meshes[static_cast<std::size_t>(node.mesh)].name.empty())
    return cut_name(model.meshes[static_cast<std::size_t>(node.mesh)].name);
  return above.empty() ? "node " + std::to_string(index) : above;
}

// (x, y, z) ↦ (x, −z, y): glTF's Y up becomes the survey frame's Z up.
constexpr glm::dmat4 kSurveyFromGltf{1, 0, 0, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1};

// Returns CESIUM_RTC's centre, to which all positions are relative: with Z up, as in tiles. Otherwise the identity.
glm::dmat4 origin_of(const File& file) {
  const auto extensions = file.document().find("extensions");
  if (extensions == file.document().end() || !extensions->contains("CESIUM_RTC")) return glm::dmat4(1);
  const nlohmann::json& extension = (*extensions)["CESIUM_RTC"];
  const nlohmann::json center = extension.is_object() ? extension.value("center", nlohmann::json()) : nlohmann::json();
  if (!center.is_array() || center.size() != 3 ||
      !std::ranges::all_of(center, [](const nlohmann::json& value) { return value.is_number(); }))
    throw file.malformed("CESIUM_RTC: its center is not three numbers");
  glm::dmat4 out(1);
  for (int c = 0; c < 3; ++c) out[3][c] = center[static_cast<std::size_t>(c)].get<double>();
  return out;
}

bool finite(const glm::dmat4& transform) {
  const double* values = glm::value_ptr(transform);
  return std::all_of(values, values + 16, [](double value) { return std::isfinite(value); });
}

glm::dvec3 vec3(std::span<const double> values, double fallback) {
  return values.size() == 3 ? glm::dvec3{values[0], values[1], values[2]} : glm::dvec3(fallback);
}

// Returns a quaternion from x, y, z, w. Divides by the length itself, since GLM's normalize rounds differently.
glm::dquat unit_quaternion(const double* q, const File& file, const std::string& where) {
  const double length = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  if (!(length > 1e-6) || !std::isfinite(length)) throw file.malformed(where + ": its rotation is no unit quaternion");
  return {q[3] / length, q[0] / length, q[1] / length, q[2] / length};
}

// Translation · rotation · scale.
glm::dmat4 from_trs(const glm::dvec3& t, const glm::dquat& r, const glm::dvec3& s) {
  const glm::dmat3 axes = glm::mat3_cast(r);
  return {{axes[0] * s.x, 0}, {axes[1] * s.y, 0}, {axes[2] * s.z, 0}, {t, 1}};
}

glm::dmat4 local_transform(const File& file, const tinygltf::Node& node, const std::string& where) {
  if (node.matrix.size() == 16) {
    const std::vector<double>& m = node.matrix;  // column-major
    const double last[4] = {m[3], m[7], m[11], m[15] - 1};
    for (const double value : last)
      if (!(std::abs(value) <= 1e-6))
        throw file.malformed(where + ": its matrix is not affine, the last row must be 0 0 0 1");
    return {m[0], m[1], m[2], 0, m[4], m[5], m[6], 0, m[8], m[9], m[10], 0, m[12], m[13], m[14], 1};
  }
  const glm::dquat rotation =
      node.rotation.size() == 4 ? unit_quaternion(node.rotation.data(), file, where) : glm::dquat(1, 0, 0, 0);
  return from_trs(vec3(node.translation, 0), rotation, vec3(node.scale, 1));
}

// Returns the transforms of EXT_mesh_gpu_instancing, relative to the node.
std::vector<glm::dmat4> instance_transforms(const File& file, int node, const std::string& where, LoadBudget& budget) {
  if (file.find("nodes", node, {"extensions", kInstancing}).is_null()) return {glm::dmat4(1)};
  std::unique_ptr<Accessor> parts[3];
  const char* const names[3] = {"TRANSLATION", "ROTATION", "SCALE"};
  std::size_t count = 0;
  for (int i = 0; i < 3; ++i) {
    const nlohmann::json& index = file.find("nodes", node, {"extensions", kInstancing, "attributes", names[i]});
    if (index.is_null()) continue;
    if (!index.is_number_unsigned())
      throw file.malformed(where + " instances " + names[i] + ": " + quoted(index.dump()) + " is no accessor");
    parts[i] = std::make_unique<Accessor>(file, index.get<int>(), where + " instances " + names[i],
                                          i == 1 ? std::initializer_list<int>{4} : std::initializer_list<int>{3});
    if (count != 0 && parts[i]->count() != count)
      throw file.malformed(where + ": its instances have " + std::to_string(count) + " and " +
                           std::to_string(parts[i]->count()) + " entries");
    count = parts[i]->count();
  }
  if (count == 0) throw file.malformed(where + ": " + kInstancing + " lists no instances");
  budget.keep(count * sizeof(glm::dmat4), where + ": its " + std::to_string(count) + " instances");
  std::vector<glm::dmat4> out(count);
  for (std::size_t i = 0; i < count; ++i) {
    double t[3] = {0, 0, 0}, q[4] = {0, 0, 0, 1}, s[3] = {1, 1, 1};
    if (parts[0]) parts[0]->read(i, 1, t);
    if (parts[1]) parts[1]->read(i, 1, q);
    if (parts[2]) parts[2]->read(i, 1, s);
    out[i] = from_trs(vec3(t, 0), unit_quaternion(q, file, where + " instance " + std::to_string(i)), vec3(s, 1));
  }
  return out;
}

std::vector<int> root_nodes(const File& file, const SceneOptions& options) {
  const tinygltf::Model& model = file.model();
  if (options.scene_index && *options.scene_index >= model.scenes.size())
    throw Error(Errc::invalid_argument, "scene " + std::to_string(*options.scene_index) +
                                            " was asked for; the file has " + std::to_string(model.scenes.size()) +
                                            ", numbered from 0");
  if (model.scenes.empty()) {  // a library of nodes: take all without a parent
    std::vector<bool> has_parent(model.nodes.size());
    for (const auto& node : model.nodes)
      for (const int child : node.children)
        if (child >= 0 && static_cast<std::size_t>(child) < has_parent.size())
          has_parent[static_cast<std::size_t>(child)] = true;
    std::vector<int> roots;
    for (std::size_t i = 0; i < has_parent.size(); ++i)
      if (!has_parent[i]) roots.push_back(static_cast<int>(i));
    return roots;
  }
  const std::size_t index = options.scene_index       ? *options.scene_index
                            : model.defaultScene >= 0 ? static_cast<std::size_t>(model.defaultScene)
                                                      : 0;
  if (index >= model.scenes.size())
    throw file.malformed("its default scene is " + std::to_string(index) + "; there are " +
                         std::to_string(model.scenes.size()));
  return model.scenes[index].nodes;
}

}  // namespace

Marks read_marks(const File& file, const char* array, int index, const std::string& name) {
  const nlohmann::json& object = file.find(array, index, {"extras", "vantage"});
  if (object.is_null()) return {};
  const std::string where = name + ": extras.vantage";
  if (!object.is_object()) throw file.malformed(where + " is not an object");
  Marks marks;
  if (const auto role = object.find("role"); role != object.end()) {
    const std::string text = role->is_string() ? role->get<std::string>() : role->dump();
    if (text == "surveyed")
      marks.role = Role::surveyed;
    else if (text == "blocking")
      marks.role = Role::blocking;
    else if (text == "search")
      marks.role = Role::search;
    else if (text == "ignore")
      marks.role = Role::ignore;
    else
      throw file.malformed(where + ".role is " + quoted(text) + "; use surveyed, blocking, search or ignore");
  }
  if (const auto diffuse = object.find("diffuse"); diffuse != object.end()) {
    if (!diffuse->is_number() || !(diffuse->get<double>() >= 0 && diffuse->get<double>() <= 1))
      throw file.malformed(where + ".diffuse is " + quoted(diffuse->dump()) + "; it must be a number from 0 to 1");
    marks.diffuse = diffuse->get<double>();
  }
  if (const auto weight = object.find("weight"); weight != object.end()) {
    if (!weight->is_number_unsigned() || weight->get<std::uint64_t>() < 1 || weight->get<std::uint64_t>() > kMostWeight)
      throw file.malformed(where + ".weight is " + quoted(weight->dump()) +
                           "; it must be a whole number from 1 to 255");
    marks.weight = weight->get<std::uint32_t>();
  }
  const auto length = [&](const char* key, std::optional<double>& target) {
    const auto value = object.find(key);
    if (value == object.end()) return;
    if (!value->is_number() || !(value->get<double>() > 0))
      throw file.malformed(where + "." + key + " is " + quoted(value->dump()) + "; it must be a number above 0");
    target = value->get<double>();
  };
  length("detail_mm", marks.detail_mm);
  length("accuracy_mm", marks.accuracy_mm);
  const auto flag = [&](const char* key, std::optional<bool>& target) {
    const auto value = object.find(key);
    if (value == object.end()) return;
    if (!value->is_boolean())
      throw file.malformed(where + "." + key + " is " + quoted(value->dump()) + "; use true or false");
    target = value->get<bool>();
  };
  flag("door", marks.door);
  flag("glass", marks.glass);
  flag("mirror", marks.mirror);
  return marks;
}

namespace {
// Finds nodes that MSFT_lod names as coarser levels of shown ones. Files may also have them in the scene.
std::vector<bool> coarser_levels(const File& file, const std::vector<int>& roots) {
  const auto& nodes = file.model().nodes;
  std::vector<bool> coarser(nodes.size()), reached(nodes.size());
  if (!file.uses("MSFT_lod")) return coarser;
  std::vector<int> stack = roots;
  while (!stack.empty()) {
    const int node = stack.back();
    stack.pop_back();
    if (node < 0 || static_cast<std::size_t>(node) >= nodes.size() || reached[static_cast<std::size_t>(node)]) continue;
    reached[static_cast<std::size_t>(node)] = true;
    stack.insert(stack.end(), nodes[static_cast<std::size_t>(node)].children.begin(),
                 nodes[static_cast<std::size_t>(node)].children.end());
  }
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    if (!reached[n] || coarser[n]) continue;
    const nlohmann::json& ids = file.find("nodes", static_cast<int>(n), {"extensions", "MSFT_lod", "ids"});
    if (!ids.is_array()) continue;
    for (const nlohmann::json& id : ids)
      if (id.is_number_unsigned() && id.get<std::size_t>() < nodes.size() && id.get<std::size_t>() != n)
        coarser[id.get<std::size_t>()] = true;
  }
  return coarser;
}

// The patterns of all options, tried on each name.
class NodePatterns {
 public:
  explicit NodePatterns(const SceneOptions& options)
      : roles_(role_patterns(options)),
        weights_(weight_patterns(options)),
        doors_(patterns_but(options.doors, kClosedDoors)),
        station_areas_(name_patterns(options.station_area)),
        glasses_(patterns_but(options.glass, kOpaqueGlass)),
        mirrors_(patterns_but(options.mirror, kNoMirror)),
        details_(length_patterns(options.details_mm, "detail")),
        accuracies_(length_patterns(options.accuracies_mm, "accuracy")) {}

  // Returns the marks of a node below one with the marks `above`. `own`: of the node itself, in the file.
  NodeMarks inherit(const NodeMarks& above, const std::string& name, const Marks& own) {
    const std::optional<Role> role = roles_.find(name);
    return {.pattern_role = nearer(role, above.pattern_role),
            .pattern_weight = nearer(weights_.find(name), above.pattern_weight),
            .pattern_detail_mm = nearer(details_.find(name), above.pattern_detail_mm),
            .pattern_accuracy_mm = nearer(accuracies_.find(name), above.pattern_accuracy_mm),
            .door = doors_.find(name).value_or(above.door),
            .station_area = station_areas_.find(name).value_or(above.station_area),
            .glass = glasses_.find(name).value_or(above.glass),
            .mirror = mirrors_.find(name).value_or(above.mirror),
            .marks = {.role = nearer(own.role, above.marks.role),
                      .diffuse = nearer(own.diffuse, above.marks.diffuse),
                      .weight = nearer(own.weight, above.marks.weight),
                      .detail_mm = nearer(own.detail_mm, above.marks.detail_mm),
                      .accuracy_mm = nearer(own.accuracy_mm, above.marks.accuracy_mm),
                      .door = nearer(own.door, above.marks.door),
                      .glass = nearer(own.glass, above.marks.glass),
                      .mirror = nearer(own.mirror, above.marks.mirror)},
            .own_role = role.has_value()};
  }

  // Throws Error invalid_argument for a pattern that matched none of `names`, which are those of all nodes.
  void check(const std::vector<std::string>& names) const {
    roles_.check(names);
    weights_.check(names);
    doors_.check(names);
    station_areas_.check(names);
    glasses_.check(names);
    mirrors_.check(names);
    details_.check(names);
    accuracies_.check(names);
  }

 private:
  template <class Value>
  static std::optional<Value> nearer(const std::optional<Value>& own, const std::optional<Value>& above) {
    return own ? own : above;
  }
  // Patterns of all names but a word that stands for none.
  static Patterns<bool> patterns_but(std::vector<std::string> names, std::string_view none) {
    std::erase(names, none);
    return name_patterns(names);
  }

  Patterns<Role> roles_;
  Patterns<std::uint32_t> weights_;
  Patterns<bool> doors_, station_areas_, glasses_, mirrors_;
  Patterns<double> details_, accuracies_;
};

}  // namespace

std::vector<PlacedMesh> flatten_scene(const File& file, const SceneOptions& options, LoadBudget& budget,
                                      std::vector<std::string>& notes) {
  const tinygltf::Model& model = file.model();
  struct Visit {
    int node;
    int parent;
    glm::dmat4 world_from_parent;
    NodeMarks marks = {};   // of the node above
    std::string name = {};  // of the nearest node above that has one
  };
  std::vector<Visit> stack;  // an explicit stack: node trees may be deeper than the thread's stack
  const std::vector<int> roots = root_nodes(file, options);
  const std::vector<bool> coarser = coarser_levels(file, roots);
  for (auto it = roots.rbegin(); it != roots.rend(); ++it)
    stack.push_back({*it, -1, origin_of(file) * kSurveyFromGltf});
  NodePatterns patterns(options);
  std::vector<PlacedMesh> placed;
  std::vector<std::string> names;
  std::vector<bool> visited(model.nodes.size());
  std::size_t skinned = 0, hidden = 0, levels = 0;
  while (!stack.empty()) {
    Visit visit = std::move(stack.back());
    stack.pop_back();
    const std::string who = visit.parent < 0 ? "the scene" : "node " + std::to_string(visit.parent);
    if (visit.node < 0 || static_cast<std::size_t>(visit.node) >= model.nodes.size())
      throw file.malformed(who + " refers to node " + std::to_string(visit.node) + "; there are " +
                           std::to_string(model.nodes.size()));
    const auto index = static_cast<std::size_t>(visit.node);
    const tinygltf::Node& node = model.nodes[index];
    const std::string name = node_name(model, visit.node, visit.name);
    if (!node.name.empty()) visit.name = name;
    const std::string where = "node " + std::to_string(visit.node) + (node.name.empty() ? "" : " " + quoted(node.name));
    if (visited[index]) throw file.malformed(where + " is reached twice: a cycle, or a node with two parents");
    visited[index] = true;
    if (file.find("nodes", visit.node, {"extensions", "KHR_node_visibility", "visible"}) == false) {
      ++hidden;
      continue;
    }
    if (coarser[index]) {
      ++levels;
      continue;
    }
    names.push_back(name);
    const NodeMarks marks = patterns.inherit(visit.marks, name, read_marks(file, "nodes", visit.node, where));
    const glm::dmat4 world_from_node = visit.world_from_parent * local_transform(file, node, where);
    if (!finite(world_from_node)) throw file.malformed(where + ": its transform is not finite");
    if (node.mesh >= 0) {
      if (static_cast<std::size_t>(node.mesh) >= model.meshes.size())
        throw file.malformed(where + " refers to mesh " + std::to_string(node.mesh) + "; there are " +
                             std::to_string(model.meshes.size()));
      if (node.skin >= 0) ++skinned;
      PlacedMesh mesh{marks, visit.node, node.mesh, name, instance_transforms(file, visit.node, where, budget)};
      for (glm::dmat4& transform : mesh.world_from_mesh) {
        transform = world_from_node * transform;
        if (!finite(transform)) throw file.malformed(where + ": the transform of an instance is not finite");
      }
      placed.push_back(std::move(mesh));
    }
    for (auto it = node.children.rbegin(); it != node.children.rend(); ++it)
      stack.push_back({*it, visit.node, world_from_node, marks, visit.name});
  }
  patterns.check(names);
  if (hidden > 0)
    notes.push_back(std::to_string(hidden) + " nodes are hidden by the file, and are left out with all below them");
  if (levels > 0)
    notes.push_back(std::to_string(levels) + " nodes are coarser levels of detail of others, and are left out");
  if (skinned > 0)
    notes.push_back(std::to_string(skinned) + " skinned meshes stand as modelled: skins are not applied");
  return placed;
}

}  // namespace vantage::gltf
