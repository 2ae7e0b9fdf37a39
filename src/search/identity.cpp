// SPDX-License-Identifier: Apache-2.0
#include "search/identity.hpp"

#include <charconv>
#include <string_view>

#include "core/hash.hpp"
#include "site/placement_oracle.hpp"
#include "vantage/version.hpp"

namespace vantage {
namespace {

class Lines {
 public:
  void add(std::string_view name, std::string_view value) {
    text_.append(name).append(" = ").append(value).append("\n");
  }
  void add(std::string_view name, double value) {
    char buffer[32];
    add(name, std::string_view(
                  buffer, static_cast<std::size_t>(std::to_chars(buffer, buffer + sizeof buffer, value).ptr - buffer)));
  }
  void add(std::string_view name, std::uint64_t value) { add(name, std::string_view(std::to_string(value))); }
  void add(const std::string& group, const Settings& settings) {
    for (const Setting& setting : settings)
      if (setting.decides) add(group + " " + setting.name, setting.json);
  }
  void add_hash(std::string_view name, const Hash& hash) {
    char buffer[17] = {};
    std::to_chars(buffer, buffer + 16, hash.value(), 16);
    add(name, std::string_view(buffer));
  }
  std::string text() && { return std::move(text_); }

 private:
  std::string text_;
};

Hash hash_of(std::span<const Vec3> points) {
  Hash hash;
  for (const Vec3& p : points) hash.add(p.x), hash.add(p.y), hash.add(p.z);
  return hash;
}

// Hash of ground and security volume as the search sees them: the answers on a grid of (u, v).
Hash hash_of(const PlacementOracle& oracle) {
  constexpr int kSide = 33;
  Hash hash;
  for (int i = 0; i < kSide; ++i) {
    for (int j = 0; j < kSide; ++j) {
      const auto at = [](double low, double high, int k) { return low + (high - low) * k / (kSide - 1); };
      const auto station = place_station(
          oracle, {at(oracle.uv_min.u, oracle.uv_max.u, i), at(oracle.uv_min.v, oracle.uv_max.v, j)}, oracle.height_m);
      hash.add(static_cast<int>(station.status));
      hash.add(station.position.x), hash.add(station.position.y), hash.add(station.position.z);
    }
  }
  return hash;
}

}  // namespace

std::string identity(Site& site, const SurveyProblem& problem, const PlanConfig& config, std::size_t population,
                     std::size_t batch) {
  const Simulator& simulator = site.simulator();
  const SearchArea& area = site.area();
  Lines lines;
  lines.add("version", version());
  Hash scene;
  scene.add(simulator.scene().fingerprint());
  lines.add_hash("scene", scene);
  Hash search;
  for (const Uv& uv : area.mesh().uvs) search.add(uv.u), search.add(uv.v);
  search.add_all(area.mesh().triangles);
  search.add(hash_of(area.mesh().positions).value());
  lines.add_hash("search area", search);
  lines.add_hash("holes and clashes", hash_of(make_placement_oracle(site)));

  lines.add("engine", to_string(simulator.engine().engine));
  lines.add("population", std::uint64_t{population});
  lines.add("batch", std::uint64_t{batch});
  for (const Scanner& scanner : simulator.scanners()) lines.add("scanner", settings(scanner));
  lines.add("simulation", settings(simulator.config()));
  lines.add("walkable", settings(area.options()));
  lines.add("security", settings(site.clash().volume()));
  lines.add("problem", settings(problem));
  lines.add("plan", settings(config));
  return std::move(lines).text();
}

}  // namespace vantage
