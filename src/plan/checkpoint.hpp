// SPDX-License-Identifier: Apache-2.0
// What a search needs to go on to the same bits: the state at its last snapshot and the values it has seen since. The
// optimiser asks for the same points again, so those values are told to it in place of evaluations; a batch may be cut
// anywhere.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "vantage/planner.hpp"

namespace vantage {

struct SearchSnapshot {
  std::string optimiser;  // as its save() wrote it; empty: not yet asked
  std::string evaluator;  // as its state() gave it
  std::vector<PlanIteration> history;
  std::uint64_t drawn = 0, redrawn = 0;
};

struct Checkpoint {
  std::string identity;  // lines "name = value" of everything that must match
  SearchSnapshot snapshot;
  std::vector<std::vector<double>> since;  // measures of each network, in the order of asking
  double seconds = 0, trace_seconds = 0;
};

// Where the checkpoint before `file` is kept.
std::filesystem::path checkpoint_before(const std::filesystem::path& file);
// With `keep_before` the file that is there becomes checkpoint_before(file). At any moment one of the two is whole.
// Throws Error io.
void write_checkpoint(const std::filesystem::path& file, const Checkpoint& checkpoint, bool keep_before = false);
// `file` names it in messages. Throws Error malformed_file (damaged, or of another version).
Checkpoint parse_checkpoint(std::string_view bytes, const std::filesystem::path& file);
// Empty where there is no such file. Throws Error: io, malformed_file.
std::optional<Checkpoint> read_checkpoint(const std::filesystem::path& file);

struct FoundCheckpoint {
  Checkpoint checkpoint;
  bool is_before = false;  // the newest is missing or damaged, as `why` says
  std::string why = {};
};
// The newest that is whole; empty where there is none at all. Throws Error: io, malformed_file where both are damaged.
std::optional<FoundCheckpoint> newest_checkpoint(const std::filesystem::path& file);
// Throws Error invalid_argument that lists what differs.
void require_same_run(const std::filesystem::path& file, const std::string& found, const std::string& wanted);

}  // namespace vantage
