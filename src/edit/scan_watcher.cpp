// SPDX-License-Identifier: Apache-2.0
#include "edit/scan_watcher.hpp"

#include <algorithm>
#include <condition_variable>
#include <exception>
#include <iterator>
#include <mutex>
#include <utility>

#include "core/text.hpp"

namespace vantage {

namespace fs = std::filesystem;

std::vector<fs::path> ScanFolder::fresh() {
  std::vector<fs::path> ready;
  std::error_code failure;
  for (fs::directory_iterator entry(folder_, failure), end; !failure && entry != end; entry.increment(failure)) {
    const fs::path& file = entry->path();
    const std::string ending = lower_case(file.extension().string());
    if (ending != ".e57" && ending != ".ptx") continue;
    std::error_code gone;
    const Look now{fs::file_size(file, gone), fs::last_write_time(file, gone)};
    if (gone) continue;
    const auto [look, is_new] = looks_.try_emplace(file, now);
    if (!is_new && look->second.bytes == now.bytes && look->second.written == now.written) {
      if (!std::exchange(look->second.returned, true)) ready.push_back(file);
    } else {
      look->second = now;
    }
  }
  std::ranges::sort(ready);
  return ready;
}

ScanWatcher::ScanWatcher(EditSession& session, Site& site, const fs::path& folder, double tolerance_m,
                         std::chrono::milliseconds between)
    : session_(session), site_(site), folder_(folder), tolerance_m_(tolerance_m) {
  thread_ = std::jthread([this, between](const std::stop_token& stop) {
    std::mutex mutex;
    std::condition_variable_any woken;
    while (!stop.stop_requested()) {
      look(stop);
      std::unique_lock lock(mutex);
      woken.wait_for(lock, stop, between, [] { return false; });
    }
  });
}

void ScanWatcher::look(const std::stop_token& stop) {
  for (const fs::path& file : folder_.fresh()) {
    if (stop.stop_requested()) return;
    try {
      session_.tell("reading " + file.filename().string());
      std::vector<TakenScan> scans = read_taken_scans(file, 0.02, {.stop = stop});
      if (stop.stop_requested()) return;
      if (!fit_to_model(site_, scans, tolerance_m_, {.stop = stop})) return;
      waiting_.insert(waiting_.end(), std::move_iterator(scans.begin()), std::move_iterator(scans.end()));
    } catch (const std::exception& error) {
      session_.tell(error.what());
    }
  }
  if (!waiting_.empty() && session_.take(waiting_)) waiting_.clear();
}

}  // namespace vantage
