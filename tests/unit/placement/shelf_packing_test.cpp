// SPDX-License-Identifier: Apache-2.0
#include "placement/shelf_packing.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace vantage {
namespace {

RC_GTEST_PROP(ShelfPacking, RectanglesStayApartAndInside, ()) {
  std::vector<Uv> sizes;
  const int n = *rc::gen::inRange(1, 30);
  double area = 0;
  for (int i = 0; i < n; ++i) {
    sizes.push_back({*rc::gen::inRange(1, 500) * 0.01, *rc::gen::inRange(1, 500) * 0.01});
    area += sizes.back().u * sizes.back().v;
  }
  const double gap = 0.003;
  const Packing p = pack_shelves(sizes, gap);
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    RC_ASSERT(p.corner[i].u >= 0 && p.corner[i].v >= 0);
    RC_ASSERT(p.corner[i].u + sizes[i].u <= p.size.u + 1e-12 && p.corner[i].v + sizes[i].v <= p.size.v + 1e-12);
    for (std::size_t j = 0; j < i; ++j)
      RC_ASSERT(p.corner[i].u + sizes[i].u + gap <= p.corner[j].u + 1e-12 ||
                p.corner[j].u + sizes[j].u + gap <= p.corner[i].u + 1e-12 ||
                p.corner[i].v + sizes[i].v + gap <= p.corner[j].v + 1e-12 ||
                p.corner[j].v + sizes[j].v + gap <= p.corner[i].v + 1e-12);
  }
}

TEST(ShelfPacking, ASingleRectangleFillsTheWhole) {
  const Packing p = pack_shelves({{7, 0.1}}, 0.5);
  EXPECT_EQ(p.size, (Uv{7, 0.1}));
  EXPECT_EQ(p.corner[0], (Uv{0, 0}));
}

TEST(ShelfPacking, EqualSquaresWasteLittle) {
  const Packing p = pack_shelves(std::vector<Uv>(100, Uv{1, 1}), 0.001);
  EXPECT_LT(p.size.u * p.size.v, 106);
}

}  // namespace
}  // namespace vantage
