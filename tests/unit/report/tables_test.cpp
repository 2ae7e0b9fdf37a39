// SPDX-License-Identifier: Apache-2.0
#include "report/tables.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "support/temporary_folder.hpp"
#include "unit/report/files.hpp"

namespace vantage {
namespace {

TEST(Tables, OverlapIsASquareWithAHeader) {
  const test::TemporaryFolder folder;
  OverlapMatrix overlap(3);
  overlap.set(0, 2, 0.1 + 0.2);
  write_overlap_csv(folder / "o.csv", overlap);
  EXPECT_EQ(test::content(folder / "o.csv"),
            "station,1,2,3\n1,0,0,0.30000000000000004\n2,0,0,0\n3,0.30000000000000004,0,0\n");
}

TEST(Tables, EveryLineHasAsManyCellsAsTheHeader) {
  const test::TemporaryFolder folder;
  for (const Problem problem :
       {Problem::coverage_fix, Problem::coverage_overlap_fix, Problem::coverage_min, Problem::coverage_overlap_min}) {
    PlanConfig config{.problem = problem, .stations_min = 2, .stations_max = 5};
    PlanResult result = test::sample_result(config, 7);
    result.front[2].stations[1].status = StationStatus::hole;
    result.front[3].confirmed = false;
    write_front_csv(folder / "front.csv", result, config);
    write_history_csv(folder / "history.csv", result);
    write_fronts_csv(folder / "fronts.csv", result, config);
    for (const auto& [name, lines] : {std::pair{"front.csv", 8}, {"history.csv", 21}, {"fronts.csv", 141}}) {
      const std::string text = test::content(folder / name);
      EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), lines) << name;
      const auto commas = std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(text.find('\n')), ',');
      for (std::size_t at = 0; at < text.size(); at = text.find('\n', at) + 1) {
        const std::string line = text.substr(at, text.find('\n', at) - at);
        EXPECT_EQ(std::count(line.begin(), line.end(), ','), commas) << name << ": " << line;
      }
    }
  }
}

}  // namespace
}  // namespace vantage
