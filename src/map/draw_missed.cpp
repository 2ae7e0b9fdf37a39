// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <string>
#include <vector>

#include "core/text.hpp"
#include "map/missed_colours.hpp"
#include "map/voxel_map.hpp"
#include "vantage/error.hpp"
#include "vantage/pictures.hpp"

namespace vantage {

void draw_missed(const std::filesystem::path& file, Site& site, const MissedVoxels& missed,
                 std::span<const PlacedStation> stations, const std::string& title) {
  if (missed.voxels.empty()) throw Error(Errc::invalid_argument, "draw_missed: no voxel was judged");
  std::vector<ColouredVoxel> voxels;
  const auto add = [&](const MissedStyle& style) {
    for (std::size_t i = 0; i < missed.voxels.size(); ++i)
      if (missed.status[i].why == style.why) voxels.push_back({missed.voxels[i], style.colour});
  };
  // Most hidden voxels are undersides, of slabs whose upper sides are captured.
  add(missed_style(WhyMissed::hidden));
  for (const MissedStyle& style : kMissedStyles)
    if (style.why != WhyMissed::hidden) add(style);
  constexpr double kWords = 34;  // right of a colour
  constexpr TextStyle kText{.size = 12.5};
  const auto words = [&](const MissedStyle& style) {
    return std::string(style.words) + ", " + fixed(100 * missed.shares.front().share(style.why), 1) + " %";
  };
  const auto legend = [&](Canvas& canvas, Point at) {
    for (const MissedStyle& style : kMissedStyles) {
      canvas.fill({at.x, at.y - 7, 24, 14}, style.colour);
      canvas.text({at.x + kWords, at.y}, words(style), kText);
      at.y += 24;
    }
    return at;
  };
  double width = 0;
  for (const MissedStyle& style : kMissedStyles)
    width = std::max(width, kWords + Canvas(1, 1).text_width(words(style), kText));
  draw_voxel_map(file, site, voxels, stations, title, "Surveyed surfaces from above", width, legend);
}

}  // namespace vantage
