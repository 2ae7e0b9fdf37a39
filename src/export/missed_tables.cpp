// SPDX-License-Identifier: Apache-2.0
#include <string>

#include "core/atomic_file.hpp"
#include "core/text.hpp"
#include "export/csv_cell.hpp"
#include "export/missed_colours.hpp"
#include "export/voxel_ply.hpp"
#include "vantage/error.hpp"
#include "vantage/export.hpp"

namespace vantage {
void write_missed_csv(const std::filesystem::path& file, std::span<const MissedShare> shares) {
  std::string text = "node,voxels";
  for (const MissedStyle& style : kMissedStyles) text += "," + to_string(style.why);
  text += "\n";
  for (const MissedShare& share : shares) {
    text += csv_cell(&share == &shares.front() ? "(all)" : share.node) + "," + number(share.voxels);
    for (const MissedStyle& style : kMissedStyles) text += "," + fixed(share.share(style.why), 4);
    text += "\n";
  }
  write_atomically(file, text);
}

void write_missed_ply(const std::filesystem::path& file, const Simulator& simulator, const MissedVoxels& missed) {
  const auto& [ranks, points, why, shares, candidates] = missed;
  if (ranks.size() != why.size() || ranks.size() != points.size())
    throw Error(Errc::invalid_argument, "write_missed_ply: " + std::to_string(ranks.size()) + " voxels, " +
                                            std::to_string(why.size()) + " reasons and " +
                                            std::to_string(points.size()) + " counts");
  write_voxel_ply(file, simulator, {{"uchar", "why"}, {"uint", "count"}}, ranks.size(),
                  [&](std::uint64_t k, std::string& bytes) {
                    append(bytes, static_cast<std::uint8_t>(why[k]));
                    append(bytes, points[k]);
                    return VoxelVertex{ranks[k], missed_style(why[k]).colour};
                  });
}

}  // namespace vantage
