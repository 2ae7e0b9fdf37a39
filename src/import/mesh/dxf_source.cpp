// SPDX-License-Identifier: Apache-2.0
// Models in DXF: faces, meshes of polygons and of faces, filled quadrilaterals, lines with a thickness, and the blocks
// that place them. Each layer is a mesh, each placed block a node.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "import/floor_plan/dxf.hpp"
#include "import/floor_plan/labels.hpp"
#include "import/floor_plan/layers.hpp"
#include "import/mesh/dxf_thickness.hpp"
#include "import/mesh/polygon.hpp"
#include "import/mesh/sources.hpp"
#include "import/program.hpp"

namespace vantage::importer {
namespace {

using floor_plan::Entity, floor_plan::Group;

using Counts = std::map<std::string, std::size_t>;

enum class LayerState {
  shown,
  off,
  frozen
};  // blocks placed on a layer that is off may show; blocks placed on a frozen layer do not

struct PlacedBlock {
  std::string block;
  glm::dmat4 outer_from_block{1};  // without the block's base
  int columns = 1, rows = 1;
  glm::dvec3 column_step{0}, row_step{0};
  std::string layer;
};

// Entities of a block, or of the model.
struct DxfContent {
  glm::dvec3 base{0};
  std::string name;
  bool external = false;              // a reference to another file
  std::map<std::string, Part> faces;  // by layer
  std::map<std::string, std::size_t> meshes;
  std::map<std::string, Counts> drawn;  // entities by layer and type
  Counts left_out, hidden;
  std::vector<PlacedBlock> inserts;
};

glm::dvec3 point_of(const Entity& entity, int code) {
  return {entity.number(code), entity.number(code + 10), entity.number(code + 20)};
}

class DxfModel {
 public:
  DxfModel() {
    model_.up = true;
    model_.nodes[0].outer_from_node = from_z_up();
  }

  Model read(const std::filesystem::path& file) {
    floor_plan::read_dxf(file,
                         {.header = [&](const auto& variables) { read_header(variables); },
                          .layer = [&](const Entity& layer) { add_layer(layer); },
                          .begin_block = [&](const Entity& block) { begin_block(block); },
                          .entity = [&](const Entity& entity, const std::vector<Entity>& parts,
                                        bool in_block) { add_entity(entity, parts, in_block ? *block_ : whole_); }});
    place(whole_, 0, {}, 0);
    if (!hidden_.empty())
      model_.notes.push_back(
          "what does not show (invisible, on layers that are off or frozen, or on sheets) is left out: " +
          listed(hidden_));
    if (smoothed_ > 0)
      model_.notes.push_back(std::to_string(smoothed_) + " MESH are read as their frames, without smoothing");
    // Lists the types alone if layers and types together are too many for a message.
    constexpr std::size_t kMostTold = 40;
    if (model_.left_out.size() > kMostTold) {
      Counts types;
      for (const auto& [kind, times] : model_.left_out) types[kind.substr(0, kind.find(" on "))] += times;
      model_.left_out = std::move(types);
    }
    return std::move(model_);
  }

 private:
  void read_header(const std::map<std::string_view, Group>& variables) {
    if (const auto found = variables.find("$DWGCODEPAGE"); found != variables.end()) code_page_ = found->second.value;
    const auto code = variables.find("$INSUNITS");
    const auto* unit = code == variables.end() ? nullptr : floor_plan::unit_of_code(integer(code->second));
    if (!unit) return;
    model_.unit = true, metres_ = unit->metres;
    for (int c = 0; c < 3; ++c) model_.nodes[0].outer_from_node[c] *= metres_;
  }
  void add_layer(const Entity& layer) {
    constexpr int kFrozen = 1;
    layers_[key(layer.text(2))] = (layer.integer(70) & kFrozen) != 0 ? LayerState::frozen
                                  : layer.integer(62, 7) < 0         ? LayerState::off
                                                                     : LayerState::shown;
  }
  void begin_block(const Entity& block) {
    constexpr int kExternal = 4 | 8;
    block_ = &blocks_[key(block.text(2))];
    block_->name = floor_plan::plain_name(std::string(block.text(2)), code_page_);
    block_->base = point_of(block, 10);
    block_->external = (block.integer(70) & kExternal) != 0;
  }
  // Names ignore case; messages use the spelling that came first.
  std::string key(std::string_view name) {
    const std::string plain = floor_plan::plain_name(std::string(name), code_page_);
    std::string lower = floor_plan::lower_case(plain);
    names_.try_emplace(lower, plain);
    return lower;
  }

  void add_entity(const Entity& entity, const std::vector<Entity>& parts, DxfContent& into) {
    if (entity.type == "VIEWPORT" || entity.type == "SEQEND" || entity.type == "ATTDEF") return;
    const std::string layer = key(entity.text(8, "0"));
    const std::string type(entity.type);
    if (entity.integer(67) != 0 || entity.integer(60) != 0)
      ++into.hidden[type + " on " + names_[layer]];
    else if (!draw(entity, parts, layer, into))
      ++into.left_out[type + " on " + names_[layer]];
    else if (type != "INSERT")
      ++into.drawn[layer][type];
  }
  static std::string listed(const Counts& counts) {
    std::string out;
    for (const auto& [kind, times] : counts) out += (out.empty() ? "" : ", ") + std::to_string(times) + " " + kind;
    return out;
  }

  // Returns true if this type is read.
  bool draw(const Entity& entity, const std::vector<Entity>& parts, const std::string& layer, DxfContent& into) {
    if (entity.type == "INSERT") return add_insert(entity, layer, into);
    Part& part = into.faces[layer];
    if (entity.type == "3DFACE") return add_corners(entity, {10, 11, 12, 13}, glm::dmat4(1), part);
    if (entity.type == "SOLID" || entity.type == "TRACE") return add_solid(entity, part);
    if (entity.type == "MESH") return add_mesh(entity, part);
    constexpr int kPolygons = 16, kFaces = 64;
    const int flags = entity.type == "POLYLINE" ? entity.integer(70) : 0;
    if ((flags & kFaces) != 0) return add_faces(parts, part);
    if ((flags & kPolygons) != 0) return add_polygons(entity, parts, part);
    const auto faces = faces_of_thick_line(entity, parts, metres_);
    for (const auto& face : faces) add_fan(part, face);
    return !faces.empty();
  }

  static void add_triangle(Part& part, const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
    if (a == b || b == c || c == a) return;
    for (const glm::dvec3& p : {a, b, c}) {
      part.indices.push_back(static_cast<std::uint32_t>(part.positions.size()));
      part.positions.push_back(p);
    }
  }
  static void add_fan(Part& part, const std::vector<glm::dvec3>& ring) {
    for (std::size_t i = 1; i + 1 < ring.size(); ++i) add_triangle(part, ring[0], ring[i], ring[i + 1]);
  }

  // A missing corner repeats the one before it.
  static bool add_corners(const Entity& entity, const std::array<int, 4>& codes, const glm::dmat4& system, Part& part) {
    std::vector<glm::dvec3> ring;
    for (const int code : codes)
      if (entity.has(code)) ring.emplace_back(system * glm::dvec4(point_of(entity, code), 1));
    add_fan(part, ring);
    return true;
  }
  // Adds a filled quadrilateral, or a prism if it has a thickness.
  static bool add_solid(const Entity& entity, Part& part) {
    const double thickness = entity.number(39);
    const glm::dmat4 system = world_from_object(entity);
    if (thickness == 0) return add_corners(entity, {10, 11, 13, 12}, system, part);
    std::array<glm::dvec3, 8> p;  // the lower four, and those above them
    constexpr std::array kCodes{10, 11, 13, 12};
    for (std::size_t k = 0; k < 4; ++k) {
      const glm::dvec3 corner = point_of(entity, entity.has(kCodes[k]) ? kCodes[k] : 12);
      p[k] = glm::dvec3(system * glm::dvec4(corner, 1));
      p[k + 4] = glm::dvec3(system * glm::dvec4(corner + glm::dvec3(0, 0, thickness), 1));
    }
    const glm::dvec3 up = glm::dvec3(system[2]) * thickness;
    if (glm::dot(glm::cross(p[1] - p[0], p[2] - p[0]) + glm::cross(p[2] - p[0], p[3] - p[0]), up) < 0)
      std::swap(p[1], p[3]), std::swap(p[5], p[7]);  // counter-clockwise, seen from the lid
    add_fan(part, {p[3], p[2], p[1], p[0]}), add_fan(part, {p[4], p[5], p[6], p[7]});
    for (std::size_t k = 0; k < 4; ++k) add_fan(part, {p[k], p[(k + 1) % 4], p[(k + 1) % 4 + 4], p[k + 4]});
    return true;
  }

  // Reads vertices first, then faces as vertex numbers; a negative number begins an edge that does not show.
  static bool add_faces(const std::vector<Entity>& vertices, Part& part) {
    constexpr int kPlace = 64;
    std::vector<glm::dvec3> places, ring;
    for (const Entity& vertex : vertices) {
      if ((vertex.integer(70) & kPlace) != 0) {
        places.push_back(point_of(vertex, 10));
        continue;
      }
      ring.clear();
      for (const int code : {71, 72, 73, 74}) {
        const auto corner = static_cast<std::size_t>(std::abs(static_cast<long>(vertex.integer(code))));
        if (corner > 0 && corner <= places.size()) ring.push_back(places[corner - 1]);
      }
      add_fan(part, ring);
    }
    return true;
  }

  // Adds a grid of vertices; the vertices of a smoothed surface replace those of its frame.
  static bool add_polygons(const Entity& entity, const std::vector<Entity>& vertices, Part& part) {
    constexpr int kClosedM = 1, kSmooth = 4, kClosedN = 32, kFrame = 16;
    const int flags = entity.integer(70);
    const bool smooth = (flags & kSmooth) != 0;
    const auto count = [&](int code) { return static_cast<std::size_t>(std::max(entity.integer(code), 0)); };
    const std::size_t m = count(smooth ? 73 : 71), n = count(smooth ? 74 : 72);
    std::vector<glm::dvec3> grid;
    for (const Entity& vertex : vertices)
      if (!smooth || (vertex.integer(70) & kFrame) == 0) grid.push_back(point_of(vertex, 10));
    if (m < 2 || n < 2 || grid.size() / n < m) return false;
    for (std::size_t i = 0; i + ((flags & kClosedM) != 0 ? 0 : 1) < m; ++i)
      for (std::size_t j = 0; j + ((flags & kClosedN) != 0 ? 0 : 1) < n; ++j) {
        const std::size_t up = (i + 1) % m * n, right = (j + 1) % n;
        add_fan(part, {grid[i * n + j], grid[i * n + right], grid[up + right], grid[up + j]});
      }
    return true;
  }

  // Reads the frame of a surface that may be smoother: places, then the corners of each face, counted by group 93.
  bool add_mesh(const Entity& entity, Part& part) {
    std::vector<glm::dvec3> places, ring;
    std::size_t left = 0, corners = 0;
    for (const Group& group : entity.groups) {
      if (group.code == 10) places.emplace_back(number(group), 0, 0);
      if (group.code == 20 && !places.empty()) places.back().y = number(group);
      if (group.code == 30 && !places.empty()) places.back().z = number(group);
      if (group.code == 93) left = static_cast<std::size_t>(std::max(integer(group), 0));
      if (group.code != 90 || left == 0) continue;
      --left;
      const auto value = static_cast<std::size_t>(std::max(integer(group), 0));
      if (corners == 0) {
        corners = value;
        ring.clear();
      } else {
        if (value < places.size()) ring.push_back(places[value]);
        if (--corners > 0) continue;
        std::vector<std::uint32_t> cut;  // faces may be concave
        cut_into_triangles(ring, std::array{ring.size()}, cut);
        for (std::size_t i = 0; i + 2 < cut.size(); i += 3)
          add_triangle(part, ring[cut[i]], ring[cut[i + 1]], ring[cut[i + 2]]);
      }
    }
    smoothed_ += entity.integer(91) > 0;
    return true;
  }

  bool add_insert(const Entity& entity, const std::string& layer, DxfContent& into) {
    const double angle = entity.number(50) * std::numbers::pi / 180, c = std::cos(angle), s = std::sin(angle);
    const glm::dmat4 axes = world_from_object(entity), turn{{c, s, 0, 0}, {-s, c, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}};
    glm::dmat4 size(1);
    for (int k = 0; k < 3; ++k) size[k][k] = entity.number(41 + k, 1);
    const glm::dmat4 turned = axes * turn;
    into.inserts.push_back({key(entity.text(2)), axes * moved_by(point_of(entity, 10)) * turn * size,
                            std::max(entity.integer(70, 1), 1), std::max(entity.integer(71, 1), 1),
                            glm::dvec3(turned[0]) * entity.number(44), glm::dvec3(turned[1]) * entity.number(45),
                            layer});
    return true;
  }

  LayerState state(const std::string& layer) const {
    const auto found = layers_.find(layer);
    return found == layers_.end() ? LayerState::shown : found->second;
  }

  // Adds a content to a node. `outer` is the layer of its insert, which content on layer 0 takes.
  void place(DxfContent& content, std::size_t node, const std::string& outer, int depth) {
    const auto on = [&](const std::string& own) { return own == "0" && !outer.empty() ? outer : own; };
    for (const auto& [kind, times] : content.hidden) hidden_[kind] += times;
    for (const auto& [kind, times] : content.left_out) model_.left_out[kind] += times;
    for (const auto& [own, types] : content.drawn) {
      if (state(on(own)) != LayerState::shown) {
        for (const auto& [type, times] : types) hidden_[type + " on " + names_[on(own)]] += times;
        continue;
      }
      Part& part = content.faces[own];
      if (!content.meshes.contains(own)) {
        content.meshes[own] = model_.add_mesh({names_[own], {}});
        model_.meshes.back().parts.push_back(std::move(part));
      }
      const std::size_t child = model_.add_node(node, names_[on(own)]);
      model_.nodes[child].meshes.push_back(content.meshes[own]);
    }
    for (const PlacedBlock& insert : content.inserts) place(insert, node, on(insert.layer), depth);
  }
  void place(const PlacedBlock& insert, std::size_t outer, const std::string& layer, int depth) {
    constexpr int kDeepest = 16;
    constexpr std::size_t kMost = 200'000;
    if (state(layer) == LayerState::frozen || state(insert.layer) == LayerState::frozen) {
      ++hidden_["INSERT on " + names_[layer]];
      return;
    }
    const auto found = blocks_.find(insert.block);
    if (found == blocks_.end() || found->second.external) {
      ++model_.left_out["INSERT of " + names_[insert.block] + ", which the file does not hold"];
      return;
    }
    DxfContent& block = found->second;
    if (depth >= kDeepest)
      throw Refused("its blocks are nested deeper than " + std::to_string(kDeepest) + ", or one holds itself (" +
                    block.name + "); explode them");
    for (int row = 0; row < insert.rows; ++row)
      for (int column = 0; column < insert.columns; ++column) {
        if (++placed_ > kMost)
          throw Refused("it places more than " + std::to_string(kMost) + " blocks; export parts of the model");
        const glm::dmat4 matrix =
            moved_by(insert.column_step * static_cast<double>(column) + insert.row_step * static_cast<double>(row)) *
            insert.outer_from_block * moved_by(-block.base);
        place(block, model_.add_node(outer, block.name, matrix), layer, depth + 1);
      }
  }

  Model model_;
  DxfContent whole_;
  DxfContent* block_ = nullptr;  // the one at hand
  std::map<std::string, DxfContent> blocks_;
  std::map<std::string, LayerState> layers_;
  std::map<std::string, std::string> names_;
  std::string code_page_;
  double metres_ = 0;  // in a unit; 0: unknown
  Counts hidden_;
  std::size_t placed_ = 0, smoothed_ = 0;
};

}  // namespace

Model read_dxf(const std::filesystem::path& file) { return DxfModel().read(file); }

}  // namespace vantage::importer
