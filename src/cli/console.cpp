// SPDX-License-Identifier: Apache-2.0
#include "cli/console.hpp"

#include <spdlog/sinks/base_sink.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <mutex>
#include <system_error>
#include <utility>

#include "core/json_text.hpp"
#include "vantage/error.hpp"

namespace vantage::cli {

std::string printable(std::string_view text) {
  std::string out;
  // Length in bytes of a UTF-8 character at `k` that moves the cursor or changes the order of others, and its code.
  const auto control = [&](std::size_t k) -> std::pair<std::size_t, unsigned> {
    const auto byte = [&](std::size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0u; };
    const unsigned a = byte(k), b = byte(k + 1), c = byte(k + 2);
    if ((a < 0x20 && a != '\n' && a != '\t') || a == 0x7f) return {1, a};
    if (a == 0xc2 && b >= 0x80 && b < 0xa0) return {2, b};
    const unsigned code = 0x2000 + ((b & 0x3f) << 6) + (c & 0x3f);
    const bool turns = (code >= 0x202a && code <= 0x202e) || (code >= 0x2066 && code <= 0x2069);
    return a == 0xe2 && turns ? std::pair{std::size_t{3}, code} : std::pair{std::size_t{0}, 0u};
  };
  for (std::size_t k = 0; k < text.size();) {
    const auto [bytes, code] = control(k);
    if (bytes > 0)
      out += fmt::format("\\u{:04x}", code);
    else
      out += text[k];
    k += std::max<std::size_t>(bytes, 1);
  }
  return out;
}

// Log lines go above the status line, which is drawn again below them.
class TerminalSink : public spdlog::sinks::base_sink<std::mutex> {
 public:
  const bool interactive = isatty(STDERR_FILENO) == 1;

  void set_status(const std::string& line) {
    const std::scoped_lock lock(mutex_);
    if (!interactive || line == status_) return;
    // A wrapped line could not be erased.
    winsize window{};
    const bool known = ioctl(STDERR_FILENO, TIOCGWINSZ, &window) == 0 && window.ws_col > 1;
    status_ = known ? line.substr(0, window.ws_col - 1u) : line;
    write("\r\033[K" + status_);
  }

 protected:
  void sink_it_(const spdlog::details::log_msg& message) override {
    const char* kind = message.level >= spdlog::level::err    ? "error: "
                       : message.level == spdlog::level::warn ? "warning: "
                                                              : "";
    std::string line = "vantage: " + (kind + printable({message.payload.data(), message.payload.size()})) + "\n";
    if (!status_.empty()) line = "\r\033[K" + line + status_;
    write(line);
  }
  void flush_() override { std::fflush(stderr); }

 private:
  static void write(const std::string& text) {
    std::fwrite(text.data(), 1, text.size(), stderr);
    std::fflush(stderr);
  }
  std::string status_;
};

Console::Console() : sink_(std::make_shared<TerminalSink>()) {
  spdlog::set_default_logger(std::make_shared<spdlog::logger>("vantage", sink_));
}

Console::~Console() { set_status(""); }

bool Console::interactive() const { return sink_->interactive; }

void Console::set_status(const std::string& line) { sink_->set_status(printable(line)); }

void Console::print(const std::string& what) {
  const std::string text = printable(what);
  if (std::fwrite(text.data(), 1, text.size(), stdout) == text.size() && std::fflush(stdout) == 0) return;
  if (errno == EPIPE) return;  // the reader has had enough, as `head` does
  throw Error(Errc::io, "cannot write to standard output: " + std::generic_category().message(errno));
}

void Console::print(const nlohmann::json& object) { print(json_text(object, 2) + "\n"); }

std::string duration_text(double seconds) {
  char text[32];
  if (seconds < 99.5)
    std::snprintf(text, sizeof text, "%.0f s", seconds);
  else if (seconds < 99.5 * 60)
    std::snprintf(text, sizeof text, "%.1f min", seconds / 60);
  else
    std::snprintf(text, sizeof text, "%.1f h", seconds / 3600);
  return text;
}

ProgressLine::ProgressLine(Console& console, std::string label)
    : console_(console), label_(std::move(label)), start_(Clock::now()), last_(start_) {}

ProgressLine::~ProgressLine() { console_.set_status(""); }

void ProgressLine::update(std::optional<double> done, const std::string& note, double seconds_left) {
  constexpr std::chrono::duration<double> kRedrawEvery{0.1}, kLineEvery{10};
  const auto now = Clock::now();
  if (now - last_ < (console_.interactive() ? kRedrawEvery : kLineEvery)) return;
  last_ = now;
  const double elapsed = std::chrono::duration<double>(now - start_).count();
  std::string text = label_;
  if (done) {
    const double share = std::clamp(*done, 0.0, 1.0);
    if (seconds_left < 0 && share > 0) seconds_left = elapsed * (1 - share) / share;
    constexpr std::size_t kBarWidth = 24;
    const auto filled = static_cast<std::size_t>(share * kBarWidth);
    text += console_.interactive() ? " [" + std::string(filled, '=') + std::string(kBarWidth - filled, ' ') + "]" : ":";
    text += fmt::format(" {:.0f} % done", 100 * share);
  } else {
    text += ": " + duration_text(elapsed) + " so far";
  }
  if (seconds_left >= 0) text += ", about " + duration_text(seconds_left) + " left";
  if (!note.empty()) text += ", " + note;
  if (console_.interactive())
    console_.set_status(text);
  else
    spdlog::info("{}", text);
}

}  // namespace vantage::cli
