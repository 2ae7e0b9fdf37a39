// SPDX-License-Identifier: Apache-2.0
// Value of a searched front by every ray, second by second, and its difference from the search's own value.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "bench_site.hpp"

namespace vantage::bench {

struct FrontOptions {
  SiteOptions site;
  std::string problem = "coverage-overlap-fix", stations = "15";
  std::string algorithm = "mo_cma_es";
  std::size_t population = 250, iterations = 600, batch = 0;
  std::vector<std::string> samples{"20000", "5000/20"};  // voxels, /iterations between draws
  std::vector<std::uint64_t> seeds{1};
  std::vector<std::size_t> devices;  // empty: the best one
  double first_s = 1, ratio = 1.5;   // times at which the front is judged: the first, and the factor to each next
  std::string picture;
  void add(CLI::App& command);
};

void run_front(const FrontOptions& options);

}  // namespace vantage::bench
