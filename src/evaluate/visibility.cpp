// SPDX-License-Identifier: Apache-2.0
#include "evaluate/visibility.hpp"

#include "vantage/measure.hpp"

namespace vantage {

std::size_t visibility_parts(const std::function<bool(const Vec3&, const Vec3&)>& sees, double range_m,
                             const Network& network) {
  PairMatrix seen(network.size());
  for (std::size_t i = 0; i < network.size(); ++i) {
    for (std::size_t j = i + 1; j < network.size(); ++j) {
      if (!network[i].active || !network[j].active) continue;
      const Vec3 &a = network[i].position, &b = network[j].position;
      if (dot(a - b, a - b) <= range_m * range_m && sees(a, b)) seen.set(i, j, 1);
    }
  }
  return connectivity(seen, 1).parts;
}

}  // namespace vantage
