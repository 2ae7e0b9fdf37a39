// SPDX-License-Identifier: Apache-2.0
#include "fuzz/target.hpp"
#include "image/decode.hpp"
#include "scene/scene_data.hpp"
#include "vantage/panorama.hpp"
#include "vantage/scene_builder.hpp"

namespace vantage::fuzz {

// Every other file is also marked by patterns of names. They match any node, since a pattern without a match is
// rejected.
static SceneOptions options_for(Bytes bytes) {
  SceneOptions options;
  if (bytes.size() % 2 == 0) return options;
  options.surveyed = {"*"};
  options.weights = {{"*", 3}};
  options.details_mm = {{"*", 4}};
  options.accuracies_mm = {{"*", 5}, {"?*", 6}};
  options.doors = {"*"};
  return options;
}

void gltf(Bytes bytes) {
  accepts([&] {
    const Scene scene = load_gltf(bytes, options_for(bytes));
    const SceneData& data = scene.data();
    for (const auto& triangle : data.triangles)
      for (const std::uint32_t corner : triangle) require(corner < data.positions.size(), "corners exist");
    for (const auto& p : data.positions)
      require(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z), "positions are finite");
    std::size_t triangles = 0;
    for (const MeshInfo& mesh : scene.meshes()) {
      triangles += mesh.triangle_count;
      require(mesh.diffuse >= 0 && mesh.diffuse <= 1, "R lies in [0, 1]");
      require(mesh.weight >= 1 && mesh.weight <= 255, "weights lie in [1, 255]");
    }
    require(triangles == scene.triangle_count(), "meshes have all triangles");
    const Vec3 size = scene.bounds().size();
    require(std::isfinite(size.x) && std::isfinite(size.y) && std::isfinite(size.z), "bounds are finite");
    require(load_gltf(bytes, options_for(bytes)).fingerprint() == scene.fingerprint(),
            "the same bytes are the same scene");
  });
}

void image(Bytes bytes) {
  std::string problem;
  const Image found = decode_image(bytes, problem);
  require(found.rgba.size() == std::size_t{4} * found.width * found.height, "an image has all its pixels");
  require(!found.rgba.empty() || !problem.empty(), "what is no image is explained");
}

void panorama(Bytes bytes) {
  accepts([&] {
    const Panorama photograph = Panorama::load(file_of(bytes, "photograph.jpg"), Angle::degrees(30));
    for (int zenith = 0; zenith <= 180; zenith += 45)
      for (int azimuth = -720; azimuth <= 720; azimuth += 90)
        photograph.colour(Angle::degrees(zenith), Angle::degrees(azimuth));
  });
}

}  // namespace vantage::fuzz
