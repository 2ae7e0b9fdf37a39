// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <utility>

#include "core/closest_name.hpp"
#include "vantage/error.hpp"
#include "vantage/trace.hpp"

namespace vantage {
namespace {

constexpr std::array<std::pair<Engine, const char*>, 4> kEngineNames{{{Engine::automatic, "auto"},
                                                                      {Engine::ray_query, "ray_query"},
                                                                      {Engine::compute_bvh, "compute_bvh"},
                                                                      {Engine::embree, "embree"}}};

}  // namespace

std::string to_string(Engine engine) {
  for (const auto& [known, name] : kEngineNames) {
    if (known == engine) return name;
  }
  return "unknown";
}

Engine engine_from_string(const std::string& text) {
  if (text == "automatic") return Engine::automatic;  // name of the enumerator
  std::string known;
  std::vector<std::string> all;
  for (const auto& [engine, name] : kEngineNames) {
    if (text == name) return engine;
    known += (known.empty() ? "" : ", ") + std::string(name);
    all.emplace_back(name);
  }
  throw Error(Errc::invalid_argument,
              "unknown engine '" + text + "'; choose one of " + known + did_you_mean(text, all));
}

}  // namespace vantage
