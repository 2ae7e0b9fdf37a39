// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <string>
#include <vector>

#include "core/text.hpp"
#include "export/missed_colours.hpp"
#include "export/voxel_map.hpp"
#include "vantage/error.hpp"
#include "vantage/export.hpp"

namespace vantage {

void draw_missed(const std::filesystem::path& file, Site& site, const MissedVoxels& missed,
                 std::span<const PlacedStation> stations, const std::string& title) {
  const std::vector<std::uint32_t>& ranks = missed.ranks;
  const std::vector<WhyMissed>& why = missed.why;
  if (ranks.size() != why.size() || ranks.empty())
    throw Error(Errc::invalid_argument, "draw_missed: " + std::to_string(ranks.size()) + " voxels and " +
                                            std::to_string(why.size()) + " reasons");
  std::vector<ColouredVoxel> voxels;
  std::array<std::size_t, why_missed_count> count{};
  for (const MissedStyle& style : kMissedStyles) {
    for (std::size_t i = 0; i < ranks.size(); ++i) {
      if (why[i] != style.why) continue;
      ++count[static_cast<std::size_t>(style.why)];
      voxels.push_back({ranks[i], style.colour});
    }
  }
  const auto legend = [&](Canvas& canvas, Point at) {
    for (const MissedStyle& style : kMissedStyles) {
      canvas.fill({at.x, at.y - 7, 24, 14}, style.colour);
      const double percent =
          100 * static_cast<double>(count[static_cast<std::size_t>(style.why)]) / static_cast<double>(ranks.size());
      canvas.text({at.x + 34, at.y}, std::string(style.words) + ", " + fixed(percent, 1) + " %", {.size = 12.5});
      at.y += 24;
    }
    return at;
  };
  draw_voxel_map(file, site, voxels, stations, title, "Surveyed surfaces from above", legend);
}

}  // namespace vantage
