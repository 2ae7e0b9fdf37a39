// SPDX-License-Identifier: Apache-2.0
// Draws a station on a plan of the site: the part `files`.
#include <cstdio>
#include <filesystem>
#include <string>
#include <vantage/export.hpp>
#include <vantage/site.hpp>
#include <vector>

int main(int, char** argv) {
  using namespace vantage;
  Site site = Site::open(argv[1], {.user_size_m = 0.5, .spacing_m = 0.3, .engine = Engine::embree});
  const std::vector<PlacedStation> stations{site.place_head({0, -8, 1.5}).station};
  const std::filesystem::path table = std::filesystem::path(argv[2]) / "stations.csv";
  write_stations_csv(table, stations);
  std::printf("%ju bytes\n", std::filesystem::file_size(table));
  return std::filesystem::file_size(table) > 0 ? 0 : 1;
}
