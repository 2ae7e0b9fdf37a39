// SPDX-License-Identifier: Apache-2.0
// Why voxels are not captured, as commands ask for it.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "cli/command.hpp"
#include "cli/site.hpp"

namespace vantage::cli {

// The option --missed FILE, of commands that have a network's voxel field.
struct MissedFiles {
  std::vector<std::string> files;

  void add(CLI::App& command);
  // Throws Error invalid_argument for an extension that no writer has.
  void check() const;
};

// Judges the voxels of a field, on large sites a sample of them, and writes each file by its extension: .csv a table by
// node, .ply a cloud, .png or .svg a picture from above. False where it was stopped, and nothing was written.
bool write_missed(std::span<const std::filesystem::path> files, LoadedSite& site, const Simulator& simulator,
                  const VoxelField& field, std::span<const PlacedStation> stations, Program& program);

}  // namespace vantage::cli
