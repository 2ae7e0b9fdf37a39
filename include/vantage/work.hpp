// SPDX-License-Identifier: Apache-2.0
/// The cost of a computation, in numbers that neither the machine nor its load changes.
#pragma once

#include <cstdint>

namespace vantage {

/// Work that was done. Equal calls on equal inputs do equal work on one engine, whatever the number of threads, unless
/// a time limit or a stop ended them.
struct Work {
  std::uint64_t networks = 0;          ///< Networks counted with every ray.
  std::uint64_t rays = 0;              ///< Rays traced for them.
  std::uint64_t sampled_networks = 0;  ///< Networks counted on a sample of the voxels; candidates are networks of one.
  std::uint64_t sampled_voxels = 0;    ///< Voxels counted for them, each network's own.
  std::uint64_t sampled_rays = 0;      ///< Rays traced for them; on a GPU, whose threads end in any order, to 0.1 %.
  std::uint64_t planes = 0;            ///< Voxels whose plane was made, for registration.
  std::uint64_t choice_steps = 0;      ///< Stations that joined or left a network while stations were chosen.
  std::uint64_t uploaded_bytes = 0;    ///< Bytes copied to devices' own memory; 0 on processors.

  friend bool operator==(const Work&, const Work&) = default;
  /// Calls visit(name, member) for each number, in the order above; names are those of JSON.
  template <class Visit>
  static void for_each(const Visit& visit) {
    visit("networks", &Work::networks), visit("rays", &Work::rays);
    visit("sampled_networks", &Work::sampled_networks), visit("sampled_voxels", &Work::sampled_voxels);
    visit("sampled_rays", &Work::sampled_rays), visit("planes", &Work::planes);
    visit("choice_steps", &Work::choice_steps), visit("uploaded_bytes", &Work::uploaded_bytes);
  }
  /// Sums of both, member by member.
  friend Work operator+(Work a, const Work& b) {
    for_each([&](const char*, auto member) { a.*member += b.*member; });
    return a;
  }
  /// REQUIRES: `b` is part of `a`.
  friend Work operator-(Work a, const Work& b) {
    for_each([&](const char*, auto member) { a.*member -= b.*member; });
    return a;
  }
};

}  // namespace vantage
