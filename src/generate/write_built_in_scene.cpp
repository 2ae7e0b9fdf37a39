// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <string>
#include <utility>

#include "core/closest_name.hpp"
#include "generate/glb_writer.hpp"
#include "generate/model.hpp"
#include "generate/sites/model.hpp"
#include "vantage/built_in_scenes.hpp"
#include "vantage/error.hpp"

namespace vantage {

std::span<const std::string> built_in_scene_names() noexcept {
  static const std::array<std::string, 10> kNames{"three-walls", "four-walls", "industrial", "office",   "house",
                                                  "street",      "plant",      "tunnel",     "corridor", "facade"};
  return kNames;
}

void write_built_in_scene(const std::string& name, std::size_t triangles, const std::filesystem::path& file) {
  if (name == "three-walls") return built_in::write_glb(built_in::three_walls(), file);
  if (name == "four-walls") return built_in::write_glb(built_in::four_walls(), file);

  if (name == "industrial") return built_in::write_glb(built_in::industrial(triangles), file);
  for (const auto& [site, make] : {std::pair{"office", &sites::office},
                                   {"house", &sites::house},
                                   {"street", &sites::street},
                                   {"plant", &sites::plant},
                                   {"tunnel", &sites::tunnel},
                                   {"corridor", &sites::corridor},
                                   {"facade", &sites::facade}})
    if (name == site) return built_in::write_glb(sites::model_of(make()), file);
  std::string known;
  for (const std::string& scene : built_in_scene_names()) known += (known.empty() ? "" : ", ") + scene;
  throw Error(Errc::invalid_argument, "there is no built-in scene \"" + name + "\"; there are " + known +
                                          did_you_mean(name, built_in_scene_names()));
}

}  // namespace vantage
