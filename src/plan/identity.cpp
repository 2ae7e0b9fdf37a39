// SPDX-License-Identifier: Apache-2.0
#include "plan/identity.hpp"

#include <charconv>
#include <string_view>

#include "core/hash.hpp"
#include "plan/choose_optimiser.hpp"
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

// What the search can see of ground and security volume: the answers on a grid of (u, v).
Hash hash_of(const Site& site) {
  constexpr int kSide = 33;
  Hash hash;
  for (int i = 0; i < kSide; ++i) {
    for (int j = 0; j < kSide; ++j) {
      const auto at = [](double low, double high, int k) { return low + (high - low) * k / (kSide - 1); };
      const auto station = place_station(
          site, {at(site.uv_min.u, site.uv_max.u, i), at(site.uv_min.v, site.uv_max.v, j)}, site.height_m);
      hash.add(static_cast<int>(station.status));
      hash.add(station.position.x), hash.add(station.position.y), hash.add(station.position.z);
    }
  }
  return hash;
}

Hash hash_of(const NoiseTable& noise) {
  Hash hash;
  hash.add_all(noise.distances_m), hash.add_all(noise.reflectivities), hash.add_all(noise.sigma_m);
  return hash;
}

}  // namespace

std::string identity(const Simulator& simulator, const Site& site, const SearchArea& area, const PlanConfig& config,
                     std::size_t batch) {
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
  lines.add_hash("holes and clashes", hash_of(site));

  const Scanner& scanner = simulator.scanner();
  lines.add("scanner heading", scanner.heading.in_degrees());
  lines.add("scanner horizontal angle", scanner.horizontal_angle.in_degrees());
  lines.add("scanner vertical angle", scanner.vertical_angle.in_degrees());
  lines.add("scanner azimuth step", scanner.azimuth_step.in_degrees());
  lines.add("scanner zenith step", scanner.zenith_step.in_degrees());
  lines.add("scanner height", scanner.height_m);
  lines.add("scanner minimum range", scanner.min_range_m);
  lines.add("scanner maximum range", scanner.max_range_m);
  const SimulatorConfig& simulation = simulator.config();
  lines.add("noise", simulation.noise && !scanner.noise.empty() ? "on" : "off");
  if (simulation.noise) lines.add_hash("noise table", hash_of(scanner.noise));
  lines.add("engine", to_string(simulator.engine().engine));
  lines.add("user size", simulation.user_size_m);
  lines.add("point spacing", simulation.point_spacing_m);
  lines.add("simulation seed", simulation.seed);

  lines.add("problem", to_string(config.problem));
  lines.add("stations minimum", std::uint64_t{config.stations_min});
  lines.add("stations maximum", std::uint64_t{config.stations_max});
  lines.add("algorithm", to_string(config.algorithm));
  lines.add("scheme", config.scheme == MoCmaEsConfig::Scheme::generational ? "generational" : "steady state");
  lines.add("population", std::uint64_t{population_of(config)});
  lines.add("batch", std::uint64_t{batch});
  lines.add("sigma0", config.sigma0);
  lines.add("sample voxels", config.sample_voxels);
  lines.add("redraws", std::uint64_t{config.redraws});
  lines.add("minimum link overlap", config.min_link_overlap);
  if (config.fitness) {
    lines.add("fitness weight of coverage", config.fitness->coverage);
    lines.add("fitness weight of station count", config.fitness->station_count);
    lines.add("fitness weight of visibility", config.fitness->visibility);
  }
  lines.add("lowest height", config.heights_m ? (*config.heights_m)[0] : scanner.height_m);
  lines.add("highest height", config.heights_m ? (*config.heights_m)[1] : scanner.height_m);
  lines.add_hash("initial network", hash_of(config.start));
  lines.add_hash("kept stations", hash_of(config.fixed));
  lines.add("seed", config.seed);
  return std::move(lines).text();
}

}  // namespace vantage
