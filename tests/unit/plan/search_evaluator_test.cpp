// SPDX-License-Identifier: Apache-2.0
#include "search/search_evaluator.hpp"

#include <gtest/gtest.h>

#include "unit/plan/toy_survey.hpp"
#include "vantage/error.hpp"

namespace vantage {
namespace {

using test::ToyEvaluator;

PlacedNetwork one_at(double x) { return {{.uv = {x / 10, 0.1}, .position = {x, 1, 4.5}}}; }

SearchArchive archive_of(std::initializer_list<double> xs) {
  SearchArchive archive;
  for (const double x : xs) {
    archive.points.push_back({.x = {x / 10, 0.1}, .f = {0, 0}});
    archive.networks.push_back(one_at(x));
  }
  return archive;
}

SearchValues raw(ToyEvaluator& toy, const std::vector<PlacedNetwork>& networks, const VoxelWindow& window) {
  return *toy.evaluate(networks, window, {});
}

const std::vector<PlacedNetwork> kTwo{one_at(2), one_at(7)};

TEST(SearchEvaluator, ExactAndSampledEvaluateOnce) {
  for (const std::uint64_t voxels : {0, 400}) {
    ToyEvaluator toy;
    toy.noise = 0.5;
    const auto evaluator = make_search_evaluator(toy, {.sample_voxels = voxels}, 2);
    EXPECT_EQ(*evaluator->evaluate(kTwo, {}), raw(toy, kTwo, {.voxels = voxels}));
    const std::uint64_t before = toy.evaluated;
    evaluator->evaluate(kTwo, {});
    EXPECT_EQ(toy.evaluated, before) << "it is remembered";
    EXPECT_EQ(evaluator->archive(), nullptr);
    EXPECT_EQ(evaluator->chunk(), voxels == 0 ? toy.at_once : 0);
    EXPECT_EQ(evaluator->reported_by(), VoxelWindow{.voxels = voxels});
  }
}

class Resampled : public testing::Test {
 protected:
  Resampled() { toy_.noise = 0.5; }
  ToyEvaluator toy_;
  const PlanConfig config_{.sample_voxels = 400, .renew_iterations = 3};
  std::unique_ptr<SearchEvaluator> evaluator_ = make_search_evaluator(toy_, config_, 2);
};

TEST_F(Resampled, IsDueEverySoManyIterations) {
  const SearchArchive archive = archive_of({2, 7});
  EXPECT_FALSE(evaluator_->archive()->due(archive.points, 2));
  EXPECT_TRUE(evaluator_->archive()->due(archive.points, 3));
  ASSERT_TRUE(evaluator_->archive()->re_evaluate(archive, 3, {}));
  EXPECT_FALSE(evaluator_->archive()->due(archive.points, 5));
  EXPECT_TRUE(evaluator_->archive()->due(archive.points, 6));
}

TEST_F(Resampled, TheArchiveHasMeansAndNewcomersTheirLevel) {
  const SearchArchive archive = archive_of({2, 7});
  const SearchValues first = *evaluator_->archive()->re_evaluate(archive, 3, {});
  const SearchValues one = raw(toy_, archive.networks, {400, 400}), two = raw(toy_, archive.networks, {400, 800});
  EXPECT_EQ(first, one) << "the sample that they were taken in by does not count";
  const SearchValues second = *evaluator_->archive()->re_evaluate(archive, 6, {});
  double shift = 0;
  for (std::size_t k = 0; k < 2; ++k) {
    const double mean = (one[k][0] + two[k][0]) / 2;
    EXPECT_DOUBLE_EQ(second[k][0], mean);
    shift += (mean - two[k][0]) / 2;
  }
  const std::vector<PlacedNetwork> newcomer{one_at(4)};
  EXPECT_DOUBLE_EQ((*evaluator_->evaluate(newcomer, {}))[0][0], raw(toy_, newcomer, {400, 800})[0][0] + shift);
}

TEST_F(Resampled, AStoppedCallChangesNothing) {
  const SearchArchive archive = archive_of({2, 7});
  evaluator_->archive()->re_evaluate(archive, 3, {});
  const std::string before = evaluator_->state();
  std::stop_source stop;
  stop.request_stop();
  EXPECT_FALSE(evaluator_->archive()->re_evaluate(archive, 6, {.stop = stop.get_token()}));
  EXPECT_FALSE(evaluator_->archive()->verify(archive, 6, {.stop = stop.get_token()}));
  EXPECT_EQ(evaluator_->state(), before);
  EXPECT_EQ(evaluator_->reported_by(), (VoxelWindow{1600, 400}));
}

TEST_F(Resampled, GoesOnFromItsState) {
  const SearchArchive archive = archive_of({2, 7});
  evaluator_->archive()->re_evaluate(archive, 3, {});
  const auto restored = make_search_evaluator(toy_, config_, 2);
  restored->restore(evaluator_->state());
  EXPECT_EQ(restored->state(), evaluator_->state());
  EXPECT_EQ(restored->archive()->due(archive.points, 5), false);
  EXPECT_EQ(*restored->archive()->re_evaluate(archive, 6, {}), *evaluator_->archive()->re_evaluate(archive, 6, {}));
  const auto verified = *restored->archive()->verify(archive, 9, {}),
             same = *evaluator_->archive()->verify(archive, 9, {});
  for (std::size_t k = 0; k < 2; ++k) EXPECT_EQ(verified[k][0].value, same[k][0].value);
  const std::string state = evaluator_->state();
  for (std::size_t size = 0; size < state.size(); ++size)
    EXPECT_THROW(restored->restore(std::string_view(state).substr(0, size)), Error) << size;
  EXPECT_THROW(make_search_evaluator(toy_, config_, 3)->restore(state), Error) << "of other measures";
}

}  // namespace
}  // namespace vantage
