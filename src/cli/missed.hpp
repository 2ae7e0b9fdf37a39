// SPDX-License-Identifier: Apache-2.0
// The option --missed, shared by commands.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "cli/command.hpp"
#include "cli/site.hpp"

namespace vantage::cli {

// Files of --missed, for commands that have a network's voxel field.
struct MissedFiles {
  std::vector<std::string> files;

  void add(CLI::App& command);
  // Throws Error invalid_argument for an unknown extension.
  void check() const;
  bool with_elements() const;  // whether a file is of elements
};

// Logs what is captured, and why the rest is not.
void tell_missed(const MissedVoxels& judged);

// `missed_voxels()` with progress and a line of results. Empty if stopped, or if nothing is surveyed.
std::optional<MissedVoxels> judge_missed(Site& site, const VoxelField& field, Program& program);

// Writes each file by its extension: .csv a table by node, .ply a cloud, .png or .svg a picture in plan view, .bcf the
// topics of `write_missed_bcf()`, for which alone `elements` are needed.
void write_missed(std::span<const std::filesystem::path> files, const MissedVoxels& judged, Site& site,
                  std::span<const PlacedStation> stations, std::span<const ElementShare> elements, PlyCoordinates ply);

}  // namespace vantage::cli
