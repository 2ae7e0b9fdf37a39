// SPDX-License-Identifier: Apache-2.0
// Sites that nobody designed, from a seed: buildings, halls and tunnels, with the truth about them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "sites/site.hpp"

namespace vantage::test {

struct RandomSite {
  KnownSite site;                          // every room is one of its places
  Variant variant;                         // form of the file: unit, axis, origin, names
  std::set<std::string> shut;              // rooms that no path leads to
  std::vector<Part> leaves;                // of doors, closed in the file and open in truth
  std::map<std::string, Part> drawn = {};  // by the name of a part: its replacement in the file, such as bars
  bool named = false;                      // never written without names
  bool turned = false;                     // sheets whose normals point away from the room
  std::string told;                        // in words, for messages
};

// Seeds from here on are of the strange kinds in turn (strange_sites.hpp).
inline constexpr std::uint64_t kFirstStrange = 1000;
// The same seed gives the same site.
RandomSite make_random_site(std::uint64_t seed);
// Writes a GLB without roles, with its leaves. Sheets may be turned in the file; the truth keeps them upward.
void write_site(const RandomSite& random, const std::filesystem::path& file);

}  // namespace vantage::test
