// SPDX-License-Identifier: Apache-2.0
#include "import/mesh/model.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "core/utf8.hpp"
#include "import/glb_bytes.hpp"
#include "import/program.hpp"

namespace vantage::importer {
namespace {

using nlohmann::json;

bool finite(const glm::dvec3& p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); }

// Bounds of all finite corners; empty without one.
struct Bounds {
  glm::dvec3 low = glm::dvec3(INFINITY), high = glm::dvec3(-INFINITY);

  void extend(const Mesh& mesh) {
    for (const Part& part : mesh.parts)
      for (const std::uint32_t v : part.indices)
        if (const glm::dvec3& p = part.positions[v]; finite(p)) low = glm::min(low, p), high = glm::max(high, p);
  }
  bool empty() const { return !finite(low) || !finite(high); }
  double extent() const { return std::max({high.x - low.x, high.y - low.y, high.z - low.z}); }
};

// Returns zero while no coordinate exceeds `near` times the mesh's extent; else the mesh's middle, rounded.
glm::dvec3 origin_of(const Mesh& mesh, double near) {
  Bounds bounds;
  bounds.extend(mesh);
  if (bounds.empty()) return glm::dvec3(0);
  const double extent = bounds.extent();
  const glm::dvec3 middle = 0.5 * (bounds.low + bounds.high);
  const double farthest = std::max({std::abs(middle.x), std::abs(middle.y), std::abs(middle.z)});
  if (!(farthest > near * extent) || !(extent > 0)) return glm::dvec3(0);
  const double step = std::pow(10, std::ceil(std::log10(extent)));
  return {step * std::round(middle.x / step), step * std::round(middle.y / step), step * std::round(middle.z / step)};
}

// Models about their own origin keep their coordinates, except meshes far from it. Models on a site's or a national
// grid lie at least as far from 0 as they are wide, so that float32 would round them all.
double near_of(const Model& model) {
  constexpr double kLocal = 64, kElsewhere = 1, kFar = 1.5;
  if (model.rounded) return kLocal;  // no origin is chosen
  Bounds bounds;
  for (const Mesh& mesh : model.meshes) bounds.extend(mesh);
  if (bounds.empty()) return kLocal;
  const glm::dvec3 far = glm::max(glm::abs(bounds.low), glm::abs(bounds.high));
  return std::max({far.x, far.y, far.z}) > kFar * bounds.extent() ? kElsewhere : kLocal;
}

// Stores each distinct corner once.
class Vertices {
 public:
  Vertices(const Part& part, const glm::dvec3& origin) : part_(part), origin_(origin) {
    table_.resize(std::bit_ceil(2 * std::min(part.indices.size(), part.positions.size()) + 2), kFree);
    known_.resize(part.positions.size(), kFree);
  }

  std::uint32_t add(std::uint32_t v) {
    if (known_[v] != kFree) return known_[v];
    Row row;
    for (int c = 0; c < 3; ++c) row.values[static_cast<std::size_t>(c)] = bits(part_.positions[v][c] - origin_[c]);
    if (!part_.normals.empty())
      for (int c = 0; c < 3; ++c) row.values[static_cast<std::size_t>(3 + c)] = bits(part_.normals[v][c]);
    if (!part_.colours.empty()) row.values[6] = std::bit_cast<std::uint32_t>(part_.colours[v]);
    std::uint64_t hash = 0;
    for (const std::uint32_t value : row.values) hash = (std::rotl(hash, 5) ^ value) * 0x9E3779B97F4A7C15U;
    const std::size_t mask = table_.size() - 1;
    std::size_t at = (hash >> 20) & mask;
    while (table_[at] != kFree && std::memcmp(&rows_[table_[at]], &row, sizeof row) != 0) at = (at + 1) & mask;
    if (table_[at] == kFree) {
      table_[at] = static_cast<std::uint32_t>(rows_.size());
      rows_.push_back(row);
    }
    return known_[v] = table_[at];
  }

  // Returns three values of each row from a column on.
  std::vector<float> triples(std::size_t column) const {
    std::vector<float> out;
    out.reserve(3 * rows_.size());
    for (const Row& row : rows_)
      for (std::size_t c = 0; c < 3; ++c) out.push_back(std::bit_cast<float>(row.values[column + c]));
    return out;
  }
  std::vector<std::uint8_t> colours() const {
    std::vector<std::uint8_t> out;
    out.reserve(4 * rows_.size());
    for (const Row& row : rows_) {
      const Rgba rgba = std::bit_cast<Rgba>(row.values[6]);
      out.insert(out.end(), rgba.begin(), rgba.end());
    }
    return out;
  }

 private:
  static constexpr std::uint32_t kFree = 0xFFFFFFFF;
  struct Row {
    std::array<std::uint32_t, 7> values{};  // position, normal, colour
  };
  static std::uint32_t bits(double value) { return std::bit_cast<std::uint32_t>(static_cast<float>(value) + 0.0F); }

  const Part& part_;
  const glm::dvec3 origin_;
  std::vector<std::uint32_t> table_, known_;
  std::vector<Row> rows_;
};

class Writer {
 public:
  explicit Writer(const Model& model)
      : model_(model),
        near_(near_of(model)),
        mesh_indices_(model.meshes.size(), -1),
        origins_(model.meshes.size(), glm::dvec3(0)) {}

  std::string run() {
    for (std::size_t m = 0; m < model_.meshes.size(); ++m) add_mesh(m);
    if (meshes_.empty()) refuse_without_triangles();
    const int root = add_node(0);
    json vantage = json::object();
    if (model_.unit) vantage["unit"] = "m";
    if (model_.up) vantage["up"] = "y";
    json asset{{"version", "2.0"}, {"generator", "vantage-import-mesh"}};
    json extras = json::object();
    if (!vantage.empty()) extras["vantage"] = vantage;
    if (const json notes = notes_of(); !notes.empty()) extras["notes"] = notes;
    if (!extras.empty()) asset["extras"] = extras;
    json document{
        {"asset", asset}, {"scene", 0}, {"scenes", {{{"nodes", {root}}}}}, {"nodes", nodes_}, {"meshes", meshes_}};
    if (!materials_.empty()) document["materials"] = materials_;
    return buffer_.finish(document);
  }

 private:
  std::string left_out() const {
    std::string text;
    for (const auto& [kind, count] : model_.left_out)
      text += (text.empty() ? "" : ", ") + std::to_string(count) + " " + kind;
    return text;
  }

  [[noreturn]] void refuse_without_triangles() const {
    if (!model_.left_out.empty())
      throw Refused("it holds no triangle, but " + left_out() +
                    ", which vantage does not read; export the model with "
                    "faces");
    if (model_.lines_or_points == 0) throw Refused("it holds no triangle; export the model with faces");
    throw Refused("it holds points or lines alone, " + std::to_string(model_.lines_or_points) +
                  " of them; a survey is planned on surfaces: export the model with faces");
  }

  json notes_of() const {
    json notes = model_.notes;
    if (model_.lines_or_points > 0)
      notes.push_back(std::to_string(model_.lines_or_points) + " points and lines of the model are left out");
    if (!model_.left_out.empty())
      notes.push_back("these are left out, since vantage does not read them: " + left_out());
    if (broken_ > 0)
      notes.push_back(std::to_string(broken_) + " triangles are left out, since a coordinate of theirs is no number");
    return notes;
  }

  void add_mesh(std::size_t index) {
    const Mesh& mesh = model_.meshes[index];
    if (!model_.rounded) origins_[index] = origin_of(mesh, near_);
    json out{{"primitives", json::array()}};
    for (const Part& part : mesh.parts)
      if (json primitive = primitive_of(part, origins_[index]); !primitive.is_null())
        out["primitives"].push_back(std::move(primitive));
    if (out["primitives"].empty()) return;
    if (!mesh.name.empty()) out["name"] = to_utf8(mesh.name);
    mesh_indices_[index] = static_cast<int>(meshes_.size());
    meshes_.push_back(std::move(out));
  }

  json primitive_of(const Part& part, const glm::dvec3& origin) {
    Vertices vertices(part, origin);
    std::vector<std::uint32_t> indices;
    indices.reserve(part.indices.size());
    for (std::size_t i = 0; i + 2 < part.indices.size(); i += 3) {
      const std::uint32_t* const t = &part.indices[i];
      if (!finite(part.positions[t[0]]) || !finite(part.positions[t[1]]) || !finite(part.positions[t[2]])) {
        ++broken_;
        continue;
      }
      for (int corner = 0; corner < 3; ++corner) indices.push_back(vertices.add(t[corner]));
    }
    if (indices.empty()) return {};
    json primitive{{"attributes", {{"POSITION", buffer_.add_positions(vertices.triples(0))}}}};
    if (!part.normals.empty()) primitive["attributes"]["NORMAL"] = buffer_.add_normals(vertices.triples(3));
    if (!part.colours.empty()) primitive["attributes"]["COLOR_0"] = buffer_.add_colours(vertices.colours());
    primitive["indices"] = buffer_.add_indices(indices);
    if (part.material >= 0) primitive["material"] = material_of(static_cast<std::size_t>(part.material));
    return primitive;
  }

  int material_of(std::size_t index) {
    const auto [known, is_new] = material_indices_.try_emplace(index, static_cast<int>(materials_.size()));
    if (!is_new) return known->second;
    const Material& given = model_.materials[index];
    json material{{"name", to_utf8(given.name)}, {"doubleSided", true}};
    const auto share = [](double value) { return std::isfinite(value) ? std::clamp(value, 0.0, 1.0) : 0.0; };
    // Full transparency is a slip of the exporter.
    const double opacity = share(given.rgba[3]) > 0 ? share(given.rgba[3]) : 1;
    if (!given.textured)
      material["pbrMetallicRoughness"] = {
          {"baseColorFactor", {share(given.rgba[0]), share(given.rgba[1]), share(given.rgba[2]), opacity}},
          {"metallicFactor", 0.0}};
    if (opacity < 1) material["alphaMode"] = "BLEND";
    materials_.push_back(material);
    return known->second;
  }

  static void set_matrix(json& node, const glm::dmat4& matrix) {
    if (matrix == glm::dmat4(1)) return;
    for (int column = 0; column < 4; ++column)
      for (int row = 0; row < 4; ++row) {
        if (!std::isfinite(matrix[column][row]))
          throw Refused("the transform of node " + node.value("name", "") + " is not finite");
        node["matrix"].push_back(matrix[column][row]);
      }
  }

  // Adds a node. A mesh about its own origin, or beside other meshes of its node, gets a node below.
  int add_node(std::size_t index) {
    const Node& node = model_.nodes[index];
    const auto at = static_cast<int>(nodes_.size());
    nodes_.push_back(json::object());
    json out = json::object();
    if (!node.name.empty()) out["name"] = to_utf8(node.name);
    std::vector<std::size_t> shown;
    std::ranges::copy_if(node.meshes, std::back_inserter(shown), [&](std::size_t m) { return mesh_indices_[m] >= 0; });
    glm::dmat4 matrix = node.outer_from_node;
    json children = json::array();
    if (shown.size() == 1 && (node.children.empty() || origins_[shown[0]] == glm::dvec3(0))) {
      out["mesh"] = mesh_indices_[shown[0]];
      matrix = matrix * from_origin(shown[0]);
    } else {
      for (const std::size_t m : shown) {
        json child{{"mesh", mesh_indices_[m]}};
        if (const std::string& name = model_.meshes[m].name; !name.empty()) child["name"] = to_utf8(name);
        set_matrix(child, from_origin(m));
        children.push_back(nodes_.size());
        nodes_.push_back(std::move(child));
      }
    }
    set_matrix(out, matrix);
    for (const std::size_t child : node.children) children.push_back(add_node(child));
    if (!children.empty()) out["children"] = children;
    nodes_[static_cast<std::size_t>(at)] = std::move(out);
    return at;
  }

  glm::dmat4 from_origin(std::size_t mesh) const {
    glm::dmat4 matrix(1);
    matrix[3] = glm::dvec4(origins_[mesh], 1);
    return matrix;
  }

  const Model& model_;
  double near_;
  Buffer buffer_;
  std::vector<int> mesh_indices_;  // in glTF; -1: no triangles
  std::vector<glm::dvec3> origins_;
  std::map<std::size_t, int> material_indices_;
  json nodes_ = json::array(), meshes_ = json::array(), materials_ = json::array();
  std::size_t broken_ = 0;
};

}  // namespace

std::size_t Model::add_mesh(Mesh mesh) {
  meshes.push_back(std::move(mesh));
  return meshes.size() - 1;
}

std::size_t Model::add_node(std::size_t parent, std::string name, const glm::dmat4& outer_from_node) {
  nodes.push_back({std::move(name), outer_from_node, {}, {}});
  nodes[parent].children.push_back(nodes.size() - 1);
  return nodes.size() - 1;
}

std::string glb_of(const Model& model) { return Writer(model).run(); }

glm::dmat4 from_z_up() { return {{1, 0, 0, 0}, {0, 0, -1, 0}, {0, 1, 0, 0}, {0, 0, 0, 1}}; }

glm::dmat4 moved_by(const glm::dvec3& way) {
  glm::dmat4 m(1);
  m[3] = glm::dvec4(way, 1);
  return m;
}
glm::dmat4 from_x_up() { return {{0, 1, 0, 0}, {-1, 0, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}; }

}  // namespace vantage::importer
