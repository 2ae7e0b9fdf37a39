// SPDX-License-Identifier: Apache-2.0
#include "formats/tables.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "support/temporary_folder.hpp"
#include "unit/formats/files.hpp"

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
  for (const std::string name : {"coverage-fix", "coverage-overlap-fix", "coverage-min", "coverage-overlap-min"}) {
    PlanResult result = test::sample_result(name, 2, 5, 7);
    result.front[2].stations[1].status = StationStatus::hole;
    result.front[3].exact = false;
    write_front_csv(folder / "front.csv", result);
    write_history_csv(folder / "history.csv", result);
    write_fronts_csv(folder / "fronts.csv", result);
    for (const auto& [table, lines] : {std::pair{"front.csv", 8}, {"history.csv", 21}, {"fronts.csv", 141}}) {
      const std::string text = test::content(folder / table);
      EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), lines) << table;
      const auto commas = std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(text.find('\n')), ',');
      for (std::size_t at = 0; at < text.size(); at = text.find('\n', at) + 1) {
        const std::string line = text.substr(at, text.find('\n', at) - at);
        EXPECT_EQ(std::count(line.begin(), line.end(), ','), commas) << table << ": " << line;
      }
    }
  }
}

}  // namespace
}  // namespace vantage
