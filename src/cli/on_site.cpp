// SPDX-License-Identifier: Apache-2.0
#include "cli/on_site.hpp"

#include <spdlog/fmt/fmt.h>

#include "cli/options.hpp"
#include "cli/parse.hpp"

namespace vantage::cli {

void OnSiteCliOptions::add(CLI::App& command, const std::string& group) {
  const OnSiteOptions usual;
  add_number(command, "--set-up", "MIN",
             fmt::format("Minutes at each station besides the scan itself; {} otherwise", usual.set_up_min), set_up_min,
             not_negative)
      ->group(group);
  add_number(command, "--walking", "M/S",
             fmt::format("How fast one walks with the scanner; {} m/s otherwise", usual.walking_m_per_s),
             walking_m_per_s, positive)
      ->group(group);
}

OnSiteOptions OnSiteCliOptions::settle(const LoadedSite& site) const {
  OnSiteOptions options;
  if (set_up_min) options.set_up_min = *set_up_min;
  if (walking_m_per_s) options.walking_m_per_s = *walking_m_per_s;
  options.entrance = site.walkable.enter;
  return options;
}

}  // namespace vantage::cli
