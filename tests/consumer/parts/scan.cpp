// SPDX-License-Identifier: Apache-2.0
// Evaluates a station: the part `scan`.
#include <cstdio>
#include <vantage/site.hpp>
#include <vector>

int main(int, char** argv) {
  using namespace vantage;
  Site site = Site::open(argv[1], {.user_size_m = 0.5, .spacing_m = 0.3, .engine = Engine::embree});
  const std::vector<PlacedStation> stations{site.place_head({0, -8, 1.5}).station};
  const double coverage = site.evaluate(stations).value("coverage");
  std::printf("coverage %.3f\n", coverage);
  return coverage > 0 ? 0 : 1;
}
