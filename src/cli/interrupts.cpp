// SPDX-License-Identifier: Apache-2.0
#include "cli/interrupts.hpp"

#include <signal.h>
#include <unistd.h>

#include <ctime>

#include <spdlog/spdlog.h>

namespace vantage::cli {

Interrupts::Interrupts() {
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGINT);
  sigaddset(&signals, SIGTERM);
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  watcher_ = std::jthread([signals, source = source_](std::stop_token finished) mutable {
    const timespec patience{.tv_sec = 0, .tv_nsec = 50'000'000};
    while (!finished.stop_requested()) {
      if (sigtimedwait(&signals, nullptr, &patience) < 0) continue;
      if (!source.request_stop()) {
        constexpr char farewell[] = "\nvantage: aborted\n";
        [[maybe_unused]] const auto written = write(STDERR_FILENO, farewell, sizeof farewell - 1);
        _exit(130);
      }
      spdlog::warn("stopping; once more to abort at once");
    }
  });
}

}  // namespace vantage::cli
