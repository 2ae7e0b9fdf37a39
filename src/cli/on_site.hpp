// SPDX-License-Identifier: Apache-2.0
// What a crew takes on site, from options.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>

#include "cli/site.hpp"

namespace vantage::cli {

struct OnSiteCliOptions {
  std::optional<double> set_up_min, walking_m_per_s;

  void add(CLI::App& command, const std::string& group);
  // Rounds begin and end where one comes in.
  OnSiteOptions settle(const LoadedSite& site) const;
};

}  // namespace vantage::cli
