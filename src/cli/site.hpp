// SPDX-License-Identifier: Apache-2.0
// The site of most commands.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "cli/parse.hpp"
#include "vantage/vantage.hpp"

namespace vantage::cli {

struct Program;

// Options of a site. add() registers it with a command; the object must outlive the parsing.
struct SiteArguments {
  std::string scene;
  SiteOptions given;
  std::optional<std::string> config_file;

  void add(CLI::App& command);
};

// The file of a site, and those beside it.
void take_files(const std::vector<std::string>& files, std::string& first, SceneOptions& scene);

// Applies the layers below the command line to all options of `command`, and opens the site.
Site open_site(CLI::App& command, SiteArguments& arguments);

// The well-known text of its coordinate system; empty if unknown.
std::string crs_text(const Site& site);

// Makes the site's simulator, with a progress line. Throws Stopped.
Simulator& build_simulator(Site& site, Program& program);

}  // namespace vantage::cli
