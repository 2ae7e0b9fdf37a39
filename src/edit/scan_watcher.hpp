// SPDX-License-Identifier: Apache-2.0
// Scans that come into a folder while the editor runs.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <thread>
#include <vector>

#include "edit/session.hpp"

namespace vantage {

// Files of scans of a folder. A scanner, or a copy from its card, writes a file for minutes.
class ScanFolder {
 public:
  explicit ScanFolder(std::filesystem::path folder) : folder_(std::move(folder)) {}

  // Files that are new or have changed since they were last returned, and had the same size and time at the last look.
  // A folder that is not there has none.
  std::vector<std::filesystem::path> fresh();

 private:
  struct Look {
    std::uintmax_t bytes = 0;
    std::filesystem::file_time_type written = {};
    bool returned = false;
  };
  std::filesystem::path folder_;
  std::map<std::filesystem::path, Look> looks_;
};

// Reads scans of a folder as they arrive, fits them to the site's model, and gives them to the session. Reports
// unreadable files there, and reads them again after a change.
class ScanWatcher {
 public:
  ScanWatcher(EditSession& session, Site& site, const std::filesystem::path& folder, double tolerance_m,
              std::chrono::milliseconds between = std::chrono::seconds(2));

 private:
  void look(const std::stop_token& stop);

  EditSession& session_;
  Site& site_;
  ScanFolder folder_;
  double tolerance_m_;
  std::vector<TakenScan> waiting_;  // until the session has time
  std::jthread thread_;
};

}  // namespace vantage
