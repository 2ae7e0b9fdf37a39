// SPDX-License-Identifier: Apache-2.0
#include "import/child_process.hpp"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <string_view>
#include <utility>

#include "import/sandbox.hpp"
#include "vantage/error.hpp"

namespace vantage::importers {
namespace {

constexpr std::size_t kMostErrors = 4096;
// Limits open files, as each pipe holds 64 KiB of the kernel's memory, and threads.
constexpr std::uint64_t kMostFiles = 256, kMostThreads = 256;

// Returns the limit for RLIMIT_NPROC, which counts all processes and threads of a user: the number that the system has
// now, plus the importer's own.
std::uint64_t most_tasks() {
  std::ifstream load("/proc/loadavg");
  std::string word;
  for (int k = 0; k < 4; ++k) load >> word;  // the fourth: running/all
  std::uint64_t all = 0;
  const std::size_t slash = word.find('/');
  if (slash == std::string::npos ||
      std::from_chars(word.data() + slash + 1, word.data() + word.size(), all).ec != std::errc())
    return RLIM_INFINITY;
  return all + kMostThreads;
}

// Ends a process and all that it started.
void end(pid_t process) {
  kill(-process, SIGKILL);
  kill(process, SIGKILL);  // it may not have its group yet
}

class Descriptor {
 public:
  Descriptor() = default;
  explicit Descriptor(int value) : value_(value) {}
  Descriptor(Descriptor&& other) noexcept : value_(std::exchange(other.value_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(value_, other.value_);
    return *this;
  }
  ~Descriptor() { reset(); }
  void reset() {
    if (value_ >= 0) close(value_);
    value_ = -1;
  }
  int get() const { return value_; }

 private:
  int value_ = -1;
};

struct Pipe {
  Pipe() {
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0)
      throw Error(Errc::io, std::string("no pipe to an importer can be opened: ") + std::strerror(errno));
    from = Descriptor(ends[0]);
    to = Descriptor(ends[1]);
  }
  Descriptor from, to;
};

// Sets a limit. A signal reports it at `most`; the process ends at `hard`.
void limit(__rlimit_resource_t resource, std::uint64_t most, std::uint64_t hard) noexcept {
  rlimit now{};
  getrlimit(resource, &now);
  const rlimit wanted{std::min<rlim_t>(most, now.rlim_max), std::min<rlim_t>(hard, now.rlim_max)};
  setrlimit(resource, &wanted);
}

// Sanitizers reserve terabytes and read files that the sandbox closes: their builds limit no memory and use no sandbox.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kConfined = false;
#else
constexpr bool kConfined = true;
#endif

// Runs after the fork, where only system calls are safe. RLIMIT_DATA limits allocation: unlike RLIMIT_AS it does not
// count the address space that node reserves and never uses.
[[noreturn]] void become(char* const* words, char* const* environment, Sandbox& sandbox, const Limits& limits,
                         std::uint64_t tasks, int nothing, int out, int err) noexcept {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  setpgid(0, 0);
  if (dup2(nothing, 0) < 0 || dup2(out, 1) < 0 || dup2(err, 2) < 0) _exit(kCannotStart);
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
  for (const int name : {SIGPIPE, SIGXFSZ, SIGXCPU, SIGINT, SIGTERM, SIGHUP}) signal(name, SIG_DFL);
  limit(RLIMIT_CORE, 0, 0);
  limit(RLIMIT_FSIZE, 0, 0);
  limit(RLIMIT_CPU, limits.cpu_s, limits.cpu_s + 1);
  if (kConfined && limits.memory > 0) limit(RLIMIT_DATA, limits.memory, limits.memory);
  limit(RLIMIT_NOFILE, kMostFiles, kMostFiles);
  limit(RLIMIT_NPROC, tasks, tasks);
#ifdef SYS_close_range
  constexpr unsigned kCloseOnExec = 4;
  syscall(SYS_close_range, 3, ~0U, kCloseOnExec);
#endif
  if (kConfined) sandbox.enter();
  execve(words[0], words, environment);
  _exit(kCannotStart);
}

using Clock = std::chrono::steady_clock;

// Reads lines of standard error: reports shares of the work done, and keeps other lines as errors.
class ErrorLines {
 public:
  ErrorLines(std::string& errors, const Progress& progress) : errors_(errors), progress_(progress) {}
  ~ErrorLines() { keep(line_); }

  void add(const char* text, std::size_t bytes) {
    for (std::size_t k = 0; k < bytes; ++k) {
      if (line_.size() < kMostErrors) line_ += text[k];
      if (text[k] == '\n') take();
    }
  }

 private:
  void take() {
    constexpr std::string_view kProgress = "progress ";
    double done = 0;
    const char* const end = line_.data() + line_.size();
    if (line_.starts_with(kProgress) && std::from_chars(line_.data() + kProgress.size(), end, done).ec == std::errc() &&
        done >= 0 && done <= 1)
      progress_(done);
    else
      keep(line_);
    line_.clear();
  }
  void keep(const std::string& line) { errors_.append(line, 0, kMostErrors - errors_.size()); }

  std::string& errors_;
  const Progress& progress_;
  std::string line_;
};

// Reads both pipes until they are closed; records the reason if it stops earlier.
void listen(Pipe& out, Pipe& err, const Limits& limits, const Progress& progress, Ended& ended) {
  ErrorLines lines(ended.errors, progress);
  const auto deadline = Clock::now() + std::chrono::seconds(limits.wall_s);
  std::array<pollfd, 2> ends{pollfd{out.from.get(), POLLIN, 0}, pollfd{err.from.get(), POLLIN, 0}};
  std::vector<char> block(std::size_t{1} << 18);
  while (ends[0].fd >= 0 || ends[1].fd >= 0) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(deadline - Clock::now()).count();
    if (left <= 0) {
      ended.timed_out = true;
      return;
    }
    if (progress.stopped()) {
      ended.stopped = true;
      return;
    }
    const long long wait = progress.stop.stop_possible() ? 200 : 1000;
    const int ready = poll(ends.data(), ends.size(), static_cast<int>(std::min<long long>(left, wait)));
    if (ready < 0 && errno != EINTR) return;
    if (ready <= 0) continue;
    for (std::size_t e = 0; e < ends.size(); ++e) {
      if (ends[e].fd < 0 || ends[e].revents == 0) continue;
      const ssize_t got = read(ends[e].fd, block.data(), block.size());
      if (got < 0 && errno == EINTR) continue;
      if (got <= 0) {
        ends[e].fd = -1;
        continue;
      }
      const auto bytes = static_cast<std::size_t>(got);
      if (e == 1) {
        lines.add(block.data(), bytes);
      } else if (ended.output.size() + bytes > limits.output) {
        ended.too_large = true;
        return;
      } else {
        ended.output.insert(ended.output.end(), block.begin(), block.begin() + got);
      }
    }
  }
}

// Waits until the process has ended; kills it at the deadline.
int wait_for(pid_t process, unsigned seconds, bool& timed_out) {
  const auto deadline = Clock::now() + std::chrono::seconds(seconds);
  int status = 0;
  for (bool killed = false;;) {
    const pid_t ended = waitpid(process, &status, killed ? 0 : WNOHANG);
    if (ended == process || (ended < 0 && errno != EINTR)) return status;
    if (!killed && Clock::now() > deadline) {
      end(process);
      killed = timed_out = true;
    }
    if (!killed) usleep(1000);
  }
}

}  // namespace

Ended run_limited(const std::vector<std::string>& words, const std::vector<std::filesystem::path>& programs,
                  const std::vector<std::filesystem::path>& readable, const Limits& limits, const Progress& progress) {
  std::vector<std::string> copies = words;
  std::vector<char*> argv;
  for (std::string& word : copies) argv.push_back(word.data());
  argv.push_back(nullptr);
  std::vector<std::string> variables;
  if (limits.spawns)
    for (const char* name : {"PATH", "VANTAGE_IMPORTERS"})
      if (const char* value = std::getenv(name)) variables.push_back(std::string(name) + "=" + value);
  std::vector<char*> environment;
  for (std::string& variable : variables) environment.push_back(variable.data());
  environment.push_back(nullptr);
  Sandbox sandbox(programs, readable, limits.spawns);
  const std::uint64_t tasks = most_tasks();
  Pipe out, err;
  const Descriptor nothing(open("/dev/null", O_RDONLY | O_CLOEXEC));
  const pid_t process = fork();
  if (process < 0) throw Error(Errc::io, words.front() + " cannot be started: " + std::string(std::strerror(errno)));
  if (process == 0)
    become(argv.data(), environment.data(), sandbox, limits, tasks, nothing.get(), out.to.get(), err.to.get());
  out.to.reset();
  err.to.reset();
  Ended ended;
  int status = 0;
  try {
    listen(out, err, limits, progress, ended);
  } catch (...) {  // not enough memory for the output, or thrown by a report
    end(process);
    waitpid(process, &status, 0);
    throw;
  }
  if (ended.timed_out || ended.too_large || ended.stopped) end(process);
  status = wait_for(process, 10, ended.timed_out);  // a process that closed its output has nothing left to do
  if (WIFEXITED(status)) ended.exit_code = WEXITSTATUS(status);
  if (WIFSIGNALED(status)) ended.signal = WTERMSIG(status);
  for (char& c : ended.errors)
    if (c != '\n' && !(c >= ' ' && c <= '~')) c = '?';
  return ended;
}

}  // namespace vantage::importers
