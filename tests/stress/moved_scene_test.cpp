// SPDX-License-Identifier: Apache-2.0
#include "stress/moved_scene.hpp"

#include <algorithm>
#include <string>

#include "stress/engine_suite.hpp"
#include "stress/swept_wall.hpp"

namespace vantage::test {
namespace {

using MovedScene = EngineSuite;

TEST_P(MovedScene, ShiftsAndScalesChangeNoCount) {
  for (const Move& move : shifts_and_scales()) {
    SCOPED_TRACE(move.name);
    const MovedFigures f = compare_moved(GetParam(), move, 1);
    EXPECT_LE(static_cast<double>(f.differing), 1e-5 * static_cast<double>(f.rays));
    EXPECT_LT(f.farthest_m, 1e-4);
    EXPECT_TRUE(f.counts_equal || f.differing > 0);
    EXPECT_NEAR(f.moved_coverage, f.coverage, 1e-5);
  }
}

TEST_P(MovedScene, TurnsOnlyCutTheVoxelsAnew) {
  for (const Move& move : {turns()[1], turns()[3]}) {
    SCOPED_TRACE(move.name);
    const MovedFigures f = compare_moved(GetParam(), move, 1);
    EXPECT_LE(static_cast<double>(f.differing_hits), 1e-4 * static_cast<double>(f.rays));
    EXPECT_LT(f.farthest_m, 1e-4);
    EXPECT_NEAR(f.moved_coverage, f.predicted_coverage, 1e-4);
    EXPECT_GT(f.differing, f.differing_hits) << "the cut should be another";
  }
}

TEST_P(MovedScene, AWallSweptThroughAVoxelKeepsItsCoverage) {
  const bool quick = !GetParam().software && GetParam().engine != Engine::embree;
  const int steps = GetParam().engine == Engine::embree || quick ? 200 : 4;
  for (int axis = 0; axis < (steps == 200 ? 3 : 1); ++axis) {
    const SweepFigures sweep = sweep_wall(GetParam(), axis, steps);
    EXPECT_LT(sweep.spread(), 0.01) << "axis " << axis << ": " << sweep.least << " to " << sweep.most;
    EXPECT_GT(sweep.least, 0.1);
  }
}
VANTAGE_EVERY_ENGINE(MovedScene);

// Precision lost before the file was written cannot be recovered, but must be reported.
TEST(BakedCoordinates, AreNotedWithThePrecisionLost) {
  const auto note = [](const Scene& scene) {
    const auto found = std::ranges::find_if(
        scene.notes(), [](const std::string& text) { return text.find("baked into float32") != std::string::npos; });
    return found == scene.notes().end() ? std::string() : *found;
  };
  EXPECT_EQ(note(yard({"here", {}}, true)), "");
  EXPECT_EQ(note(yard({"UTM", {500'000, 4'500'000, 230}})), "") << "a root node loses nothing";
  EXPECT_NE(note(yard({"1 km", {1000, 1000, 0}}, true)).find(" 6.1e-05 m;"), std::string::npos);
  EXPECT_NE(note(yard({"100 km", {100'000, 100'000, 0}}, true)).find(" 0.00781 m;"), std::string::npos);
  EXPECT_NE(note(yard({"UTM", {500'000, 4'500'000, 230}}, true)).find(" 0.5 m;"), std::string::npos);
}

}  // namespace
}  // namespace vantage::test
