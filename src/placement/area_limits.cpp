// SPDX-License-Identifier: Apache-2.0
#include "placement/area_limits.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "vantage/error.hpp"

namespace vantage {
namespace {

using Ring = std::vector<std::array<double, 2>>;

double squared_distance_to_outline(const PlanRegion& region, double x, double y) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const Ring& ring : region.rings)
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const auto &a = ring[i], &b = ring[(i + 1) % ring.size()];
      const double ex = b[0] - a[0], ey = b[1] - a[1], length = ex * ex + ey * ey;
      const double s = length > 0 ? std::clamp(((x - a[0]) * ex + (y - a[1]) * ey) / length, 0.0, 1.0) : 0.0;
      const double dx = x - a[0] - s * ex, dy = y - a[1] - s * ey;
      nearest = std::min(nearest, dx * dx + dy * dy);
    }
  return nearest;
}

void check(const std::vector<PlanRegion>& regions, const char* what) {
  for (const PlanRegion& region : regions)
    for (const Ring& ring : region.rings) {
      if (ring.size() < 3)
        throw Error(Errc::invalid_argument, std::string("a ring of the regions ") + what + " has " +
                                                std::to_string(ring.size()) + " corners; it needs three");
      for (const auto& [x, y] : ring)
        if (!std::isfinite(x) || !std::isfinite(y))
          throw Error(Errc::invalid_argument, std::string("a corner of the regions ") + what + " is not finite");
    }
}

struct Vertex {
  Vec3 position;
  Uv uv;
};

Vertex middle_of(const Vertex& a, const Vertex& b) {
  return {(a.position + b.position) * 0.5, {0.5 * (a.uv.u + b.uv.u), 0.5 * (a.uv.v + b.uv.v)}};
}

class Cutter {
 public:
  Cutter(const AreaLimits& limits, double spacing_m, SearchMesh& kept, LeftOut& cut_off)
      : limits_(limits), spacing_(spacing_m), kept_(kept), cut_off_(cut_off) {}

  // Keeps pieces of a triangle together if no limit separates them.
  void cut(const std::array<Vertex, 3>& t) { put(t, sort(t, 0), 0); }

 private:
  enum class Side { in, out, both };
  static constexpr int kMaxDepth = 40;

  double longest_edge(const std::array<Vertex, 3>& t, int& edge) const {
    double longest = -1;
    for (int e = 0; e < 3; ++e) {
      const Vec3 d = t[(e + 1) % 3].position - t[e].position;
      if (dot(d, d) > longest) longest = dot(d, d), edge = e;
    }
    return std::sqrt(longest);
  }
  std::array<std::array<Vertex, 3>, 2> halves(const std::array<Vertex, 3>& t, int e) const {
    const Vertex &a = t[e], &b = t[(e + 1) % 3], &c = t[(e + 2) % 3], m = middle_of(a, b);
    return {{{a, m, c}, {m, b, c}}};
  }
  Side sort(const std::array<Vertex, 3>& t, int depth) const {
    int edge = 0;
    if (longest_edge(t, edge) <= spacing_ || depth == kMaxDepth) {
      const Vec3 centre = (t[0].position + t[1].position + t[2].position) * (1.0 / 3);
      return limits_.allow_near(centre, spacing_) ? Side::in : Side::out;
    }
    const auto [first, second] = halves(t, edge);
    const Side one = sort(first, depth + 1);
    return one != Side::both && one == sort(second, depth + 1) ? one : Side::both;
  }
  void put(const std::array<Vertex, 3>& t, Side side, int depth) {
    if (side == Side::both) {
      int edge = 0;
      longest_edge(t, edge);
      for (const auto& half : halves(t, edge)) put(half, sort(half, depth + 1), depth + 1);
      return;
    }
    if (side == Side::in) {
      const auto first = static_cast<std::uint32_t>(kept_.positions.size());
      for (const Vertex& v : t) kept_.positions.push_back(v.position), kept_.uvs.push_back(v.uv);
      kept_.triangles.push_back({first, first + 1, first + 2});
    } else {
      const auto first = static_cast<std::uint32_t>(cut_off_.positions.size());
      for (const Vertex& v : t) cut_off_.positions.push_back(v.position);
      cut_off_.triangles.push_back({first, first + 1, first + 2});
      const Vec3 n = cross(t[1].position - t[0].position, t[2].position - t[0].position);
      cut_off_.area_m2 += 0.5 * std::sqrt(dot(n, n));
    }
  }

  const AreaLimits& limits_;
  double spacing_;
  SearchMesh& kept_;
  LeftOut& cut_off_;
};

}  // namespace

bool PlanRegion::holds(double x, double y) const {
  bool odd = false;
  for (const Ring& ring : rings)
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const auto &a = ring[i], &b = ring[(i + 1) % ring.size()];
      if ((a[1] > y) != (b[1] > y) && x < a[0] + (b[0] - a[0]) * ((y - a[1]) / (b[1] - a[1]))) odd = !odd;
    }
  return odd;
}

AreaLimits::AreaLimits(const WalkableOptions& options)
    : levels_(options.levels), within_(options.within), without_(options.without) {
  if (levels_ && !((*levels_)[0] <= (*levels_)[1])) {
    std::ostringstream text;
    text << "levels must be two rising heights of ground; they are " << (*levels_)[0] << " and " << (*levels_)[1];
    throw Error(Errc::invalid_argument, text.str());
  }
  check(within_, "to stay within");
  check(without_, "to stay out of");
}

bool AreaLimits::allow_near(const Vec3& p, double margin_m) const {
  if (levels_ && !(p.z >= (*levels_)[0] - margin_m && p.z <= (*levels_)[1] + margin_m)) return false;
  const auto near = [&](const PlanRegion& region) {
    return margin_m > 0 && squared_distance_to_outline(region, p.x, p.y) <= margin_m * margin_m;
  };
  if (!within_.empty() && std::none_of(within_.begin(), within_.end(), [&](const PlanRegion& region) {
        return region.holds(p.x, p.y) || near(region);
      }))
    return false;
  return std::none_of(without_.begin(), without_.end(),
                      [&](const PlanRegion& region) { return region.holds(p.x, p.y) && !near(region); });
}

SearchMesh cut_to_limits(const SearchMesh& mesh, const AreaLimits& limits, double spacing_m, LeftOut& cut_off) {
  SearchMesh kept;
  cut_off.reason = LeftOutReason::limits;
  Cutter cutter(limits, spacing_m, kept, cut_off);
  for (const auto& t : mesh.triangles) {
    std::array<Vertex, 3> corners;
    bool finite = true;
    for (int c = 0; c < 3; ++c) {
      corners[c] = {mesh.positions[t[c]], mesh.uvs[t[c]]};
      const Vec3& p = corners[c].position;
      finite = finite && std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
    }
    if (finite) cutter.cut(corners);
  }
  return kept;
}

}  // namespace vantage
