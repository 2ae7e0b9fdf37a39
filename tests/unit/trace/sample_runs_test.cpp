// SPDX-License-Identifier: Apache-2.0
#include "trace/sample_runs.hpp"

#include <gtest/gtest.h>

#include <numeric>

namespace vantage {
namespace {

TEST(SampleRuns, HoldEachVoxelOnceInWhateverPieces) {
  for (const std::size_t n : {1u, 31u, 32u, 33u, 1000u, 5000u}) {
    SCOPED_TRACE(n);
    std::vector<std::uint32_t> sample(n), seen(n);
    std::iota(sample.begin(), sample.end(), 0u);
    const std::span<const std::uint32_t> whole = sample;
    const SampleRuns runs(n);
    EXPECT_EQ(runs.size(), (n + 31) / 32);
    for (std::size_t first = 0; first < runs.size(); first += 7) {
      const auto voxels = runs.runs(whole, first, std::min(first + 7, runs.size()));
      EXPECT_TRUE(std::is_sorted(voxels.begin(), voxels.end()));
      for (const std::uint32_t voxel : voxels) ++seen[voxel];
      std::size_t sum = 0;
      for (std::size_t k = first; k < std::min(first + 7, runs.size()); ++k) sum += runs.run(whole, k).size();
      EXPECT_EQ(voxels.size(), sum);
    }
    EXPECT_EQ(seen, std::vector<std::uint32_t>(n, 1));
  }
}

// A tenth of the runs holds about a tenth of any quarter of the site.
TEST(SampleRuns, ComeFromAllOverTheSite) {
  std::vector<std::uint32_t> sample(32'000);
  std::iota(sample.begin(), sample.end(), 0u);
  const SampleRuns runs(sample.size());
  for (std::size_t first = 0; first < runs.size(); first += runs.size() / 10) {
    std::vector<std::size_t> quarters(4);
    for (const std::uint32_t voxel : runs.runs(std::span<const std::uint32_t>(sample), first, first + runs.size() / 10))
      ++quarters[voxel / 8000];
    for (const std::size_t in_quarter : quarters) EXPECT_NEAR(static_cast<double>(in_quarter), 800, 2 * 32);
  }
}

}  // namespace
}  // namespace vantage
