// SPDX-License-Identifier: Apache-2.0
// Compares the truth of each site with its file, cell by cell: one reaches on foot, over the loaded triangles, exactly
// the floors of the truth.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <vector>

#include "scene/scene_data.hpp"
#include "sites/site.hpp"
#include "support/temporary_folder.hpp"
#include "vantage/scene.hpp"

namespace vantage {
namespace {

using test::KnownSite;
using test::Standing;
using test::Surface;

constexpr double kCell = 0.1, kStep = 0.25;

// The loaded scene cut by vertical lines through the middles of cells: heights at which a person could stand upright.
class Columns {
 public:
  explicit Columns(const Scene& scene) : origin_(scene.bounds().min) {
    const SceneData& data = scene.data();
    const Vec3 size = scene.bounds().size();
    nx_ = static_cast<int>(size.x / kCell) + 1, ny_ = static_cast<int>(size.y / kCell) + 1;
    std::vector<std::vector<Hit>> hits(static_cast<std::size_t>(nx_ * ny_));
    for (const Triangle& t : data.triangles) {
      Vec3 p[3];
      for (int i = 0; i < 3; ++i) {
        const Float3& q = data.positions[t[static_cast<std::size_t>(i)]];
        p[i] = Vec3{q.x, q.y, q.z} + data.origin - origin_;
      }
      cut(p, hits);
    }
    levels_.resize(hits.size());
    for (std::size_t c = 0; c < hits.size(); ++c) {
      std::ranges::sort(hits[c], {}, &Hit::z);
      int shells = 0;  // shells around the space above the hits so far
      for (std::size_t i = 0; i < hits[c].size(); ++i) {
        const Hit& hit = hits[c][i];
        shells += hit.upward ? -1 : 1;
        const bool last_here = i + 1 == hits[c].size() || hits[c][i + 1].z > hit.z + kSame;
        if (!last_here || shells != 0) continue;
        if (i + 1 == hits[c].size() || hits[c][i + 1].z - hit.z >= test::kUpright_m)
          levels_[c].push_back({hit.z, false});
      }
    }
  }

  // Marks the cells reached from a point by steps of at most kStep.
  void walk(const Vec3& entry) {
    struct Visit {
      int x, y;
      std::size_t level;
    };
    std::vector<Visit> stack;
    const Vec3 from = entry - origin_;
    const int x0 = static_cast<int>(from.x / kCell), y0 = static_cast<int>(from.y / kCell);
    const auto enter = [&](int x, int y, double z) {
      if (x < 0 || y < 0 || x >= nx_ || y >= ny_) return;
      auto& column = levels_[index(x, y)];
      for (std::size_t i = 0; i < column.size(); ++i)
        if (!column[i].reached && std::abs(column[i].z - z) <= kStep) {
          column[i].reached = true;
          stack.push_back({x, y, i});
        }
    };
    enter(x0, y0, from.z);
    while (!stack.empty()) {
      const Visit at = stack.back();
      stack.pop_back();
      const double z = levels_[index(at.x, at.y)][at.level].z;
      enter(at.x - 1, at.y, z), enter(at.x + 1, at.y, z), enter(at.x, at.y - 1, z), enter(at.x, at.y + 1, z);
    }
  }

  template <class Body>
  void each(Body&& body) const {
    for (int y = 0; y < ny_; ++y)
      for (int x = 0; x < nx_; ++x)
        for (const Level& level : levels_[index(x, y)])
          body(origin_ + Vec3{middle(x), middle(y), level.z}, level.reached);
  }

 private:
  static constexpr double kSame = 1e-3;
  struct Hit {
    double z;
    bool upward;
  };
  struct Level {
    double z;
    bool reached;
  };
  std::size_t index(int x, int y) const { return static_cast<std::size_t>(y * nx_ + x); }
  // off the middle by irrational shares, so that no vertical line meets an edge
  static double middle(int i) { return (i + 0.4142135623) * kCell; }
  void cut(const Vec3* p, std::vector<std::vector<Hit>>& hits) const {
    const Vec3 n = cross(p[1] - p[0], p[2] - p[0]);
    if (std::abs(n.z) < 1e-12) return;
    const auto range = [&](double a, double b, double c, int count) {
      const int first = static_cast<int>(std::min({a, b, c}) / kCell) - 1;
      const int last = static_cast<int>(std::max({a, b, c}) / kCell) + 1;
      return std::pair{std::max(first, 0), std::min(last, count - 1)};
    };
    const auto [x0, x1] = range(p[0].x, p[1].x, p[2].x, nx_);
    const auto [y0, y1] = range(p[0].y, p[1].y, p[2].y, ny_);
    for (int y = y0; y <= y1; ++y)
      for (int x = x0; x <= x1; ++x) {
        const double px = middle(x), py = middle(y);
        bool in = true;
        for (int i = 0; i < 3 && in; ++i) {
          const Vec3 &a = p[i], &b = p[(i + 1) % 3];
          in = ((b.x - a.x) * (py - a.y) - (b.y - a.y) * (px - a.x)) * n.z >= 0;
        }
        if (!in) continue;
        const double z = p[0].z - (n.x * (px - p[0].x) + n.y * (py - p[0].y)) / n.z;
        hits[index(x, y)].push_back({z, n.z > 0});
      }
  }

  Vec3 origin_;
  int nx_ = 0, ny_ = 0;
  std::vector<std::vector<Level>> levels_;
};

class Sites : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(All, Sites, testing::ValuesIn(test::site_names().begin(), test::site_names().end()),
                         [](const auto& site) { return std::string(site.param); });

TEST_P(Sites, FloorsAreWhatIsReachedOnFoot) {
  for (const test::Variant variant : {test::Variant{}, test::Variant{.utm = true}}) {
    const test::TemporaryFolder folder;
    const KnownSite site = make_site(GetParam(), variant);
    write_site(site, variant, folder / "site.glb");
    const Scene scene = Scene::load(folder / "site.glb");
    Columns columns(scene);
    columns.walk(site.entry);
    std::size_t floors = 0, missed = 0, wrong = 0;
    std::map<std::string, std::pair<std::size_t, std::size_t>> places;  // cells, and reached cells
    std::map<Surface, std::size_t> seen;
    columns.each([&](const Vec3& ground, bool reached) {
      const Standing standing = site.at(ground);
      ++seen[standing.surface];
      const bool is_floor = standing.surface == Surface::floor;
      floors += is_floor;
      missed += is_floor && !reached;
      if (reached && !is_floor && ++wrong <= 5)
        ADD_FAILURE() << "reached, but " << to_string(standing.surface) << " (" << standing.place << ") at " << ground.x
                      << ", " << ground.y << ", " << ground.z;
      if (is_floor) ++places[standing.place].first, places[standing.place].second += reached;
    });
    EXPECT_EQ(wrong, 0U);
    EXPECT_GT(floors, 10'000U);
    EXPECT_LT(missed, floors / 100) << "floor that nobody gets to, of " << floors << " cells";
    for (const test::Place& place : site.places) {
      const auto [cells, reached] = places[place.name];
      const double area = (place.x1 - place.x0) * (place.y1 - place.y0);
      EXPECT_GT(static_cast<double>(cells) * kCell * kCell, 0.35 * area) << place.name;
      EXPECT_GT(reached * 10, cells * 9) << place.name;
    }
    EXPECT_GT(seen[Surface::roof] + seen[Surface::equipment], 500U);  // traps
    EXPECT_EQ(seen[Surface::outside], 0U);
    EXPECT_EQ(seen[Surface::air], 0U);
    EXPECT_EQ(seen[Surface::inside], 0U);
  }
}

TEST_P(Sites, PartsAreClosed) {
  for (const test::Part& part : test::make_site(GetParam()).parts) {
    double volume = 0;
    Vec3 area;
    for (const auto& t : part.triangles) {
      const Vec3 &a = part.positions[t[0]], &b = part.positions[t[1]], &c = part.positions[t[2]];
      const Vec3 normal = cross(b - a, c - a);
      area = area + normal * 0.5;
      volume += dot(a, normal) / 6;
    }
    EXPECT_GT(volume, 1e-4) << part.name;  // faces outward
    for (const double sum : {area.x, area.y, area.z}) EXPECT_NEAR(sum, 0, 1e-9) << part.name;
  }
}

TEST(Sites, TellWhatLiesUnderAPoint) {
  const auto at = [](const char* name, const Vec3& p) { return test::make_site(name).at(p); };
  EXPECT_EQ(at("office", {12, 7.5, 0}).place, "corridor");
  EXPECT_EQ(at("office", {12, 7.5, 0}).surface, Surface::floor);
  EXPECT_EQ(at("office", {12, 6.55, 0}).surface, Surface::inside);
  EXPECT_EQ(at("office", {2.0, 2.4, 0}).surface, Surface::covered);
  EXPECT_EQ(at("office", {2.0, 2.4, 0.74}).surface, Surface::furniture);
  EXPECT_EQ(at("office", {3, 3, 2.85}).surface, Surface::sealed);
  EXPECT_EQ(at("office", {3, 3, 3.5}).surface, Surface::roof);
  EXPECT_EQ(at("office", {0.1, 3, 3.8}).surface, Surface::wall_top);
  EXPECT_EQ(at("office", {3, 3, 1.2}).surface, Surface::air);
  EXPECT_EQ(at("office", {30, 3, 0}).surface, Surface::outside);
  EXPECT_EQ(at("house", {2, 2, 0.15}).place, "living");
  EXPECT_EQ(at("house", {2, 2, 3.21}).place, "bedroom_1");
  EXPECT_EQ(at("house", {2, 2, 3.21}).storey, 1);
  EXPECT_EQ(at("house", {2, 4, 6.01}).surface, Surface::sealed);
  EXPECT_EQ(at("house", {4.3, 2.1, 0.33}).place, "stair");
  EXPECT_EQ(at("house", {1.4, 4, 3.71}).surface, Surface::furniture);
  EXPECT_EQ(at("street", {8, 13, 0.85}).surface, Surface::car);
  EXPECT_EQ(at("street", {10, 5, 0.22}).surface, Surface::sealed);
  EXPECT_EQ(at("street", {10, 5, 5.45}).surface, Surface::sealed);
  EXPECT_EQ(at("street", {30, 9, 0.12}).place, "south_gardens");
  EXPECT_EQ(at("plant", {4, 4.5, 4}).surface, Surface::equipment);
  EXPECT_EQ(at("plant", {13, 15, 2.52}).place, "platform");
  EXPECT_THROW(test::make_site("castle"), std::invalid_argument);
}

}  // namespace
}  // namespace vantage
