// SPDX-License-Identifier: Apache-2.0
// COLLADA (COLLADA 1.4.1, Khronos 2008; 1.5): the nodes of its scene, and their materials.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "import/mesh/collada_mesh.hpp"
#include "import/mesh/sources.hpp"
#include "import/mesh/text.hpp"

namespace vantage::importer {
namespace {

// Returns the first element of that name below another, at any depth; null if there is none.
const XmlElement* descendant(const XmlElement& element, std::string_view name) {
  for (const XmlElement& child : element.children) {
    if (child.name == name) return &child;
    if (const XmlElement* found = descendant(child, name)) return found;
  }
  return nullptr;
}

class ColladaReader {
 public:
  explicit ColladaReader(const XmlElement& document) : document_(document) { note_ids(document); }

  Model read() {
    model_.nodes[0].outer_from_node = declared_axes();
    const XmlElement* scene = nullptr;
    if (const XmlElement* element = document_.child("scene"))
      if (const XmlElement* instance = element->child("instance_visual_scene"))
        scene = find_by_reference(ids_, attribute_of_element(*instance, "url"));
    if (!scene) scene = descendant(document_, "visual_scene");
    if (!scene) throw Refused("it has no scene, so that nothing places its meshes; export it again");
    for (const XmlElement& node : scene->children)
      if (node.name == "node") read_node(node, 0, 0);
    if (skinned_ > 0)
      model_.notes.push_back(std::to_string(skinned_) + " meshes stand as modelled: skins and morphs are not applied");
    model_.lines_or_points = lines_;
    return std::move(model_);
  }

 private:
  void note_ids(const XmlElement& element) {
    if (const std::string id = attribute_of_element(element, "id"); !id.empty()) ids_.try_emplace(id, &element);
    for (const XmlElement& child : element.children) note_ids(child);
  }

  glm::dmat4 declared_axes() {
    glm::dmat4 axes(1);
    const XmlElement* asset = document_.child("asset");
    if (!asset) return axes;
    const std::string up = asset->text_at("up_axis");
    model_.up = !up.empty();
    if (up == "Z_UP") axes = from_z_up();
    if (up == "X_UP") axes = from_x_up();
    if (const XmlElement* unit = asset->child("unit")) {
      const std::string text = attribute_of_element(*unit, "meter");
      const double metres = text.empty() ? 1 : value_of<double>(trimmed_text(text)).value_or(0);
      if (!(metres > 0) || !std::isfinite(metres)) throw Refused("its unit is " + text + " metres; export it again");
      model_.unit = true;
      for (int c = 0; c < 3; ++c) axes[c] = axes[c] * metres;
    }
    return axes;
  }

  static std::vector<double> numbers(const XmlElement& element, std::size_t count) {
    std::vector<double> values = values_of<double>(element.text, "the " + element.name + " of a node");
    if (values.size() != count)
      throw Refused("the " + element.name + " of a node is not " + std::to_string(count) + " numbers; export it again");
    return values;
  }

  // Returns the matrix of one of a node's transformations; identity for other elements.
  static glm::dmat4 step_of(const XmlElement& element) {
    glm::dmat4 m(1);
    if (element.name == "matrix") {
      const std::vector<double> v = numbers(element, 16);
      for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 4; ++column) m[column][row] = v[static_cast<std::size_t>(4 * row + column)];
    } else if (element.name == "translate") {
      const std::vector<double> v = numbers(element, 3);
      m[3] = {v[0], v[1], v[2], 1};
    } else if (element.name == "scale") {
      const std::vector<double> v = numbers(element, 3);
      for (int c = 0; c < 3; ++c) m[c][c] = v[static_cast<std::size_t>(c)];
    } else if (element.name == "rotate") {
      const std::vector<double> v = numbers(element, 4);
      const glm::dvec3 axis(v[0], v[1], v[2]);
      if (length(axis) > 0) m = glm::mat4_cast(glm::angleAxis(v[3] * std::numbers::pi / 180, normalize(axis)));
    } else if (element.name == "lookat") {
      const std::vector<double> v = numbers(element, 9);
      const glm::dvec3 eye(v[0], v[1], v[2]), to(v[3], v[4], v[5]), up(v[6], v[7], v[8]);
      const glm::dvec3 z = normalize(eye - to), x = normalize(cross(up, z));
      m = {glm::dvec4(x, 0), glm::dvec4(cross(z, x), 0), glm::dvec4(z, 0), glm::dvec4(eye, 1)};
    } else if (element.name == "skew") {
      // Shears along the second axis, by tan(angle) times the height towards the first axis.
      const std::vector<double> v = numbers(element, 7);
      const glm::dvec3 turned(v[1], v[2], v[3]), along(v[4], v[5], v[6]);
      if (length(turned) > 0 && length(along) > 0) {
        const glm::dvec3 a = normalize(along), b = normalize(turned - a * dot(turned, a));
        const double share = std::tan(v[0] * std::numbers::pi / 180);
        for (int c = 0; c < 3; ++c) m[c] = m[c] + glm::dvec4(a * (share * b[c]), 0);
      }
    }
    return m;
  }

  void read_node(const XmlElement& element, std::size_t parent, int depth) {
    constexpr int kMostLevels = 200;
    constexpr std::size_t kMostNodes = 1'000'000;
    if (depth > kMostLevels || model_.nodes.size() > kMostNodes)
      throw Refused("its nodes instance one another without an end, or too often; export it again");
    glm::dmat4 outer_from_node(1);
    for (const XmlElement& child : element.children) outer_from_node = outer_from_node * step_of(child);
    std::string name = attribute_of_element(element, "name");
    if (name.empty()) name = attribute_of_element(element, "id");
    const std::size_t node = model_.add_node(parent, name, outer_from_node);
    for (const XmlElement& child : element.children) {
      const std::string url = attribute_of_element(child, "url");
      if (child.name == "node") {
        read_node(child, node, depth + 1);
      } else if (child.name == "instance_node") {
        if (const XmlElement* other = find_by_reference(ids_, url))
          read_node(*other, node, depth + 1);
        else
          ++model_.left_out["nodes of other files"];
      } else if (child.name == "instance_geometry") {
        place(child, url, node);
      } else if (child.name == "instance_controller") {
        ++skinned_;
        place(child, base_of(url), node);
      }
    }
  }

  // Returns the geometry at the end of a chain of skins and morphs.
  std::string base_of(std::string url) const {
    for (int steps = 0; steps < 8; ++steps) {
      const XmlElement* controller = find_by_reference(ids_, url);
      if (!controller || controller->name != "controller") break;
      for (const XmlElement& kind : controller->children)
        if (kind.name == "skin" || kind.name == "morph") url = attribute_of_element(kind, "source");
    }
    return url;
  }

  void place(const XmlElement& instance, const std::string& url, std::size_t node) {
    const XmlElement* geometry = find_by_reference(ids_, url);
    if (!geometry) {
      ++model_.left_out["meshes of other files"];
      return;
    }
    const XmlElement* mesh = geometry->child("mesh");
    if (!mesh) {
      for (const char* other : {"convex_mesh", "spline", "brep"})
        if (geometry->child(other)) ++model_.left_out[other];
      return;
    }
    std::map<std::string, int> materials;
    if (const XmlElement* bound = descendant(instance, "technique_common"))
      for (const XmlElement& material : bound->children)
        if (material.name == "instance_material")
          materials[attribute_of_element(material, "symbol")] = material_of(attribute_of_element(material, "target"));
    const auto [known, is_new] = meshes_.try_emplace({mesh, materials}, model_.meshes.size());
    if (is_new) {
      Mesh made;
      made.name = attribute_of_element(*geometry, "name");
      if (made.name.empty()) made.name = attribute_of_element(*geometry, "id");
      for (ColladaPart& part : collada_parts(*mesh, ids_, lines_)) {
        const auto material = materials.find(part.symbol);
        if (material != materials.end()) part.part.material = material->second;
        made.parts.push_back(std::move(part.part));
      }
      model_.add_mesh(std::move(made));
    }
    model_.nodes[node].meshes.push_back(known->second);
  }

  // Returns the numbers of a colour or a share, which a parameter may hold.
  std::vector<double> effect_numbers(const XmlElement& effect, const XmlElement& place, const char* kind) const {
    const XmlElement* value = place.child(kind);
    if (!value) {
      const XmlElement* parameter = place.child("param");
      if (!parameter) return {};
      const std::string name = attribute_of_element(*parameter, "ref");
      for (const XmlElement* owner : {&effect, effect.child("profile_COMMON")}) {
        if (!owner) continue;
        for (const XmlElement& given : owner->children)
          if (given.name == "newparam" && attribute_of_element(given, "sid") == name && !given.children.empty())
            value = &given.children.front();
      }
      if (!value) return {};
    }
    return values_of<double>(value->text, "the " + place.name + " of a material");
  }

  int material_of(const std::string& reference) {
    const XmlElement* given = find_by_reference(ids_, reference);
    if (!given) return -1;
    const auto [known, is_new] = materials_.try_emplace(given, -1);
    if (!is_new) return known->second;
    const XmlElement* instance = given->child("instance_effect");
    const XmlElement* effect = instance ? find_by_reference(ids_, attribute_of_element(*instance, "url")) : nullptr;
    if (!effect) return -1;
    Material material;
    material.name = attribute_of_element(*given, "name");
    if (material.name.empty()) material.name = attribute_of_element(*given, "id");
    bool coloured = false;
    const XmlElement* technique = nullptr;
    for (const char* model : {"phong", "lambert", "blinn", "constant"})
      if (!technique) technique = descendant(*effect, model);
    if (technique) {
      const XmlElement* diffuse = technique->child(technique->name == "constant" ? "emission" : "diffuse");
      if (diffuse) {
        material.textured = diffuse->child("texture") != nullptr;
        const std::vector<double> rgba = effect_numbers(*effect, *diffuse, "color");
        if (rgba.size() >= 3) material.rgba = {rgba[0], rgba[1], rgba[2], 1};
        coloured = rgba.size() >= 3 || material.textured;
      }
      material.rgba[3] = opacity_of(*effect, *technique);
    }
    if (!coloured) return -1;
    model_.materials.push_back(std::move(material));
    return known->second = static_cast<int>(model_.materials.size()) - 1;
  }

  // Returns the opacity by the mode that `transparent` names (COLLADA 1.4.1, chapter 7).
  double opacity_of(const XmlElement& effect, const XmlElement& technique) const {
    const XmlElement *transparent = technique.child("transparent"), *transparency = technique.child("transparency");
    if (transparent && transparent->child("texture")) return 1;
    std::vector<double> share = transparency ? effect_numbers(effect, *transparency, "float") : std::vector<double>();
    if (share.empty()) share = {1};
    std::vector<double> rgba = transparent ? effect_numbers(effect, *transparent, "color") : std::vector<double>();
    if (rgba.size() < 3) rgba = {1, 1, 1, 1};
    rgba.resize(4, 1);
    const std::string mode = transparent ? attribute_of_element(*transparent, "opaque") : "";
    const double light = 0.212671 * rgba[0] + 0.715160 * rgba[1] + 0.072169 * rgba[2];
    if (mode == "RGB_ZERO") return transparent ? 1 - share[0] * light : 1;
    if (mode == "RGB_ONE") return share[0] * light;
    if (mode == "A_ZERO") return 1 - share[0] * rgba[3];
    return share[0] * rgba[3];
  }

  const XmlElement& document_;
  XmlIds ids_;
  std::map<std::pair<const XmlElement*, std::map<std::string, int>>, std::size_t> meshes_;
  std::map<const XmlElement*, int> materials_;
  std::size_t skinned_ = 0, lines_ = 0;
  Model model_;
};

}  // namespace

Model read_collada(const std::filesystem::path& file) {
  const XmlElement document = parse_xml(read_whole(file));
  return ColladaReader(document).read();
}

}  // namespace vantage::importer
