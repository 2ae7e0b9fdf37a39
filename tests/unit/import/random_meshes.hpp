// SPDX-License-Identifier: Apache-2.0
// Random valid files of meshes, with their known content.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "core/glm.hpp"
#include "vantage/scene.hpp"

namespace vantage::test {

// A closed solid whose faces wind counterclockwise seen from outside; survey frame, metres.
struct Solid {
  std::string name;
  std::vector<glm::dvec3> points;
  struct Face {
    std::vector<std::uint32_t> outline, hole;  // no hole: empty
  };
  std::vector<Face> faces;
};

struct Measures {
  double area_m2 = 0, volume_m3 = 0;
  Box bounds = {};
};

struct RandomMeshFile {
  std::filesystem::path file;
  SceneOptions options;                   // unit and axis, if the format does not tell them
  std::string what;                       // format and choices, for messages
  std::map<std::string, Measures> truth;  // by name; "" for formats without names: all of them
};

// Writes one to a folder. Prisms with concave outlines, some with a hole, near the origin or at national coordinates.
RandomMeshFile write_random_mesh(std::uint64_t seed, const std::filesystem::path& folder);

// Returns the measures of a scene's meshes, by their names; `all`: of all as one, by "".
std::map<std::string, Measures> measures_of(const Scene& scene, bool all);

}  // namespace vantage::test
