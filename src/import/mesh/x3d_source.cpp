// SPDX-License-Identifier: Apache-2.0
// X3D in its XML encoding (ISO/IEC 19776-1).
#include <algorithm>
#include <cmath>

#include "import/mesh/sources.hpp"
#include "import/mesh/text.hpp"
#include "import/mesh/x3d_shapes.hpp"

namespace vantage::importer {
namespace {

using Names = std::initializer_list<std::string_view>;

bool is_one_of(std::string_view name, Names names) { return std::ranges::find(names, name) != names.end(); }

class X3dReader {
 public:
  explicit X3dReader(const XmlElement& document) : document_(document) {}

  Model read() {
    model_.unit = model_.up = true;  // metres and Y up, by its standard
    const XmlElement* head = document_.child("head");
    for (const XmlElement* place : {&document_, head})
      if (place)
        for (const XmlElement& element : place->children) read_unit(element);
    glm::dmat4 scale(units_.metres);
    scale[3][3] = 1;
    model_.nodes[0].outer_from_node = scale;
    const XmlElement* scene = document_.child("Scene");
    if (!scene) throw Refused("it has no Scene; export it again");
    note_names(*scene);
    for (const XmlElement& child : scene->children) read_node(child, 0, 0);
    if (hidden_ > 0)
      model_.notes.push_back(std::to_string(hidden_) +
                             " nodes are hidden by the file, or coarser levels of detail, and are left out");
    return std::move(model_);
  }

 private:
  static std::string attribute(const XmlElement& element, const char* name) {
    const auto found = element.attributes.find(name);
    return found == element.attributes.end() ? std::string() : found->second;
  }

  void read_unit(const XmlElement& element) {
    if (element.name != "unit") return;
    const double factor = x3d_number(element, "conversionFactor", 1);
    if (!(factor > 0))
      throw Refused("its unit " + attribute(element, "name") + " has no factor above 0; export it again");
    if (attribute(element, "category") == "length") units_.metres = factor;
    if (attribute(element, "category") == "angle") units_.radians = factor;
  }

  // The content of a prototype is not in the scene.
  void note_names(const XmlElement& element) {
    if (element.name == "ProtoDeclare") return;
    if (const std::string name = attribute(element, "DEF"); !name.empty()) names_.try_emplace(name, &element);
    for (const XmlElement& child : element.children) note_names(child);
  }

  const XmlElement& resolved(const XmlElement& element) const {
    const std::string name = attribute(element, "USE");
    if (name.empty()) return element;
    const auto known = names_.find(name);
    if (known == names_.end()) throw Refused("a node " + element.name + " uses " + name + ", which is not in the file");
    return *known->second;
  }

  glm::dvec3 vector_of(const XmlElement& element, const char* name, double missing) const {
    const std::vector<double> v = x3d_numbers(element, name, {missing, missing, missing});
    if (v.size() != 3) throw Refused("the " + std::string(name) + " of a node Transform is not three numbers");
    return {v[0], v[1], v[2]};
  }
  glm::dmat4 rotation_of(const XmlElement& element, const char* name) const {
    const std::vector<double> v = x3d_numbers(element, name, {0, 0, 1, 0});
    if (v.size() != 4) throw Refused("the " + std::string(name) + " of a node Transform is not four numbers");
    const glm::dvec3 axis(v[0], v[1], v[2]);
    return length(axis) > 0 ? glm::mat4_cast(glm::angleAxis(v[3] * units_.radians, normalize(axis))) : glm::dmat4(1);
  }
  glm::dmat4 transform_of(const XmlElement& element) const {
    const glm::dvec3 centre = vector_of(element, "center", 0), s = vector_of(element, "scale", 1);
    const glm::dmat4 turn = rotation_of(element, "scaleOrientation");
    glm::dmat4 scale(1);
    for (int c = 0; c < 3; ++c) scale[c][c] = s[c];
    return moved_by(vector_of(element, "translation", 0) + centre) * rotation_of(element, "rotation") * turn * scale *
           transpose(turn) * moved_by(-centre);
  }

  void read_node(const XmlElement& given, std::size_t parent, int depth) {
    constexpr int kMostLevels = 200;
    constexpr std::size_t kMostNodes = 1'000'000;
    const XmlElement& element = resolved(given);
    const std::string& kind = element.name;
    if (depth > kMostLevels || model_.nodes.size() > kMostNodes)
      throw Refused("its nodes use one another without an end, or too often; export it again");
    if (!x3d_truth(element, "visible", true) && is_one_of(kind, {"Group", "Transform", "StaticGroup", "Shape", "Switch",
                                                                 "LOD", "Anchor", "Billboard", "Collision"})) {
      ++hidden_;
      return;
    }
    if (kind == "Shape") return read_shape(element, parent);
    if (is_one_of(kind, {"Inline", "ProtoInstance", "GeoTransform", "GeoLocation", "GeoLOD", "ParticleSystem"})) {
      ++model_.left_out[kind];
      return;
    }
    if (is_one_of(kind, {"ProtoDeclare", "ExternProtoDeclare", "Script", "Appearance", "Material"})) return;
    if (element.children.empty()) return;
    std::size_t node = parent;
    const std::string name = attribute(element, "DEF");
    if (is_one_of(kind, {"Transform", "HAnimHumanoid", "HAnimJoint", "HAnimSite", "EspduTransform"}))
      node = model_.add_node(parent, name, transform_of(element));
    else if (!name.empty())
      node = model_.add_node(parent, name);
    const auto choice = kind == "Switch" ? static_cast<std::ptrdiff_t>(x3d_number(element, "whichChoice", -1))
                        : kind == "LOD"  ? 0
                                         : -1;
    const bool chooses = kind == "Switch" || kind == "LOD";
    std::ptrdiff_t number = 0;
    for (const XmlElement& child : element.children) {
      if (attribute(child, "containerField") == "proxy" || child.name.starts_with("Metadata")) continue;
      if (chooses && number++ != choice)
        ++hidden_;
      else
        read_node(child, node, depth + 1);
    }
  }

  void read_shape(const XmlElement& shape, std::size_t parent) {
    const XmlElement *geometry = nullptr, *appearance = nullptr;
    for (const XmlElement& child : shape.children) {
      if (child.name == "Appearance")
        appearance = &resolved(child);
      else if (!child.name.starts_with("Metadata"))
        geometry = &resolved(child);
    }
    if (!geometry) return;
    switch (x3d_kind(geometry->name)) {
      case X3dGeometry::unknown: ++model_.left_out[geometry->name]; return;
      case X3dGeometry::lines_or_points: ++model_.lines_or_points; return;
      case X3dGeometry::surface: break;
    }
    const auto [known, is_new] = meshes_.try_emplace({geometry, appearance}, model_.meshes.size());
    if (is_new) {
      Part part = x3d_surface(
          *geometry, [this](const XmlElement& e) -> const XmlElement& { return resolved(e); }, units_);
      if (appearance) part.material = material_of(*appearance);
      model_.add_mesh({});
      model_.meshes.back().parts.push_back(std::move(part));
    }
    const std::size_t node = model_.add_node(parent, attribute(shape, "DEF"));
    model_.nodes[node].meshes.push_back(known->second);
  }

  int material_of(const XmlElement& appearance) {
    const auto [known, is_new] = materials_.try_emplace(&appearance, -1);
    if (!is_new) return known->second;
    Material material;
    const XmlElement* given = nullptr;
    for (const XmlElement& child : appearance.children) {
      if (is_one_of(child.name, {"Material", "PhysicalMaterial", "UnlitMaterial"})) given = &resolved(child);
      if (child.name.ends_with("Texture")) {  // which some programs write empty
        const XmlElement& texture = resolved(child);
        material.textured = material.textured || !texture.children.empty() || !attribute(texture, "url").empty() ||
                            !attribute(texture, "image").empty();
      }
    }
    if (!given) return -1;
    const char* colour = given->name == "Material"           ? "diffuseColor"
                         : given->name == "PhysicalMaterial" ? "baseColor"
                                                             : "emissiveColor";
    const double missing = given->name == "Material" ? 0.8 : 1;
    const std::vector<double> rgb = x3d_numbers(*given, colour, {missing, missing, missing});
    if (rgb.size() == 3) material.rgba = {rgb[0], rgb[1], rgb[2], 1 - x3d_number(*given, "transparency", 0)};
    material.name = attribute(*given, "DEF");
    if (material.name.empty()) material.name = attribute(appearance, "DEF");
    model_.materials.push_back(std::move(material));
    return known->second = static_cast<int>(model_.materials.size()) - 1;
  }

  const XmlElement& document_;
  X3dUnits units_;
  std::map<std::string, const XmlElement*> names_;
  std::map<std::pair<const XmlElement*, const XmlElement*>, std::size_t> meshes_;
  std::map<const XmlElement*, int> materials_;
  std::size_t hidden_ = 0;
  Model model_;
};

}  // namespace

Model read_x3d(const std::filesystem::path& file) {
  const XmlElement document = parse_xml(read_whole(file));
  return X3dReader(document).read();
}

}  // namespace vantage::importer
