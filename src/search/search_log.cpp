// SPDX-License-Identifier: Apache-2.0
#include "search/search_log.hpp"

#include <algorithm>
#include <utility>

#include "core/atomic_file.hpp"
#include "core/seconds_since.hpp"
#include "vantage/error.hpp"

namespace vantage {

SearchLog::SearchLog(const PlanConfig& config, std::string identity, Warn warn)
    : config_(config), identity_(std::move(identity)), warn_(std::move(warn)) {}

std::optional<SearchSnapshot> SearchLog::resume() {
  if (!has_file()) return std::nullopt;
  AtomicFile::remove_leftovers(config_.checkpoint);
  if (!config_.resume) return std::nullopt;
  std::optional<FoundCheckpoint> found = newest_checkpoint(config_.checkpoint);
  if (!found) return std::nullopt;
  const auto file = found->is_before ? checkpoint_before(config_.checkpoint) : config_.checkpoint;
  if (found->is_before && warn_) warn_(found->why + "; going on from the one before, " + file.string());
  newest_is_ours_ = !found->is_before;
  Checkpoint& checkpoint = found->checkpoint;
  require_same_run(file, checkpoint.identity, identity_);
  replay_ = std::move(checkpoint.since);
  earlier_seconds_ = checkpoint.seconds, earlier_trace_seconds_ = checkpoint.trace_seconds;
  snapshot_ = std::move(checkpoint.snapshot);
  return snapshot_;
}

SearchLog::Values SearchLog::replay(std::size_t most) {
  const auto first = replay_.begin() + static_cast<std::ptrdiff_t>(replayed_);
  const std::size_t count = std::min(most, replay_.size() - replayed_);
  Values values(first, first + static_cast<std::ptrdiff_t>(count));
  replayed_ += count;
  add(values);
  return values;
}

void SearchLog::add(const Values& values) { since_.insert(since_.end(), values.begin(), values.end()); }

void SearchLog::take(SearchSnapshot snapshot) {
  snapshot_ = std::move(snapshot);
  since_.clear();
}

bool SearchLog::due() const { return has_file() && seconds_since(saved_) >= config_.checkpoint_seconds; }

void SearchLog::save(double trace_seconds) {
  if (!has_file()) return;
  // A run that stops during its replay must keep the values not yet replayed.
  Values since = since_;
  since.insert(since.end(), replay_.begin() + static_cast<std::ptrdiff_t>(replayed_), replay_.end());
  saved_ = Clock::now();
  try {
    write_checkpoint(config_.checkpoint,
                     {.identity = identity_,
                      .snapshot = snapshot_,
                      .since = std::move(since),
                      .seconds = seconds(),
                      .trace_seconds = earlier_trace_seconds_ + trace_seconds},
                     newest_is_ours_);
    newest_is_ours_ = true;
  } catch (const Error& error) {
    if (!warn_) throw;
    warn_(std::string(error.what()) + "; the search goes on without it");
  }
}

double SearchLog::seconds() const { return earlier_seconds_ + seconds_since(start_); }

}  // namespace vantage
