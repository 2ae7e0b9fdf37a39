// SPDX-License-Identifier: Apache-2.0
#include <assimp/DefaultIOSystem.h>
#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <cmath>
#include <new>

#include "import/mesh/declared_units.hpp"
#include "import/mesh/sources.hpp"
#include "import/program.hpp"

namespace vantage::importer {
namespace {

// Shows the file under a name with its format's extension, by which assimp chooses the reader.
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

double finite_or_0(ai_real value) { return std::isfinite(value) ? static_cast<double>(value) : 0.0; }

class AssimpScene {
 public:
  AssimpScene(const aiScene& scene, const std::string& format) : scene_(scene), format_(format) {
    const Declared declared = declared_units(scene, format);
    model_.unit = declared.unit, model_.up = declared.up, model_.rounded = true;
    model_.nodes[0].outer_from_node = declared.gltf_from_file;
  }

  Model read() {
    for (unsigned m = 0; m < scene_.mNumMeshes; ++m) {
      const aiMesh& mesh = *scene_.mMeshes[m];
      model_.lines_or_points += has_triangles(mesh) ? 0 : mesh.mNumFaces;
      model_.add_mesh({mesh.mName.C_Str(), {}});
      if (has_triangles(mesh)) model_.meshes.back().parts.push_back(part_of(mesh));
    }
    add_node(*scene_.mRootNode, 0);
    return std::move(model_);
  }

 private:
  Part part_of(const aiMesh& mesh) {
    Part part;
    for (unsigned v = 0; v < mesh.mNumVertices; ++v) {
      const aiVector3D& p = mesh.mVertices[v];
      part.positions.emplace_back(p.x, p.y, p.z);
    }
    part.indices.reserve(3 * std::size_t{mesh.mNumFaces});
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
      const aiFace& face = mesh.mFaces[f];
      if (face.mNumIndices != 3) continue;
      if (std::any_of(face.mIndices, face.mIndices + 3, [&](unsigned v) { return v >= mesh.mNumVertices; }))
        throw Refused("a face of mesh " + std::string(mesh.mName.C_Str()) + " names a vertex that is not there");
      part.indices.insert(part.indices.end(), face.mIndices, face.mIndices + 3);
    }
    if (mesh.HasNormals())
      for (unsigned v = 0; v < mesh.mNumVertices; ++v) {
        const aiVector3D& n = mesh.mNormals[v];
        part.normals.push_back(glm::vec3(glm::dvec3(finite_or_0(n.x), finite_or_0(n.y), finite_or_0(n.z))));
      }
    if (mesh.HasVertexColors(0))
      for (unsigned v = 0; v < mesh.mNumVertices; ++v) {
        Rgba rgba;
        for (unsigned c = 0; c < 4; ++c)
          rgba[c] =
              static_cast<std::uint8_t>(std::lround(255 * std::clamp(finite_or_0(mesh.mColors[0][v][c]), 0.0, 1.0)));
        part.colours.push_back(rgba);
      }
    part.material = material_of(mesh.mMaterialIndex);
    return part;
  }

  // Returns -1 if the file gives no material; assimp then makes one up.
  int material_of(unsigned index) {
    const auto [known, is_new] = material_indices_.try_emplace(index, -1);
    if (!is_new || index >= scene_.mNumMaterials) return known->second;
    const aiMaterial& given = *scene_.mMaterials[index];
    aiString name;
    given.Get(AI_MATKEY_NAME, name);
    aiColor4D colour;
    const bool coloured = given.Get(AI_MATKEY_COLOR_DIFFUSE, colour) == aiReturn_SUCCESS;
    if (!coloured || name == aiString(AI_DEFAULT_MATERIAL_NAME)) return -1;
    ai_real opacity = 1;
    given.Get(AI_MATKEY_OPACITY, opacity);
    Material material{name.C_Str(), {}, given.GetTextureCount(aiTextureType_DIFFUSE) > 0};
    material.rgba = {finite_or_0(colour.r), finite_or_0(colour.g), finite_or_0(colour.b), finite_or_0(opacity)};
    model_.materials.push_back(std::move(material));
    return known->second = static_cast<int>(model_.materials.size()) - 1;
  }

  void add_node(const aiNode& node, std::size_t parent) {
    glm::dmat4 matrix(1);
    for (unsigned column = 0; column < 4; ++column)
      for (unsigned row = 0; row < 4; ++row)
        matrix[static_cast<int>(column)][static_cast<int>(row)] =
            static_cast<double>(node.mTransformation[row][column]);
    std::string name = node.mName.C_Str();
    // Names made up by assimp are in angle brackets, or the file's.
    if (!name.empty() && (name.front() == '<' || name == "model." + format_)) name.clear();
    const std::size_t index = model_.add_node(parent, name, matrix);
    for (unsigned m = 0; m < node.mNumMeshes; ++m)
      if (node.mMeshes[m] < model_.meshes.size()) model_.nodes[index].meshes.push_back(node.mMeshes[m]);
    for (unsigned c = 0; c < node.mNumChildren; ++c) add_node(*node.mChildren[c], index);
  }

  const aiScene& scene_;
  const std::string format_;
  std::map<unsigned, int> material_indices_;
  Model model_;
};

}  // namespace

Model read_with_assimp(const std::filesystem::path& file, const std::string& format) {
  Assimp::Importer importer;
  auto* files = new RenamedFile(file, format);
  importer.SetIOHandler(files);  // takes ownership
  const aiScene* scene = importer.ReadFile(
      files->shown(), aiProcess_Triangulate | aiProcess_SortByPType | aiProcess_JoinIdenticalVertices);
  if (!scene || !scene->mRootNode) {
    const std::string why = importer.GetErrorString();
    if (why.find("bad_alloc") != std::string::npos) throw std::bad_alloc();  // which assimp has caught
    throw Refused("it cannot be read: " + why);
  }
  return AssimpScene(*scene, format).read();
}

}  // namespace vantage::importer
