// SPDX-License-Identifier: Apache-2.0
#include "import/mesh/convert.hpp"

#include <assimp/DefaultIOSystem.h>
#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <cmath>
#include <map>
#include <new>
#include <vector>

#include "core/utf8.hpp"
#include "import/glb_bytes.hpp"
#include "import/mesh/declared_units.hpp"
#include "import/program.hpp"

namespace vantage::importer {
namespace {

using nlohmann::json;

// Shows the file under a name with the extension of its format, by which assimp chooses the reader.
class RenamedFile : public Assimp::DefaultIOSystem {
 public:
  RenamedFile(const std::filesystem::path& file, const std::string& format)
      : file_(file.string()), shown_((file.parent_path() / ("model." + format)).string()) {}

  bool Exists(const char* name) const override { return DefaultIOSystem::Exists(real(name)); }
  Assimp::IOStream* Open(const char* name, const char* mode) override {
    return DefaultIOSystem::Open(real(name), mode);
  }
  const std::string& shown() const { return shown_; }

 private:
  const char* real(const char* name) const { return shown_ == name ? file_.c_str() : name; }
  const std::string file_, shown_;
};

bool has_triangles(const aiMesh& mesh) { return (mesh.mPrimitiveTypes & aiPrimitiveType_TRIANGLE) != 0; }

class Converter {
 public:
  Converter(const aiScene& scene, const std::filesystem::path& file, const std::string& format)
      : scene_(scene), format_(format), stem_(to_utf8(file.stem().string())), primitives_(scene.mNumMeshes) {
    declared_ = declared_units(scene, file, format);
  }

  std::string run() {
    for (unsigned m = 0; m < scene_.mNumMeshes; ++m) {
      lines_or_points_ += has_triangles(*scene_.mMeshes[m]) ? 0 : scene_.mMeshes[m]->mNumFaces;
      if (has_triangles(*scene_.mMeshes[m])) primitives_[m] = primitive_of(*scene_.mMeshes[m]);
    }
    if (!triangles_)
      throw Refused(lines_or_points_ > 0 ? "it holds points or lines alone, " + std::to_string(lines_or_points_) +
                                               " of them; a survey is planned on surfaces: export the model with faces"
                                         : "it holds no triangle; export the model with faces");
    const int root = add_node(*scene_.mRootNode, declared_.gltf_from_file);
    json vantage = json::object();
    if (declared_.unit) vantage["unit"] = "m";
    if (declared_.up) vantage["up"] = "y";
    json asset{{"version", "2.0"}, {"generator", "vantage-import-mesh"}};
    json extras = json::object();
    if (!vantage.empty()) extras["vantage"] = vantage;
    if (lines_or_points_ > 0)
      extras["notes"] = {std::to_string(lines_or_points_) + " points and lines of the model are left out"};
    if (!extras.empty()) asset["extras"] = extras;
    json document{
        {"asset", asset}, {"scene", 0}, {"scenes", {{{"nodes", {root}}}}}, {"nodes", nodes_}, {"meshes", meshes_}};
    if (!materials_.empty()) document["materials"] = materials_;
    return buffer_.finish(document);
  }

 private:
  json primitive_of(const aiMesh& mesh) {
    std::vector<float> positions(3 * std::size_t{mesh.mNumVertices});
    for (std::size_t v = 0; v < mesh.mNumVertices; ++v)
      for (unsigned c = 0; c < 3; ++c) positions[3 * v + c] = finite(mesh.mVertices[v][c]);
    std::vector<std::uint32_t> indices;
    indices.reserve(3 * std::size_t{mesh.mNumFaces});
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
      const aiFace& face = mesh.mFaces[f];
      if (face.mNumIndices != 3) continue;
      if (std::any_of(face.mIndices, face.mIndices + 3, [&](unsigned v) { return v >= mesh.mNumVertices; }))
        throw Refused("a face of mesh " + std::string(mesh.mName.C_Str()) + " names a vertex that is not there");
      indices.insert(indices.end(), face.mIndices, face.mIndices + 3);
    }
    if (indices.empty()) return {};
    triangles_ = true;
    json primitive{{"attributes", {{"POSITION", buffer_.add_positions(positions)}}}};
    // Normals of STL and DXF are those of their faces and add nothing.
    if (mesh.HasNormals() && format_ != "stl" && format_ != "dxf") {
      for (std::size_t v = 0; v < mesh.mNumVertices; ++v)
        for (unsigned c = 0; c < 3; ++c) positions[3 * v + c] = finite(mesh.mNormals[v][c]);
      primitive["attributes"]["NORMAL"] = buffer_.add_normals(positions);
    }
    if (mesh.HasVertexColors(0)) primitive["attributes"]["COLOR_0"] = add_colours(mesh);
    primitive["indices"] = buffer_.add_indices(indices);
    if (const int material = material_of(mesh.mMaterialIndex); material >= 0) primitive["material"] = material;
    return primitive;
  }

  static float finite(ai_real value) { return std::isfinite(value) ? static_cast<float>(value) : 0.0F; }

  int add_colours(const aiMesh& mesh) {
    std::vector<std::uint8_t> rgba(4 * std::size_t{mesh.mNumVertices});
    for (std::size_t v = 0; v < mesh.mNumVertices; ++v)
      for (unsigned c = 0; c < 4; ++c)
        rgba[4 * v + c] =
            static_cast<std::uint8_t>(std::lround(255 * std::clamp(finite(mesh.mColors[0][v][c]), 0.0F, 1.0F)));
    return buffer_.add_colours(rgba);
  }

  // -1 if the file gives none; assimp then makes one up.
  int material_of(unsigned index) {
    const auto [known, is_new] = material_indices_.try_emplace(index, -1);
    if (!is_new || index >= scene_.mNumMaterials) return known->second;
    const aiMaterial& given = *scene_.mMaterials[index];
    aiString name;
    given.Get(AI_MATKEY_NAME, name);
    aiColor4D colour;
    const bool coloured = given.Get(AI_MATKEY_COLOR_DIFFUSE, colour) == aiReturn_SUCCESS;
    if (!coloured || name == aiString(AI_DEFAULT_MATERIAL_NAME)) return -1;
    float opacity = 1;
    given.Get(AI_MATKEY_OPACITY, opacity);
    if (!(opacity > 0)) opacity = 1;  // full transparency is a slip of the exporter
    json material{{"name", to_utf8(name.C_Str())}, {"doubleSided", true}};
    // The colour of a textured surface is in the texture, which is not carried over.
    if (given.GetTextureCount(aiTextureType_DIFFUSE) == 0) {
      const auto share = [](float value) { return std::clamp(finite(value), 0.0F, 1.0F); };
      material["pbrMetallicRoughness"] = {
          {"baseColorFactor", {share(colour.r), share(colour.g), share(colour.b), share(opacity)}},
          {"metallicFactor", 0.0}};
    }
    if (opacity < 1) material["alphaMode"] = "BLEND";
    materials_.push_back(material);
    return known->second = static_cast<int>(materials_.size()) - 1;
  }

  // Nodes that show the same meshes share them.
  int mesh_of(const aiNode& node) {
    std::vector<unsigned> parts;
    for (unsigned m = 0; m < node.mNumMeshes; ++m)
      if (node.mMeshes[m] < primitives_.size() && !primitives_[node.mMeshes[m]].is_null())
        parts.push_back(node.mMeshes[m]);
    if (parts.empty()) return -1;
    const auto [known, is_new] = mesh_indices_.try_emplace(parts, -1);
    if (!is_new) return known->second;
    json mesh{{"primitives", json::array()}};
    for (const unsigned part : parts) mesh["primitives"].push_back(primitives_[part]);
    if (const std::string name = to_utf8(scene_.mMeshes[parts.front()]->mName.C_Str()); !name.empty())
      mesh["name"] = name;
    meshes_.push_back(mesh);
    return known->second = static_cast<int>(meshes_.size()) - 1;
  }

  int add_node(const aiNode& node, const aiMatrix4x4& outer) {
    const std::size_t index = nodes_.size();
    nodes_.push_back(json::object());
    json out = json::object();
    std::string name = to_utf8(node.mName.C_Str());
    const int mesh = mesh_of(node);
    // Names made up by assimp are in angle brackets, or the file's.
    if (name.empty() || name.front() == '<' || name == "model." + format_) {
      const std::string own = mesh >= 0 ? meshes_[static_cast<std::size_t>(mesh)].value("name", "") : "";
      name = own.empty() ? stem_ : own;
    }
    out["name"] = name;
    if (mesh >= 0) out["mesh"] = mesh;
    const aiMatrix4x4 m = outer * node.mTransformation;
    if (!m.IsIdentity()) {
      json matrix = json::array();
      for (unsigned column = 0; column < 4; ++column)
        for (unsigned row = 0; row < 4; ++row) matrix.push_back(m[row][column]);
      const bool sound = std::ranges::all_of(matrix, [](const json& v) { return std::isfinite(v.get<double>()); });
      if (!sound) throw Refused("the transform of node " + name + " is not finite");
      out["matrix"] = matrix;
    }
    json children = json::array();
    for (unsigned c = 0; c < node.mNumChildren; ++c) children.push_back(add_node(*node.mChildren[c], {}));
    if (!children.empty()) out["children"] = children;
    nodes_[index] = std::move(out);
    return static_cast<int>(index);
  }

  const aiScene& scene_;
  const std::string format_, stem_;
  Declared declared_;
  Buffer buffer_;
  std::vector<json> primitives_;  // one for each mesh of assimp; null: no triangles
  std::map<unsigned, int> material_indices_;
  std::map<std::vector<unsigned>, int> mesh_indices_;
  json nodes_ = json::array(), meshes_ = json::array(), materials_ = json::array();
  bool triangles_ = false;
  std::size_t lines_or_points_ = 0;
};

}  // namespace

std::string convert(const std::filesystem::path& file, const std::string& format) {
  Assimp::Importer importer;
  auto* files = new RenamedFile(file, format);
  importer.SetIOHandler(files);  // takes ownership
  importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_USE_COLLADA_NAMES, true);
  const aiScene* scene = importer.ReadFile(
      files->shown(), aiProcess_Triangulate | aiProcess_SortByPType | aiProcess_JoinIdenticalVertices);
  if (!scene || !scene->mRootNode) {
    const std::string why = importer.GetErrorString();
    if (why.find("bad_alloc") != std::string::npos) throw std::bad_alloc();  // which assimp has caught
    throw Refused("it cannot be read: " + why);
  }
  return Converter(*scene, file, format).run();
}

}  // namespace vantage::importer
