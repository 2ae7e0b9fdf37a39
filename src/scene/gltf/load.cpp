// SPDX-License-Identifier: Apache-2.0
// Loads a scene from a glTF file: places every mesh in the survey frame, assigns roles, and passes the result on to be
// cleaned.

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <mutex>
#include <new>
#include <set>
#include <string_view>
#include <tuple>
#include <utility>

#include "core/parallel.hpp"
#include "core/rounded.hpp"
#include "core/text.hpp"
#include "import/import.hpp"
#include "scene/cut_masks.hpp"
#include "scene/gltf/file.hpp"
#include "scene/gltf/material.hpp"
#include "scene/gltf/node_tree.hpp"
#include "scene/gltf/primitive.hpp"
#include "scene/importer_settings.hpp"
#include "scene/open_doors.hpp"
#include "scene/positions.hpp"
#include "scene/raw_scene.hpp"
#include "scene/recognise_units.hpp"
#include "scene/room_floors.hpp"
#include "scene/shared_meshes.hpp"
#include "vantage/scene.hpp"
#include "vantage/scene_builder.hpp"

namespace vantage {
namespace gltf {
namespace {

constexpr std::size_t kBlock = 4096;
constexpr std::size_t kMostTriangles = std::size_t{1} << 31;

// Bytes per vertex and triangle until the scene is finished. Vertex: position in double and in float, new number and
// old one. Triangle: corners, entry among possible duplicates, flag of being kept; with both roles also leaves of two
// trees, and its list. Triangle while read: indices, corners.
constexpr double kVertex = 24 + 12 + 8, kTriangle = 12 + 16 + 1, kCoplanar = 100, kSearchVertex = 24 + 24 + 3 * 16 + 8,
                 kSearchTriangle = 3 * 12;
constexpr std::uint64_t kTriangleRead = 12 + 3 * 12;
// Bytes of a mesh that is stored once: corners, sorted corners, flag of being kept.
constexpr double kSharedVertex = 12 + 4, kSharedTriangle = 2 * 12, kSharedTriangleSorted = 40 + 1;
// A scene with both roles and shared meshes stores its other meshes once more: NearPlaced.
constexpr double kVertexBeside = 12, kTriangleBeside = 12 + 4;
// SharedMeshes::automatic shares meshes of at least kFewTriangles in scenes of more than kManyTriangles: a second level
// of the tree pays only for larger meshes.
constexpr double kManyTriangles = 8e6;
constexpr std::uint64_t kFewTriangles = 256;
// Triangles of shared meshes that suffice to recognise the unit and axis of a large file.
constexpr std::size_t kRecognised = 4'000'000;

// A mesh to read: one primitive, placed by one node.
struct Job {
  const PlacedMesh* placed = nullptr;
  std::size_t primitive = 0;
  std::optional<Role> role;  // empty: unmarked
  double diffuse = 0;
  std::uint32_t weight = 1;
  double detail_mm = 0, accuracy_mm = 0;  // 0: any
  const MaterialInfo* material = nullptr;
  bool glass = false, mirror = false;
  bool shared = false;  // stored once
};

// Returns true if a member of an object is this text. Comparing JSON with text allocates; code here may not throw.
bool is_text(const nlohmann::json& object, const char* key, std::string_view text) {
  const auto member = object.find(key);
  const auto* const found = member == object.end() ? nullptr : member->get_ptr<const std::string*>();
  return found && *found == text;
}

// Returns true if float holds a primitive's positions exactly.
bool is_exact(const File& file, int mesh, std::size_t index) {
  const tinygltf::Primitive& primitive = file.model().meshes[static_cast<std::size_t>(mesh)].primitives[index];
  const auto position = primitive.attributes.find("POSITION");
  const auto& accessors = file.model().accessors;
  if (position == primitive.attributes.end() || static_cast<std::size_t>(position->second) >= accessors.size())
    return false;
  const tinygltf::Accessor& accessor = accessors[static_cast<std::size_t>(position->second)];
  return !accessor.normalized && accessor.componentType != TINYGLTF_COMPONENT_TYPE_DOUBLE;
}

// Returns true if the transform turns right-handed axes into left-handed ones.
bool mirrors(const glm::dmat3& m) { return dot(m[0], cross(m[1], m[2])) < 0; }

// Maps normals as the inverse transpose does, up to a positive length. Uses cofactors, signed by the determinant, which
// stay defined if the matrix flattens space.
glm::dmat3 normal_map(const glm::dmat3& m) {
  const double sign = mirrors(m) ? -1.0 : 1.0;
  return {cross(m[1], m[2]) * sign, cross(m[2], m[0]) * sign, cross(m[0], m[1]) * sign};
}

template <class Body>
void in_blocks(std::size_t count, Body&& body) {
  parallel::for_all(tbb::blocked_range<std::size_t>(0, count, kBlock),
                    [&](const tbb::blocked_range<std::size_t>& range) {
                      std::vector<double> values(4 * kBlock);
                      for (std::size_t first = range.begin(); first < range.end(); first += kBlock)
                        body(first, std::min(kBlock, range.end() - first), values.data());
                    });
}

// Extends an optional per-vertex array to the length of the positions, once some mesh has it.
template <class T>
void extend(std::vector<T>& values, bool present, std::size_t size, T fallback) {
  if (present || !values.empty()) values.resize(size, fallback);
}

std::uint32_t packed_colour(const double* rgba, int components) {
  std::uint32_t out = 0;
  for (int c = 0; c < 4; ++c) {
    const double value = c < components ? rgba[c] : 1.0;
    const auto byte =
        static_cast<std::uint32_t>(std::lround(255 * std::clamp(std::isfinite(value) ? value : 1.0, 0.0, 1.0)));
    out |= byte << (8 * c);
  }
  return out;
}

class Loader {
 public:
  // Borrows all arguments. `converted`: an importer has already turned the model to metres with Y up, from the unit in
  // the options.
  Loader(const File& file, const SceneOptions& options, LoadBudget& budget, bool converted)
      : file_(file), options_(options), converted_(converted), budget_(budget), materials_(file, budget, raw_.notes) {
    raw_.options = options;
  }

  RawScene load() {
    const auto placed = flatten_scene(file_, options_, budget_, raw_.notes);
    std::vector<Job> jobs = list_jobs(placed);
    choose_shared(jobs);
    reserve(jobs);
    for (const Job& job : jobs) read(job);
    if (raw_.ranges.empty() && raw_.search_triangles.empty() && skipped_.points_or_lines > 0)
      throw file_.malformed("it holds points or lines alone; a survey is planned on surfaces: export triangles");
    settle_axes();
    find_doors();
    note_glass();
    note_mirrors();
    raw_.materials = std::move(materials_.materials);
    raw_.images = std::move(materials_.images);
    cut_masks(raw_, materials_.cutoffs, budget_);
    pass_notes_on();
    note_skipped();
    read_rooms();
    lay_room_floors(raw_, budget_);
    if (const auto& defaults = file_.asset_extras("vantage"); !defaults.is_null()) raw_.defaults_json = defaults.dump();
    return std::move(raw_);
  }

 private:
  // Returns true for a file marked for this program, which follows glTF's rule. A file that declares only some of its
  // axes, as importers do, is examined for the others.
  bool prepared() const {
    const nlohmann::json& document = file_.document();
    const auto marked = [](const nlohmann::json& element) {
      const auto extras = element.find("extras");
      return extras != element.end() && extras->is_object() && extras->contains("vantage");
    };
    for (const char* array : {"scenes", "nodes", "meshes", "materials"})
      if (const auto elements = document.find(array); elements != document.end())
        if (std::ranges::any_of(*elements, marked)) return true;
    return marked(document.at("asset")) && declared("unit").empty() && declared("up").empty();
  }

  // Returns the unit or axis that `vantage` in the asset's extras declares; empty if none.
  std::string declared(const char* key) const {
    const nlohmann::json& value = file_.asset_extras("vantage");
    return value.is_object() && value.contains(key) && value[key].is_string() ? value[key].get<std::string>() : "";
  }

  void settle_axes() {
    // An importer that takes these settings has applied them; it declares no unit if the model gives none.
    if (converted_ && !declared("unit").empty()) return reinterpret_axes(raw_, Unit::metre, UpAxis::y);
    std::optional<Unit> unit = converted_ ? std::nullopt : options_.unit;
    std::optional<UpAxis> up = converted_ ? std::nullopt : options_.up;
    try {
      if (const std::string text = declared("unit"); !unit && !text.empty()) unit = unit_from_string(text);
      if (const std::string text = declared("up"); !up && !text.empty()) up = up_axis_from_string(text);
    } catch (const Error& error) {
      throw file_.malformed(std::string("asset.extras.vantage: ") + error.what());
    }
    Recognised axes{unit.value_or(Unit::metre), up.value_or(UpAxis::y)};
    // A mesh of OBJ, STL or PLY has neither unit nor axis.
    const bool glTF = !is_text(file_.document().at("asset"), "generator", "vantage-import-mesh");
    if (!prepared())
      axes =
          raw_.shared.empty() ? recognise(raw_, unit, up, glTF) : recognise(excerpt(raw_, kRecognised), unit, up, glTF);
    if (!axes.question.empty()) throw file_.malformed(axes.question, axes.choices);
    if (!axes.note.empty()) raw_.notes.push_back(axes.note);
    reinterpret_axes(raw_, axes.unit, axes.up);
    if (!axes.inside_out) return;
    turn_faces(raw_);
    raw_.notes.emplace_back("its faces show away from the space that they enclose, which is open; they are turned");
  }

  std::vector<Job> list_jobs(const std::vector<PlacedMesh>& placed) {
    constexpr std::uint64_t kPrimitive = 3 * (sizeof(Job) + sizeof(MeshInfo) + sizeof(MeshRange)) + kLongestName;
    std::uint64_t primitives_placed = 0;
    for (const PlacedMesh& mesh : placed)
      primitives_placed += file_.model().meshes[static_cast<std::size_t>(mesh.mesh)].primitives.size();
    budget_.keep(kPrimitive * primitives_placed, std::to_string(primitives_placed) + " primitives placed by nodes");
    std::vector<Job> jobs;
    bool some_surveyed = false;
    for (const PlacedMesh& mesh : placed) {
      const Marks mesh_marks = read_marks(file_, "meshes", mesh.mesh, "mesh " + std::to_string(mesh.mesh));
      const auto& primitives = file_.model().meshes[static_cast<std::size_t>(mesh.mesh)].primitives;
      for (std::size_t p = 0; p < primitives.size(); ++p) {
        const MaterialInfo& material = materials_.get(primitives[p].material);
        Job job{.placed = &mesh, .primitive = p, .role = mesh.pattern_role, .material = &material};
        std::optional<std::uint32_t> weight = mesh.pattern_weight;
        std::optional<double> detail = mesh.pattern_detail_mm, accuracy = mesh.pattern_accuracy_mm;
        for (const Marks* marks : {&mesh.marks, &mesh_marks, &material.marks}) {
          if (!job.role) job.role = marks->role;
          if (!weight) weight = marks->weight;
          if (!detail) detail = marks->detail_mm;
          if (!accuracy) accuracy = marks->accuracy_mm;
        }
        job.weight = weight.value_or(1);
        job.detail_mm = detail.value_or(0);
        job.accuracy_mm = accuracy.value_or(0);
        const std::optional<double> given[] = {mesh.marks.diffuse, mesh_marks.diffuse, material.marks.diffuse,
                                               material.luminance};
        const auto first = std::ranges::find_if(given, [](const auto& value) { return value.has_value(); });
        job.diffuse = first != std::end(given) ? **first : options_.default_diffuse;
        job.glass = is(kGlass, mesh, mesh_marks, material);
        job.mirror = !job.glass && is(kMirror, mesh, mesh_marks, material);
        some_surveyed = some_surveyed || (job.role == Role::surveyed && !job.glass && !job.mirror);
        jobs.push_back(job);
      }
    }
    leave_out_doors(jobs);
    for (Job& job : jobs) {
      if (!job.role) job.role = some_surveyed ? Role::blocking : Role::surveyed;
      const bool present = job.role != Role::ignore && job.role != Role::search;
      job.glass = job.glass && present;
      job.mirror = job.mirror && present;
      if (job.glass || job.mirror) job.role = Role::blocking;
    }
    std::ranges::stable_partition(jobs, [](const Job& job) { return !job.glass; });
    return jobs;
  }

  // A kind of surface, with the members by which patterns, marks and materials select it.
  struct Kind {
    std::vector<std::string> SceneOptions::*patterns;
    std::string_view none;  // the entry of the patterns that rules the kind out
    bool PlacedMesh::*named;
    std::optional<bool> Marks::*marked;
    bool MaterialInfo::*made;
  };
  static constexpr Kind kGlass{&SceneOptions::glass, kOpaqueGlass, &PlacedMesh::glass, &Marks::glass,
                               &MaterialInfo::glass};
  static constexpr Kind kMirror{&SceneOptions::mirror, kNoMirror, &PlacedMesh::mirror, &Marks::mirror,
                                &MaterialInfo::mirror};

  bool is(const Kind& kind, const PlacedMesh& mesh, const Marks& mesh_marks, const MaterialInfo& material) const {
    if (std::ranges::count(options_.*kind.patterns, kind.none) > 0) return false;
    if (mesh.*kind.named || mesh.own_role) return mesh.*kind.named;
    for (const Marks* marks : {&mesh.marks, &mesh_marks, &material.marks})
      if (marks->*kind.marked) return *(marks->*kind.marked);
    return material.*kind.made;
  }

  // Marks primitives to be stored once, if that saves memory and nothing but the node changes them.
  void choose_shared(std::vector<Job>& jobs) const {
    if (options_.shared_meshes == SharedMeshes::never) return;
    const bool always = options_.shared_meshes == SharedMeshes::always;
    double triangles = 0;
    std::map<std::pair<int, std::size_t>, std::size_t> uses;
    const auto shareable = [&](const Job& job) {
      return !job.glass && (job.role == Role::surveyed || job.role == Role::blocking) &&
             materials_.cutoffs[job.material->index] == 0 && is_exact(file_, job.placed->mesh, job.primitive);
    };
    for (const Job& job : jobs) {
      if (job.role == Role::ignore || job.role == Role::search) continue;
      const std::size_t places = job.placed->world_from_mesh.size();
      triangles += static_cast<double>(places) *
                   static_cast<double>(primitive_size(file_, job.placed->mesh, job.primitive).triangles);
      if (shareable(job)) uses[{job.placed->mesh, job.primitive}] += places;
    }
    if (!always && triangles <= kManyTriangles) return;
    for (Job& job : jobs)
      job.shared = shareable(job) && uses[{job.placed->mesh, job.primitive}] > 1 &&
                   (always || primitive_size(file_, job.placed->mesh, job.primitive).triangles >= kFewTriangles);
  }

  // Allocates room for all meshes, after checking that it is available.
  void reserve(const std::vector<Job>& jobs) {
    double shared_bytes = 0, places = 0;
    std::uint64_t largest_shared = 0;
    std::set<std::tuple<int, std::size_t, std::uint32_t>> shared;
    double vertices = 0, triangles = 0, search_vertices = 0, search_triangles = 0;  // products of the file's claims
    std::uint64_t largest = 0;
    bool normals = false, colours = false, texcoords = false, roles[4] = {};
    for (const Job& job : jobs) {
      if (job.role == Role::ignore) continue;
      const PrimitiveSize size = primitive_size(file_, job.placed->mesh, job.primitive);
      const auto instances = static_cast<double>(job.placed->world_from_mesh.size());
      roles[static_cast<std::size_t>(*job.role)] = true;
      if (job.shared) {
        constexpr double kAttributes = 2 * (sizeof(Float3) + sizeof(Float2) + sizeof(std::uint32_t));
        places += instances;
        if (!shared.emplace(job.placed->mesh, job.primitive, job.material->index).second) continue;
        shared_bytes += (kSharedVertex + kAttributes) * static_cast<double>(size.vertices) +
                        kSharedTriangle * static_cast<double>(size.triangles);
        largest_shared = std::max(largest_shared, size.triangles);
        continue;
      }
      const bool search = job.role == Role::search;
      (search ? search_vertices : vertices) += instances * static_cast<double>(size.vertices);
      (search ? search_triangles : triangles) += instances * static_cast<double>(size.triangles);
      largest = std::max(largest, size.triangles);
      normals |= size.normals, colours |= size.colours, texcoords |= job.material->texcoord_set >= 0;
    }
    const double vertex = kVertex + (normals ? sizeof(Float3) : 0) + (texcoords ? sizeof(Float2) : 0) +
                          (colours ? sizeof(std::uint32_t) : 0);
    const bool both =
        roles[static_cast<std::size_t>(Role::surveyed)] && roles[static_cast<std::size_t>(Role::blocking)];
    const double beside = both && !shared.empty() ? kVertexBeside * vertices + kTriangleBeside * triangles : 0;
    const double bytes = vertex * vertices + (kTriangle + (both ? kCoplanar : 0)) * triangles + beside +
                         kSearchVertex * search_vertices + kSearchTriangle * search_triangles + shared_bytes +
                         3 * places * (sizeof(MeshPlace) + sizeof(MeshInstance)) +
                         kSharedTriangleSorted * static_cast<double>(largest_shared);
    const auto whole = [](double value) { return static_cast<std::uint64_t>(std::min(value, 1e18)); };
    const std::string what = number(whole(triangles + search_triangles)) + " triangles on " +
                             number(whole(vertices + search_vertices)) + " vertices, instances counted,";
    budget_.keep(whole(bytes), what);
    budget_.require(kTriangleRead * std::max(largest, largest_shared), what);
    raw_.positions.reserve(whole(vertices));
    raw_.triangles.reserve(whole(triangles));
    if (normals) raw_.normals.reserve(whole(vertices));
    if (texcoords) raw_.texcoords.reserve(whole(vertices));
    if (colours) raw_.colours.reserve(whole(vertices));
    raw_.spare_bytes = budget_.left();
  }

  // Opens leaves that the file marks: they stop neither rays nor people, unless a pattern names them.
  void leave_out_doors(std::vector<Job>& jobs) {
    if (std::ranges::count(options_.doors, kClosedDoors) > 0) return;
    std::vector<std::string> names;
    for (Job& job : jobs) {
      if (!job.placed->marks.door.value_or(false) || job.placed->pattern_role || job.placed->door) continue;
      job.role = Role::ignore;
      if (names.empty() || names.back() != job.placed->name) names.push_back(job.placed->name);
    }
    doors_ = std::move(names);
  }

  // Opens leaves that only name or shape shows, in a file without marks. REQUIRES: lengths in metres, Z up.
  void find_doors() {
    if (!prepared() && std::ranges::count(options_.doors, kClosedDoors) == 0)
      for (std::string& name : open_doors(raw_, may_be_door_)) doors_.push_back(std::move(name));
    if (doors_.empty()) return;
    raw_.notes.push_back(std::to_string(doors_.size()) +
                         (doors_.size() == 1 ? " door is taken as open, its leaf left out: "
                                             : " doors are taken as open, their leaves left out: ") +
                         some_of(doors_) + "; the word closed for the setting doors keeps them");
  }

  // Area and names of meshes, as text; empty if there are none. REQUIRES: lengths in metres.
  struct Extent {
    std::string metres, names;
  };
  std::optional<Extent> extent_of(bool MeshInfo::*is) const {
    double area = 0;
    std::vector<std::string> names;
    for (std::size_t m = 0; m < raw_.meshes.size(); ++m) {
      if (!(raw_.meshes[m].*is)) continue;
      for_each_placed(raw_, m, [&](const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
        area += 0.5 * length(cross(b - a, c - a));
      });
      if (std::ranges::find(names, raw_.meshes[m].name) == names.end()) names.push_back(raw_.meshes[m].name);
    }
    if (names.empty()) return std::nullopt;
    return Extent{rounded(area), some_of(names)};
  }

  void note_glass() {
    if (const auto glass = extent_of(&MeshInfo::glass))
      raw_.notes.push_back("rays pass " + glass->metres +
                           " m² of glass, each face counted, which stops people and links: " + glass->names +
                           "; the word opaque for the setting glass stops rays too");
  }

  void note_mirrors() {
    if (const auto mirrors = extent_of(&MeshInfo::mirror))
      raw_.notes.push_back(mirrors->metres + " m² are mirrors, of which scans show ghosts and no points: " +
                           mirrors->names + "; the word none for the setting mirror makes them matt");
  }

  // Lists some of the names, each once, with its count if above 1.
  static std::string some_of(const std::vector<std::string>& names) {
    constexpr std::size_t kNamed = 3;
    std::string some;
    std::size_t named = 0, at = 0;
    while (at < names.size() && named < kNamed) {
      const std::size_t same =
          static_cast<std::size_t>(std::find_if(names.begin() + static_cast<std::ptrdiff_t>(at), names.end(),
                                                [&](const std::string& other) { return other != names[at]; }) -
                                   (names.begin() + static_cast<std::ptrdiff_t>(at)));
      some += (named++ ? ", " : "") + gltf::quoted(names[at]) + (same > 1 ? " (" + std::to_string(same) + ")" : "");
      at += same;
    }
    return some + (at < names.size() ? ", …" : "");
  }

  void read(const Job& job) {
    if (job.role == Role::ignore) return;
    if (job.shared) return place_shared(job);
    const auto primitive = read_primitive(file_, job.placed->mesh, job.primitive, skipped_);
    if (!primitive || primitive->triangles.empty()) return;
    const std::size_t instances = job.placed->world_from_mesh.size();
    const std::size_t triangles = job.role == Role::search ? raw_.search_triangles.size() : raw_.triangles.size();
    const std::size_t vertices = job.role == Role::search ? raw_.search_positions.size() : raw_.positions.size();
    if (instances > kMostTriangles || primitive->triangles.size() * instances > kMostTriangles - triangles ||
        primitive->position->count() * instances > std::numeric_limits<std::uint32_t>::max() - vertices)
      throw file_.malformed("node " + quoted(job.placed->name) +
                            ": more than 2^31 triangles or 2^32 vertices; split the scene");
    if (job.role == Role::search) {
      for (const glm::dmat4& world_from_mesh : job.placed->world_from_mesh) append_search(*primitive, world_from_mesh);
      return;
    }
    add_range(job, primitive->triangles.size() * instances);
    for (const glm::dmat4& world_from_mesh : job.placed->world_from_mesh)
      append(*primitive, *job.material, world_from_mesh);
  }

  // Adds a mesh that owns the next triangles.
  void add_range(const Job& job, std::size_t triangles) {
    const Marks& marks = job.placed->marks;
    may_be_door_.push_back(!job.placed->pattern_role && !marks.role && !job.placed->door && !marks.door);
    raw_.ranges.push_back({static_cast<std::uint32_t>(raw_.triangles.size()), static_cast<std::uint32_t>(triangles),
                           job.material->index});
    raw_.meshes.push_back({.name = job.placed->name,
                           .role = *job.role,
                           .diffuse = job.diffuse,
                           .triangle_count = raw_.ranges.back().triangle_count,
                           .weight = job.weight,
                           .door = job.placed->door,
                           .station_area = job.placed->station_area,
                           .glass = job.glass,
                           .mirror = job.mirror,
                           .detail_m = job.detail_mm * 1e-3,
                           .accuracy_m = job.accuracy_mm * 1e-3});
    if (!raw_.placed.empty()) raw_.placed.resize(raw_.ranges.size());
  }

  // Adds a mesh that owns only its places.
  void place_shared(const Job& job) {
    const auto [known, first] =
        shared_.emplace(std::tuple(job.placed->mesh, job.primitive, job.material->index), Shared{});
    if (first) known->second = read_shared(job);
    const Shared& shared = known->second;
    if (!shared.index) return;
    const std::size_t triangles = raw_.shared[*shared.index].triangles.size();
    const std::vector<glm::dmat4>& places = job.placed->world_from_mesh;
    placed_triangles_ += static_cast<double>(triangles) * static_cast<double>(places.size());
    if (placed_triangles_ + static_cast<double>(raw_.triangles.size()) > static_cast<double>(kMostTriangles))
      throw file_.malformed("node " + quoted(job.placed->name) + ": more than 2^31 triangles; split the scene");
    add_range(job, 0);
    raw_.placed.resize(raw_.ranges.size());
    for (const glm::dmat4& world_from_mesh : places) {
      raw_.placed.back().push_back({*shared.index, place_of(world_from_mesh)});
      mirrored_meshes_ += raw_.placed.back().back().place.mirrored ? 1 : 0;
      note_spacing(shared.farthest, world_from_mesh);
    }
  }

  struct Shared {
    std::optional<std::uint32_t> index;  // in raw_.shared; empty: it has no triangles
    double farthest = 0;                 // its largest float32 coordinate
  };
  Shared read_shared(const Job& job) {
    Shared shared;
    const auto primitive = read_primitive(file_, job.placed->mesh, job.primitive, skipped_);
    if (!primitive || primitive->triangles.empty()) return shared;
    // Reads it as if it stood in the survey frame, then moves it out of there.
    RawScene alone;
    std::swap(raw_, alone);
    append(*primitive, *job.material, std::nullopt);
    std::swap(raw_, alone);
    SharedMesh mesh{
        {}, std::move(alone.normals), std::move(alone.texcoords), std::move(alone.colours), std::move(alone.triangles)};
    for (const glm::dvec3& p : alone.positions) mesh.positions.push_back(to_float3(p));
    if (primitive->position->is_float()) shared.farthest = farthest_of(*primitive->position);
    shared.index = static_cast<std::uint32_t>(raw_.shared.size());
    raw_.shared.push_back(std::move(mesh));
    return shared;
  }

  // Transform to apply; empty: positions stay as in the file.
  using Transform = std::optional<glm::dmat4>;

  void append_triangles(const Primitive& primitive, const Transform& world_from_mesh, std::size_t first_vertex,
                        std::vector<Triangle>& out) {
    const auto offset = static_cast<std::uint32_t>(first_vertex);
    const bool mirrored = world_from_mesh && mirrors(glm::dmat3(*world_from_mesh));
    mirrored_meshes_ += mirrored ? 1 : 0;
    for (const Triangle& t : primitive.triangles)
      out.push_back(turned({t[0] + offset, t[1] + offset, t[2] + offset}, mirrored));
  }

  void append_positions(const Primitive& primitive, const Transform& world_from_mesh, std::vector<glm::dvec3>& out) {
    const std::size_t first = out.size();
    out.resize(first + primitive.position->count());
    in_blocks(primitive.position->count(), [&](std::size_t begin, std::size_t n, double* values) {
      primitive.position->read(begin, n, values);
      for (std::size_t i = 0; i < n; ++i) {
        const glm::dvec3 p = glm::make_vec3(values + 3 * i);
        out[first + begin + i] = world_from_mesh ? transformed(*world_from_mesh, p) : p;
      }
    });
    if (world_from_mesh && primitive.position->is_float())
      note_spacing(farthest_of(*primitive.position), *world_from_mesh);
  }

  // Returns the largest absolute coordinate.
  static double farthest_of(const Accessor& position) {
    double farthest = 0;
    std::mutex mutex;
    in_blocks(position.count(), [&](std::size_t begin, std::size_t n, double* values) {
      position.read(begin, n, values);
      double block = 0;
      for (std::size_t i = 0; i < 3 * n; ++i)
        if (std::isfinite(values[i])) block = std::max(block, std::abs(values[i]));
      const std::scoped_lock lock(mutex);
      farthest = std::max(farthest, block);
    });
    return farthest;
  }

  // Notes the spacing of float32 values at a primitive's coordinates, scaled by the node.
  void note_spacing(double farthest, const glm::dmat4& world_from_mesh) {
    double scale = 0;
    for (int c = 0; c < 3; ++c) scale = std::max(scale, length(glm::dvec3(world_from_mesh[c])));
    if (farthest * scale > 1e9) return;  // dropped as broken later
    const double spacing = std::ldexp(1.0, std::ilogb(std::max(farthest, 1e-30)) - 23) * scale;
    raw_.coarsest_input_spacing_m = std::max(raw_.coarsest_input_spacing_m, spacing);
  }

  void append(const Primitive& primitive, const MaterialInfo& material, const Transform& world_from_mesh) {
    const std::size_t first = raw_.positions.size(), count = primitive.position->count();
    append_triangles(primitive, world_from_mesh, first, raw_.triangles);
    append_positions(primitive, world_from_mesh, raw_.positions);
    extend(raw_.normals, primitive.normal != nullptr, first + count, Float3{});
    if (primitive.normal) {
      const glm::dmat3 map = world_from_mesh ? normal_map(glm::dmat3(*world_from_mesh)) : glm::dmat3(1);
      in_blocks(count, [&](std::size_t begin, std::size_t n, double* values) {
        primitive.normal->read(begin, n, values);
        for (std::size_t i = 0; i < n; ++i) {
          if (!world_from_mesh) {
            raw_.normals[first + begin + i] = to_float3(glm::make_vec3(values + 3 * i));
            continue;
          }
          const glm::dvec3 normal = map * glm::make_vec3(values + 3 * i);
          const double size = length(normal);
          if (!(size > 0) || !std::isfinite(size)) continue;  // stays (0, 0, 0): no normal
          raw_.normals[first + begin + i] = to_float3(normal * (1 / size));
        }
      });
    }
    const auto texcoord = primitive.texcoord(file_, material.texcoord_set);
    extend(raw_.texcoords, texcoord != nullptr, first + count, Float2{});
    if (texcoord)
      in_blocks(count, [&](std::size_t begin, std::size_t n, double* values) {
        texcoord->read(begin, n, values);
        const auto& m = material.uv_map;
        for (std::size_t i = 0; i < n; ++i) {
          const double u = values[2 * i], v = values[2 * i + 1];
          raw_.texcoords[first + begin + i] = {static_cast<float>(m[0][0] * u + m[0][1] * v + m[0][2]),
                                               static_cast<float>(m[1][0] * u + m[1][1] * v + m[1][2])};
        }
      });
    extend(raw_.colours, primitive.colour != nullptr, first + count, std::uint32_t{0xFFFFFFFF});
    if (primitive.colour) {
      const int components = primitive.colour->components();
      in_blocks(count, [&](std::size_t begin, std::size_t n, double* values) {
        primitive.colour->read(begin, n, values);
        for (std::size_t i = 0; i < n; ++i)
          raw_.colours[first + begin + i] =
              packed_colour(values + i * static_cast<std::size_t>(components), components);
      });
    }
  }

  void append_search(const Primitive& primitive, const glm::dmat4& world_from_mesh) {
    const std::size_t first = raw_.search_positions.size(), count = primitive.position->count();
    append_triangles(primitive, world_from_mesh, first, raw_.search_triangles);
    append_positions(primitive, world_from_mesh, raw_.search_positions);
    const auto uv = primitive.texcoord(file_, 0);
    if (!uv) {
      search_without_uv_ = true;
      return;
    }
    std::vector<double> values(2 * count);
    uv->read(0, count, values.data());
    raw_.search_uvs.resize(first);
    for (std::size_t i = 0; i < count; ++i) raw_.search_uvs.push_back({values[2 * i], values[2 * i + 1]});
  }

  // Reads nodes without a mesh that importers describe: a box in metres, Y up, whatever the file's axes are.
  void read_rooms() {
    const auto& nodes = file_.model().nodes;
    std::vector<int> above(nodes.size(), -1);
    for (std::size_t n = 0; n < nodes.size(); ++n)
      for (const int child : nodes[n].children)
        if (child >= 0 && static_cast<std::size_t>(child) < nodes.size())
          above[static_cast<std::size_t>(child)] = static_cast<int>(n);
    for (std::size_t n = 0; n < nodes.size(); ++n) {
      const nlohmann::json& marks = file_.find("nodes", static_cast<int>(n), {"extras", "vantage"});
      if (!marks.is_object() || !marks.contains("box")) continue;
      const auto corner = [&](std::size_t k) {
        const nlohmann::json& box = marks["box"];
        const bool sound = box.is_array() && box.size() == 2 && box[k].is_array() && box[k].size() == 3 &&
                           std::ranges::all_of(box[k], [](const nlohmann::json& v) { return v.is_number(); });
        if (!sound)
          throw file_.malformed("node " + std::to_string(n) +
                                ": extras.vantage.box is not two corners of three numbers each");
        return Vec3{box[k][0].get<double>(), -box[k][2].get<double>(), box[k][1].get<double>()};
      };
      const auto text = [&](const char* key) {
        return marks.contains(key) && marks[key].is_string() ? marks[key].get<std::string>() : std::string();
      };
      const std::string number = text("name"), name = text("long_name");
      Room room{.name = name.empty() || name == number ? number
                        : number.empty()               ? name
                                                       : number + " " + name,
                .storey = storey_above(static_cast<int>(n), above),
                .box = {}};
      room.box.extend(corner(0)), room.box.extend(corner(1));
      if (marks.contains("footprint")) room.outline = read_outline(marks["footprint"], n);
      raw_.rooms.push_back(std::move(room));
    }
  }

  // Returns the storey's name above a node, whose parents are in `above`; "" if there is none.
  std::string storey_above(int node, const std::vector<int>& above) const {
    for (std::size_t steps = 0; node >= 0 && steps <= above.size(); ++steps) {  // a cycle was refused
      const nlohmann::json& marks = file_.find("nodes", node, {"extras", "vantage"});
      if (marks.is_object() && is_text(marks, "class", "IfcBuildingStorey")) {
        for (const char* key : {"name", "long_name"})
          if (marks.contains(key) && marks[key].is_string()) return marks[key].get<std::string>();
        return file_.model().nodes[static_cast<std::size_t>(node)].name;
      }
      node = above[static_cast<std::size_t>(node)];
    }
    return {};
  }

  // Reads loops of corners (x, z), Y up.
  std::vector<std::vector<std::array<double, 2>>> read_outline(const nlohmann::json& loops, std::size_t node) const {
    std::vector<std::vector<std::array<double, 2>>> outline;
    const auto refuse = [&] {
      return file_.malformed("node " + std::to_string(node) +
                             ": extras.vantage.footprint is not a list of loops of corners, two numbers each");
    };
    if (!loops.is_array()) throw refuse();
    for (const nlohmann::json& loop : loops) {
      if (!loop.is_array()) throw refuse();
      auto& corners = outline.emplace_back();
      for (const nlohmann::json& corner : loop) {
        if (!corner.is_array() || corner.size() != 2 || !corner[0].is_number() || !corner[1].is_number())
          throw refuse();
        corners.push_back({corner[0].get<double>(), -corner[1].get<double>()});
      }
    }
    return outline;
  }

  // Adds the notes of an importer.
  void pass_notes_on() {
    const nlohmann::json& notes = file_.asset_extras("notes");
    if (!notes.is_array()) return;
    for (const nlohmann::json& note : notes)
      if (note.is_string()) raw_.notes.push_back(note.get<std::string>());
  }

  void note_skipped() {
    const auto note = [&](std::size_t count, const std::string& what) {
      if (count > 0) raw_.notes.push_back(std::to_string(count) + " " + what);
    };
    note(skipped_.points_or_lines, "primitives of points or lines were ignored");
    note(skipped_.without_positions, "primitives without positions were ignored");
    note(skipped_.morphed, "primitives have morph targets, which are not applied");
    note(skipped_.cut_short, "triangle lists end with one or two left-over vertices, which were ignored");
    note(mirrored_meshes_, "meshes are mirrored by their node; their winding was turned to keep normals outward");
    if (search_without_uv_ && !raw_.search_uvs.empty())
      raw_.notes.emplace_back("part of the search area has no (u, v), so that of the rest is not used");
    if (search_without_uv_) raw_.search_uvs.clear();
  }

  const File& file_;
  const SceneOptions& options_;
  const bool converted_;
  LoadBudget& budget_;
  RawScene raw_;
  MaterialTable materials_;
  SkippedPrimitives skipped_;
  std::vector<std::string> doors_;         // that are open
  std::vector<std::uint8_t> may_be_door_;  // per mesh
  std::size_t mirrored_meshes_ = 0;
  std::map<std::tuple<int, std::size_t, std::uint32_t>, Shared> shared_;  // by mesh, primitive and material
  double placed_triangles_ = 0;                                           // of shared meshes, at each place
  bool search_without_uv_ = false;
};

}  // namespace
}  // namespace gltf

namespace {

// `open` returns the glTF file; `note`, unless empty, becomes the scene's first note. `converted`: see Loader.
template <class Open>
Scene load_scene(Open&& open, const std::string& name, const SceneOptions& options, const std::string& note = {},
                 bool converted = false) {
  if (!(options.default_diffuse >= 0 && options.default_diffuse <= 1))
    throw Error(Errc::invalid_argument,
                "default_diffuse must be in [0, 1]; " + std::to_string(options.default_diffuse) + " was given");
  try {
    LoadBudget budget(options.max_memory_bytes, name);
    const gltf::File file = open(budget);
    RawScene raw = gltf::Loader(file, options, budget, converted).load();
    if (!note.empty()) raw.notes.insert(raw.notes.begin(), note);
    return Scene(finish_scene(std::move(raw), name));
  } catch (const std::bad_alloc&) {
    throw Error(Errc::out_of_memory, name + ": the scene does not fit into memory");
  } catch (const std::length_error&) {
    throw Error(Errc::out_of_memory, name + ": the scene does not fit into memory");
  }
}

}  // namespace

Scene Scene::load(const std::filesystem::path& file, const SceneOptions& options) {
  const importers::Recognised recognised = importers::recognise(file, options.beside);
  const auto settings = importer_settings(options, *recognised.format, file.string());
  if (!recognised.format->importer)
    return load_scene([&](LoadBudget& budget) { return gltf::File(file, options.allow_outside, budget); },
                      file.string(), options, recognised.note);
  const std::vector<std::uint8_t> glb =
      importers::as_glb(file, *recognised.format, {.memory = options.max_memory_bytes}, settings, {}, options.beside);
  return load_scene([&](LoadBudget& budget) { return gltf::File(glb, file.string(), budget); }, file.string(), options,
                    recognised.note, takes_setting(*recognised.format, "unit"));
}

Scene load_gltf(std::span<const std::uint8_t> bytes, const SceneOptions& options, const std::string& name) {
  return load_scene([&](LoadBudget& budget) { return gltf::File(bytes, name, budget); }, name, options);
}

}  // namespace vantage
