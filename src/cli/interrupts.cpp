// SPDX-License-Identifier: Apache-2.0
#include "cli/interrupts.hpp"

#include <signal.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <ctime>

namespace vantage::cli {
namespace {

[[noreturn]] void die() {
  constexpr char kFarewell[] = "\nvantage: aborted\n";
  [[maybe_unused]] const auto written = write(STDERR_FILENO, kFarewell, sizeof kFarewell - 1);
  _exit(130);
}

void watch(const std::stop_token& finished, const sigset_t& signals, std::stop_source stop, std::stop_source abort,
           const std::atomic<bool>& several) {
  constexpr timespec kTick{.tv_sec = 0, .tv_nsec = 50'000'000};
  int ticks_left = 200;
  while (!finished.stop_requested()) {
    if (sigtimedwait(&signals, nullptr, &kTick) < 0) {
      if (abort.stop_requested() && --ticks_left == 0) die();
    } else if (stop.request_stop()) {
      spdlog::warn(several
                       ? "told to end, by hand or because another rank has died; --resume goes on from the checkpoint"
                       : "stopping in good order; once more to abort");
    } else if (!abort.request_stop()) {
      die();
    }
  }
}

}  // namespace

Interrupts::Interrupts() {
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGINT);
  sigaddset(&signals, SIGTERM);
  // A blocked signal arrives even if it is ignored, as by nohup.
  struct sigaction hang_up {};
  if (sigaction(SIGHUP, nullptr, &hang_up) == 0 && hang_up.sa_handler != SIG_IGN) sigaddset(&signals, SIGHUP);
  // A closed pipe, or a file at its size limit, is an error of the write only.
  signal(SIGPIPE, SIG_IGN);
  signal(SIGXFSZ, SIG_IGN);
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  watcher_ = std::jthread([this, signals, stop = stop_, abort = abort_](const std::stop_token& finished) {
    watch(finished, signals, stop, abort, several_);
  });
}

}  // namespace vantage::cli
