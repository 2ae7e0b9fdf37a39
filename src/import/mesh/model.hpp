// SPDX-License-Identifier: Apache-2.0
// A model of triangles as read, with coordinates in double, and its conversion to glTF.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "core/glm.hpp"

namespace vantage::importer {

using Rgba = std::array<std::uint8_t, 4>;

// The triangles of a mesh that have one material.
struct Part {
  int material = -1;  // index into Model::materials; -1: none
  std::vector<glm::dvec3> positions;
  std::vector<glm::vec3> normals;      // empty, or one per position; (0, 0, 0) where there is none
  std::vector<Rgba> colours;           // empty, or one per position
  std::vector<std::uint32_t> indices;  // three a triangle
};

struct Mesh {
  std::string name;  // may be empty
  std::vector<Part> parts;
};

struct Material {
  std::string name;
  std::array<double, 4> rgba{1, 1, 1, 1};
  bool textured = false;  // then the colour is in a picture, which is not carried over
};

struct Node {
  std::string name;  // may be empty
  glm::dmat4 outer_from_node{1};
  std::vector<std::size_t> meshes, children;
};

struct Model {
  std::vector<Mesh> meshes;
  std::vector<Material> materials;
  std::vector<Node> nodes = std::vector<Node>(1);  // the first is the root
  bool unit = false, up = false;  // whether the file declares them; the root's transform leads to metres and Y up then
  bool rounded = false;           // whether coordinates were floats in the file or its reader, so that no origin helps
  std::size_t lines_or_points = 0;
  std::map<std::string, std::size_t> left_out;  // numbers of other things that are not read, by kind
  std::vector<std::string> notes;

  std::size_t add_mesh(Mesh mesh);
  // Adds a child of `parent`; returns its index.
  std::size_t add_node(std::size_t parent, std::string name, const glm::dmat4& outer_from_node = glm::dmat4(1));
};

// Returns the bytes of a GLB. A mesh whose coordinates float32 would round, such as national ones, is stored about an
// origin that is subtracted in double. Throws Refused if there is no triangle, or an index or a transform is not sound.
std::string glb_of(const Model& model);

// A change of axes, to Y up as glTF has it.
glm::dmat4 from_z_up();
glm::dmat4 moved_by(const glm::dvec3& way);
glm::dmat4 from_x_up();

}  // namespace vantage::importer
