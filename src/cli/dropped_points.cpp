// SPDX-License-Identifier: Apache-2.0
#include "cli/dropped_points.hpp"

#include <fmt/format.h>

#include <numeric>

namespace vantage::cli {

nlohmann::json dropped_json(const DroppedPoints& dropped) {
  return {{"points", dropped.points},
          {"incidence", dropped.incidence},
          {"footprint", dropped.footprint},
          {"noise", dropped.noise},
          {"echo", dropped.echo}};
}

std::string dropped_text(const NetworkCounts& counts) {
  const DroppedPoints dropped = std::accumulate(counts.dropped.begin(), counts.dropped.end(), DroppedPoints{});
  const std::uint64_t counted =
      std::accumulate(counts.points_on_surveyed.begin(), counts.points_on_surveyed.end(), std::uint64_t{0});
  const auto all = static_cast<double>(counted + dropped.points);
  const auto percent = [&](std::uint64_t n) { return all > 0 ? 100 * static_cast<double>(n) / all : 0.0; };
  return fmt::format(
      "dropped  {:.1f} % of the points: incidence {:.1f} %, footprint {:.1f} %, noise {:.1f} %, no echo {:.1f} %",
      percent(dropped.points), percent(dropped.incidence), percent(dropped.footprint), percent(dropped.noise),
      percent(dropped.echo));
}

}  // namespace vantage::cli
