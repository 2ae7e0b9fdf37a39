// SPDX-License-Identifier: Apache-2.0
// State from which a search continues to the same bits: its last snapshot and the values since. The optimiser asks for
// the same points again and gets those values in place of evaluations, so a batch may be cut anywhere.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "vantage/problem.hpp"

namespace vantage {

struct SearchSnapshot {
  std::string optimiser;  // from its save(); empty: not yet asked
  std::string evaluator;  // from its state()
  std::vector<PlanIteration> history;
  std::uint64_t drawn = 0, redrawn = 0;
};

struct Checkpoint {
  std::string identity;  // lines "name = value" of everything that must match
  SearchSnapshot snapshot;
  std::vector<std::vector<double>> since;  // measures of each network, in the order of asking
  double seconds = 0, trace_seconds = 0;
};

// Path of the checkpoint before `file`.
std::filesystem::path checkpoint_before(const std::filesystem::path& file);
// With `keep_before` the existing file becomes checkpoint_before(file). At any moment one of the two is whole. Throws
// Error io.
void write_checkpoint(const std::filesystem::path& file, const Checkpoint& checkpoint, bool keep_before = false);
// `file` names it in messages. Throws Error malformed_file (damaged, or of another version).
Checkpoint parse_checkpoint(std::string_view bytes, const std::filesystem::path& file);
// Empty if there is no such file. Throws Error: io, malformed_file.
std::optional<Checkpoint> read_checkpoint(const std::filesystem::path& file);

struct FoundCheckpoint {
  Checkpoint checkpoint;
  bool is_before = false;  // the newest is missing or damaged, as `why` says
  std::string why = {};
};
// The newest whole one; empty if there is none at all. Throws Error: io, malformed_file if both are damaged.
std::optional<FoundCheckpoint> newest_checkpoint(const std::filesystem::path& file);
// Throws Error invalid_argument that lists the differences.
void require_same_run(const std::filesystem::path& file, const std::string& found, const std::string& wanted);

}  // namespace vantage
