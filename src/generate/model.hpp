// SPDX-License-Identifier: Apache-2.0
// Parts of the built-in scenes before writing: named, in the survey frame (Z up, metres).
#pragma once

#include <array>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "scene/positions.hpp"
#include "scene/scene_data.hpp"
#include "vantage/scene.hpp"

namespace vantage::built_in {

using glm::dvec3;

struct Mesh {
  std::vector<Float3> positions;
  std::vector<Float3> normals;  // one per position
  std::vector<Float2> uvs;      // empty, or one per position
  std::vector<std::uint32_t> indices;
  std::size_t triangles() const { return indices.size() / 3; }
};

// One glTF node with one mesh.
struct Part {
  std::string name;
  std::optional<Role> role = Role::surveyed;  // empty: the file says nothing
  std::optional<double> diffuse = {};
  std::array<float, 3> colour{0.8F, 0.8F, 0.8F};  // linear
  Mesh mesh = {};
};

struct Model {
  std::vector<Part> parts;
  nlohmann::json defaults;  // asset.extras.vantage; null: none
};

// Scanner and evaluation parameters of a built-in scene, with keys as the program's options. Degrees and metres.
struct Defaults {
  double step = 0.1, height = 1.5;
  const char* noise = "off";
  double spacing = 0.01, user_size = 0.1;
};
nlohmann::json to_json(const Defaults& defaults);

Model three_walls();
Model four_walls();
Model industrial(std::size_t triangles);

}  // namespace vantage::built_in
