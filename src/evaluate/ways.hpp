// SPDX-License-Identifier: Apache-2.0
// Shortest paths over a search area, on a graph of evenly spread places.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

#include "vantage/on_site.hpp"
#include "vantage/placement.hpp"

namespace vantage {

class Ways {
 public:
  // `sees`: whether a person can go straight from one ground point to the other. It is kept.
  Ways(const SearchMesh& ground, std::function<bool(const Vec3&, const Vec3&)> sees);

  // Metres along the graph; empty if it does not connect them, or has no place near one of them.
  std::optional<double> between(const Vec3& from, const Vec3& to) const;
  // The same for all pairs of points, in parallel: of points i < j the element [i][j].
  std::vector<std::vector<std::optional<double>>> between_all(std::span<const Vec3> points) const;
  // True if the way between two of `points` is longer than this, for each in parallel; 0 if none connects them.
  std::vector<std::uint8_t> longer(std::span<const Vec3> points, std::span<const OnSite::Way> than) const;
  // The ground that such a way leads over, from `from` to `to`, without points on straight stretches; the straight line
  // where there is none.
  std::vector<Vec3> path(const Vec3& from, const Vec3& to) const;
  double spacing_m() const { return spacing_; }
  std::size_t places() const { return places_.size(); }

 private:
  struct Link {
    std::uint32_t to;
    float metres;
  };
  std::optional<std::uint32_t> nearest(const Vec3& ground) const;
  using DistancesFrom = std::function<std::shared_ptr<const std::vector<float>>(std::uint32_t place)>;
  // The distance goes by the places nearest to both.
  std::optional<double> between(const Vec3& from, const Vec3& to, std::optional<std::uint32_t> a,
                                std::optional<std::uint32_t> b, const DistancesFrom& distances_from) const;
  std::shared_ptr<const std::vector<float>> distances_from(std::uint32_t place) const;
  // Infinity for places that are farther than `most_m`.
  std::vector<float> distances_within(std::uint32_t place, double most_m) const;

  std::vector<std::pair<std::uint32_t, std::uint32_t>> gaps(
      const std::vector<std::pair<std::int64_t, std::int64_t>>& cell_of) const;

  std::function<bool(const Vec3&, const Vec3&)> sees_;
  double spacing_ = 1;
  std::vector<Vec3> places_;
  std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> cells_;
  std::vector<std::vector<Link>> links_;
  std::vector<std::size_t> part_;  // by place: connected ones have the same
  // Cache of places asked for before, limited in size: networks of a search share stations.
  mutable std::mutex mutex_;
  mutable std::unordered_map<std::uint32_t, std::shared_ptr<const std::vector<float>>> known_;
};

}  // namespace vantage
