// SPDX-License-Identifier: Apache-2.0
// OBJ (Wavefront, Advanced Visualizer Manual, 1992, appendix B) and its material tables.
#include <algorithm>
#include <cmath>
#include <deque>

#include "import/mesh/polygon.hpp"
#include "import/mesh/sources.hpp"
#include "import/mesh/text.hpp"

namespace vantage::importer {
namespace {

constexpr std::uint32_t kNoNormal = 0xFFFFFFFF;

// Polygons of one mesh and material, by the file's numbers of positions and normals.
struct ObjFaces {
  std::vector<std::uint32_t> positions, normals, sizes;
  bool any_normal = false;
};

class ObjReader {
 public:
  explicit ObjReader(const std::filesystem::path& file) : folder_(file.parent_path()), text_(read_whole(file)) {}

  Model read() {
    std::string_view rest = text_;
    if (rest.starts_with("\xEF\xBB\xBF")) rest.remove_prefix(3);
    std::string joined;
    while (!rest.empty()) {
      std::string_view line = take_line(rest);
      ++line_;
      if (line.ends_with('\\')) {
        joined = line.substr(0, line.size() - 1);
        for (bool more = true; more && !rest.empty();) {
          line = take_line(rest);
          ++line_;
          more = line.ends_with('\\');
          joined += ' ';
          joined += more ? line.substr(0, line.size() - 1) : line;
        }
        line = joined;
      }
      read_line(line);
    }
    return finish();
  }

 private:
  [[noreturn]] void refuse(const std::string& what) const {
    throw Refused("line " + std::to_string(line_) + " " + what + "; export it again");
  }

  void read_line(std::string_view line) {
    const std::string_view word = take_word(line);
    if (word.empty() || word.front() == '#') return;
    if (word == "v") {
      read_vertex(line);
    } else if (word == "vn") {
      glm::vec3 n(0);
      for (int c = 0; c < 3; ++c) n[c] = static_cast<float>(value_of<double>(take_word(line)).value_or(0));
      normals_.push_back(n);
    } else if (word == "f" || word == "fo") {
      read_face(line);
    } else if (word == "o") {
      object_ = trimmed_text(line), group_.clear(), faces_ = nullptr;
    } else if (word == "g") {
      group_ = trimmed_text(line), faces_ = nullptr;
    } else if (word == "usemtl") {
      material_ = trimmed_text(line), faces_ = nullptr;
    } else if (word == "mtllib") {
      read_table(line);
    } else if (word == "l" || word == "p") {
      ++model_.lines_or_points;
    } else if (word == "surf" || word == "curv" || word == "curv2") {
      ++model_.left_out["free-form " + std::string(word == "surf" ? "surfaces" : "curves")];
    }
  }

  // x y z, a weight or a colour, or both.
  void read_vertex(std::string_view line) {
    std::array<double, 7> values{};
    std::size_t count = 0;
    for (std::string_view word = take_word(line); !word.empty() && word.front() != '#' && count < values.size();
         word = take_word(line)) {
      const auto value = value_of<double>(word);
      if (!value) refuse("has \"" + std::string(word.substr(0, 40)) + "\" where a number belongs");
      values[count++] = *value;
    }
    if (count < 3) refuse("has a vertex of less than three numbers");
    glm::dvec3 p(values[0], values[1], values[2]);
    if ((count == 4 || count == 7) && values[3] != 0 && values[3] != 1) p = p / values[3];
    positions_.push_back(p);
    if (count < 6) return;
    colours_.resize(positions_.size(), Rgba{255, 255, 255, 255});
    Rgba& rgba = colours_.back();
    for (std::size_t c = 0; c < 3; ++c) {
      const double share = values[count - 3 + c];
      rgba[c] = std::isfinite(share) ? static_cast<std::uint8_t>(std::lround(255 * std::clamp(share, 0.0, 1.0))) : 0;
    }
  }

  // Negative numbers count back from the last one so far; others may name what comes later.
  std::uint32_t index_of(std::string_view number, std::size_t known) const {
    const auto value = value_of<std::int64_t>(number);
    const std::int64_t index = !value ? -1 : *value > 0 ? *value - 1 : static_cast<std::int64_t>(known) + *value;
    if (!value || *value == 0 || index < 0 || index >= kNoNormal)
      refuse("names \"" + std::string(number.substr(0, 40)) + "\", of which there is none");
    return static_cast<std::uint32_t>(index);
  }

  void read_face(std::string_view line) {
    ObjFaces& faces = current();
    std::uint32_t size = 0;
    for (std::string_view word = take_word(line); !word.empty() && word.front() != '#'; word = take_word(line)) {
      const std::size_t slash = word.find('/'), second = word.find('/', std::min(slash, word.size() - 1) + 1);
      faces.positions.push_back(index_of(word.substr(0, slash), positions_.size()));
      const bool normal = slash != word.npos && second != word.npos && second + 1 < word.size();
      faces.normals.push_back(normal ? index_of(word.substr(second + 1), normals_.size()) : kNoNormal);
      faces.any_normal = faces.any_normal || normal;
      ++size;
    }
    if (size < 3) {
      faces.positions.resize(faces.positions.size() - size), faces.normals.resize(faces.normals.size() - size);
      ++model_.lines_or_points;
    } else {
      faces.sizes.push_back(size);
    }
  }

  // Returns the faces of the open object, group and material; a name that comes again continues its faces.
  ObjFaces& current() {
    if (faces_) return *faces_;
    const std::string group = group_ == "default" || group_ == "off" || group_ == "(null)" ? "" : group_;
    const auto [known, is_new] = mesh_numbers_.try_emplace({object_, group}, meshes_.size());
    if (is_new) meshes_.push_back({group.empty() ? object_ : group, {}});
    return *(faces_ = &meshes_[known->second].second[material_]);
  }

  // A line names one table, or several if the whole line is no file.
  void read_table(std::string_view line) {
    const std::string_view whole = trimmed_text(line);
    if (read_table_file(whole)) return;
    std::size_t missing = 0;
    std::string_view names = whole;
    for (std::string_view name = take_word(names); !name.empty(); name = take_word(names))
      missing += read_table_file(name) ? 0 : 1;
    if (missing > 0)
      model_.notes.push_back("its material table " + std::string(whole) +
                             " is not beside it, so that its surfaces have no colours");
  }

  bool read_table_file(std::string_view name) {
    std::string slashes(name);
    std::ranges::replace(slashes, '\\', '/');
    const std::filesystem::path file = folder_ / slashes;
    std::error_code failure;
    if (!std::filesystem::is_regular_file(file, failure)) return false;
    const std::string table = read_whole(file);
    std::string_view rest = table;
    Material* material = nullptr;
    while (!rest.empty()) {
      std::string_view line = take_line(rest);
      const std::string_view word = take_word(line);
      const auto number = [&] { return value_of<double>(take_word(line)); };
      if (word == "newmtl") {
        const std::string known(trimmed_text(line));
        material_numbers_.try_emplace(known, model_.materials.size());
        model_.materials.push_back({known, {0.6, 0.6, 0.6, 1}, false});
        material = &model_.materials.back();
      } else if (!material) {
        continue;
      } else if (word == "Kd") {
        if (const auto r = number()) {
          const double g = number().value_or(*r), b = number().value_or(*r);
          material->rgba = {*r, g, b, material->rgba[3]};
        }
      } else if (word == "d") {
        if (const auto opacity = number()) material->rgba[3] = *opacity;
      } else if (word == "Tr") {
        if (const auto transparency = number()) material->rgba[3] = 1 - *transparency;
      } else if (word == "map_Kd") {
        material->textured = true;
      }
    }
    return true;
  }

  Part part_of(const ObjFaces& faces) const {
    Part part;
    std::vector<std::uint32_t> cut;
    std::vector<glm::dvec3> points;
    for (std::size_t k = 0; k < faces.positions.size(); ++k) {
      const std::uint32_t v = faces.positions[k], n = faces.normals[k];
      if (v >= positions_.size())
        throw Refused("a face names vertex " + std::to_string(v + 1) + "; there are " +
                      std::to_string(positions_.size()));
      part.positions.push_back(positions_[v]);
      if (faces.any_normal) part.normals.push_back(n < normals_.size() ? normals_[n] : glm::vec3(0));
      if (!colours_.empty()) part.colours.push_back(v < colours_.size() ? colours_[v] : Rgba{255, 255, 255, 255});
    }
    std::size_t first = 0;
    for (const std::size_t size : faces.sizes) {
      cut.clear();
      cut_into_triangles(std::span(part.positions).subspan(first, size), {&size, 1}, cut);
      for (const std::uint32_t c : cut) part.indices.push_back(static_cast<std::uint32_t>(first + c));
      first += size;
    }
    return part;
  }

  Model finish() {
    for (auto& [name, by_material] : meshes_) {
      Mesh mesh{name, {}};
      for (auto& [material, faces] : by_material) {
        Part part = part_of(faces);
        faces = {};
        if (const auto known = material_numbers_.find(material); known != material_numbers_.end())
          part.material = static_cast<int>(known->second);
        mesh.parts.push_back(std::move(part));
      }
      const std::size_t node = model_.add_node(0, name);
      model_.nodes[node].meshes.push_back(model_.add_mesh(std::move(mesh)));
    }
    return std::move(model_);
  }

  const std::filesystem::path folder_;
  const std::string text_;
  std::size_t line_ = 0;
  std::vector<glm::dvec3> positions_;
  std::vector<glm::vec3> normals_;
  std::vector<Rgba> colours_;
  std::string object_, group_, material_;
  ObjFaces* faces_ = nullptr;  // in meshes_, whose maps keep their places
  std::map<std::pair<std::string, std::string>, std::size_t> mesh_numbers_;
  std::deque<std::pair<std::string, std::map<std::string, ObjFaces>>> meshes_;
  std::map<std::string, std::size_t> material_numbers_;
  Model model_;
};

}  // namespace

Model read_obj(const std::filesystem::path& file) { return ObjReader(file).read(); }

}  // namespace vantage::importer
