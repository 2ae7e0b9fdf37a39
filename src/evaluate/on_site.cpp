// SPDX-License-Identifier: Apache-2.0
// The order of a round: nearest neighbour, then 2-opt (Croes: A Method for Solving Traveling-Salesman Problems, 1958)
// and Or-opt (Or: Traveling Salesman-Type Combinatorial Problems, 1976).
#include "vantage/on_site.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "core/parallel.hpp"
#include "core/parse.hpp"
#include "core/setting_list.hpp"
#include "core/site_reach.hpp"
#include "evaluate/ways.hpp"
#include "vantage/error.hpp"

namespace vantage {
namespace {

// Heights over the ground at which nothing may be in a person's way.
constexpr double kHip_m = 1.0, kKnee_m = 0.4;

void check(const OnSiteOptions& options, const Vec3& origin) {
  check_settings(on_site_settings(), options);
  check_number(options.detour, "detour", {.low = 1, .high = 1000});
  if (options.entrance) require_in_reach(*options.entrance, origin, "the entrance is");
}

// A closed round over the points of a matrix, beginning at point 0.
class Round {
 public:
  explicit Round(const std::vector<std::vector<double>>& metres) : metres_(metres) {}

  std::vector<std::size_t> order() {
    const std::size_t n = metres_.size();
    std::vector<bool> seen(n, false);
    order_.assign(1, 0);
    seen[0] = true;
    while (order_.size() < n) {
      std::size_t next = n;
      for (std::size_t k = 0; k < n; ++k)
        if (!seen[k] && (next == n || metres_[order_.back()][k] < metres_[order_.back()][next])) next = k;
      seen[next] = true;
      order_.push_back(next);
    }
    while (turn_round() || move_elsewhere()) {
    }
    return order_;
  }

 private:
  // Whether a change gains more than rounding: else the search would not end.
  static bool shorter(double then, double now) {
    constexpr double kGain_m = 1e-9, kGain = 1e-12;
    return then + kGain_m + kGain * now < now;
  }

  double leg(std::size_t at) const { return metres_[order_[at % order_.size()]][order_[(at + 1) % order_.size()]]; }

  bool turn_round() {
    const std::size_t n = order_.size();
    for (std::size_t i = 0; i + 2 < n; ++i) {
      for (std::size_t j = i + 2; j < n; ++j) {
        const double now = leg(i) + leg(j);
        const double then = metres_[order_[i]][order_[j]] + metres_[order_[i + 1]][order_[(j + 1) % n]];
        if (!shorter(then, now)) continue;
        std::reverse(order_.begin() + static_cast<std::ptrdiff_t>(i) + 1,
                     order_.begin() + static_cast<std::ptrdiff_t>(j) + 1);
        return true;
      }
    }
    return false;
  }

  bool move_elsewhere() {
    const std::size_t n = order_.size();
    for (std::size_t count = 1; count <= 3 && count + 1 < n; ++count) {
      for (std::size_t from = 1; from + count <= n; ++from) {
        const std::size_t left = n - count;  // stops without those that move
        const auto rest = [&](std::size_t at) {
          at %= left;
          return order_[at < from ? at : at + count];
        };
        const std::size_t before = order_[from - 1], first = order_[from], last = order_[from + count - 1],
                          after = order_[(from + count) % n];
        const double taken = metres_[before][first] + metres_[last][after];
        for (std::size_t to = 1; to <= left; ++to) {
          const std::size_t a = rest(to - 1), b = rest(to);
          if (!shorter(metres_[a][first] + metres_[last][b] + metres_[before][after], taken + metres_[a][b])) continue;
          const auto begin = order_.begin();
          const auto at = [&](std::size_t k) { return begin + static_cast<std::ptrdiff_t>(k); };
          if (to < from)
            std::rotate(at(to), at(from), at(from + count));
          else
            std::rotate(at(from), at(from + count), at(to + count));
          return true;
        }
      }
    }
    return false;
  }

  const std::vector<std::vector<double>>& metres_;
  std::vector<std::size_t> order_;
};

}  // namespace

struct OnSite::Impl {
  Impl(const SearchArea& area, const ClashChecker& clash, const OnSiteOptions& o, std::vector<double> scans,
       const Vec3& centre)
      : options(o),
        origin(centre),
        scan_min(std::move(scans)),
        ways(area.mesh(), [clash](const Vec3& a, const Vec3& b) {
          const Vec3 hip{0, 0, kHip_m}, knee{0, 0, kKnee_m};
          return clash.sees(a + hip, b + hip) && clash.sees(a + knee, b + knee);
        }) {}
  OnSiteOptions options;
  Vec3 origin;                   // of the scene
  std::vector<double> scan_min;  // by scanner
  Ways ways;
};

OnSite::OnSite(const SearchArea& area, const ClashChecker& clash, std::span<const Scanner> scanners,
               const OnSiteOptions& options, const Vec3& origin) {
  check(options, origin);
  if (scanners.empty()) throw Error(Errc::invalid_argument, "on site: no scanner given");
  std::vector<double> scan_min;
  for (const Scanner& scanner : scanners)
    scan_min.push_back(static_cast<double>(scanner.rays()) / scanner.points_per_second / 60);
  impl_ = std::make_shared<const Impl>(area, clash, options, std::move(scan_min), origin);
}

std::optional<double> OnSite::way_m(const Vec3& from, const Vec3& to) const {
  for (const Vec3& end : {from, to}) require_in_reach(end, impl_->origin, "the end of a way is");
  return impl_->ways.between(from, to);
}
double OnSite::minutes_per_scan(std::uint32_t scanner) const { return impl_->scan_min.at(scanner); }
const OnSiteOptions& OnSite::options() const noexcept { return impl_->options; }

Visit OnSite::visit(std::span<const PlacedStation> stations) const {
  Visit visit;
  std::vector<Vec3> stops;
  std::vector<std::size_t> station_of;
  const OnSiteOptions& options = impl_->options;
  if (options.entrance) stops.push_back(*options.entrance);
  for (std::size_t i = 0; i < stations.size(); ++i) {
    if (!active(stations[i])) continue;
    require_in_reach(stations[i].ground, impl_->origin, "station " + std::to_string(i + 1) + " stands");
    stops.push_back(stations[i].ground);
    station_of.push_back(i);
  }
  if (station_of.empty()) return visit;
  const std::size_t n = stops.size();
  std::vector<std::vector<double>> metres(n, std::vector<double>(n, 0));
  std::vector<std::vector<bool>> connected(n, std::vector<bool>(n, true));
  const auto ways = impl_->ways.between_all(stops);
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = i + 1; j < n; ++j) {
      const Vec3 apart = stops[j] - stops[i];
      const std::optional<double>& way = ways[i][j];
      metres[i][j] = metres[j][i] = way ? *way : options.detour * std::sqrt(dot(apart, apart));
      connected[i][j] = connected[j][i] = way.has_value();
    }
  }
  const std::vector<std::size_t> round = Round(metres).order();
  const std::size_t first = options.entrance ? 1 : 0;
  for (std::size_t k = first; k < n; ++k) visit.order.push_back(station_of[round[k] - first]);
  if (!options.entrance) visit.legs_m.push_back(0), visit.paths.emplace_back();
  std::vector<std::vector<Vec3>> paths(n);
  parallel::for_all(std::size_t{0}, n,
                    [&](std::size_t k) { paths[k] = impl_->ways.path(stops[round[k]], stops[round[(k + 1) % n]]); });
  for (std::size_t k = 0; k < n; ++k) {
    const std::size_t a = round[k], b = round[(k + 1) % n];
    visit.legs_m.push_back(metres[a][b]);
    visit.paths.push_back(std::move(paths[k]));
    visit.walk_m += metres[a][b];
    if (!connected[a][b]) ++visit.unconnected;
  }
  const auto count = static_cast<double>(station_of.size());
  // Sums by scanner, so that equal stations make a product, without rounding of a sum.
  std::vector<double> scans(impl_->scan_min.size());
  for (const std::size_t i : station_of) scans.at(stations[i].setup.scanner) += 1;
  for (std::size_t k = 0; k < scans.size(); ++k) visit.scan_min += scans[k] * impl_->scan_min[k];
  visit.set_up_min = count * options.set_up_min;
  visit.photos_min = count * options.photos_min;
  visit.walk_min = visit.walk_m / options.walking_m_per_s / 60;
  visit.minutes = visit.scan_min + visit.set_up_min + visit.photos_min + visit.walk_min;
  return visit;
}

}  // namespace vantage
