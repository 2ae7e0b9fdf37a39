// SPDX-License-Identifier: Apache-2.0
// Output of the program: logs and progress on standard error, results on standard output.
#pragma once

#include <spdlog/spdlog.h>

#include <chrono>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>

namespace vantage::cli {

// Escapes characters that control a terminal or change the order of others as \u, as in JSON, since names come from
// other people's scenes. Line ends and tabs stay.
std::string printable(std::string_view text);

class TerminalSink;

// Owner of the standard logger. Log through spdlog::info and the like; the progress line stays clear of them.
class Console {
 public:
  Console();
  ~Console();
  Console(const Console&) = delete;
  Console& operator=(const Console&) = delete;

  bool interactive() const;                  // standard error is a terminal
  void set_status(const std::string& line);  // the last line of a terminal; empty: none
  void print(const std::string& text);       // standard output, printable; throws Error io if that is closed or full
  void print(const nlohmann::json& object);

 private:
  std::shared_ptr<TerminalSink> sink_;
};

// A bar with the time left on a terminal, occasional lines elsewhere.
class ProgressLine {
 public:
  ProgressLine(Console& console, std::string label);
  ~ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  // `done` in [0, 1], or nothing where it is not known; `seconds_left` < 0: estimated from the elapsed time. `note`
  // follows the numbers.
  void update(std::optional<double> done, const std::string& note = {}, double seconds_left = -1);
  // Times start anew with another label.
  void set_label(const std::string& label) {
    if (label != label_) label_ = label, start_ = Clock::now();
  }

 private:
  using Clock = std::chrono::steady_clock;
  Console& console_;
  std::string label_;
  Clock::time_point start_, last_;
};

// "42 s", "3.5 min", "2.1 h"
std::string duration_text(double seconds);

}  // namespace vantage::cli
