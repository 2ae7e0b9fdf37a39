// SPDX-License-Identifier: Apache-2.0
#include "import/cloud/laz_records.hpp"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <sstream>
#include <string>

#include "import/program.hpp"

namespace vantage::importer {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kPipe = std::size_t{1} << 20;
constexpr std::size_t kLateRecord = 30;  // of format 6

[[noreturn]] void refuse_missing(const std::string& what) {
  throw Refused("its points are compressed (LAZ), and " + what +
                "; install node and laz-perf with setup.sh --laz, or decompress the points to .las");
}

// Returns the script in the importers' folder, which the environment names or which holds this program.
fs::path script() {
  std::error_code failure;
  const char* given = std::getenv("VANTAGE_IMPORTERS");
  const fs::path folder = given && *given ? fs::path(given) : fs::read_symlink("/proc/self/exe", failure).parent_path();
  const fs::path file = fs::canonical(folder / "vantage-import-laz/records.mjs", failure);
  if (failure) refuse_missing("what reads them is not installed");
  return file;
}

std::string node() {
  const char* path = std::getenv("PATH");
  std::istringstream folders(path ? path : "");
  for (std::string folder; std::getline(folders, folder, ':');)
    if (const fs::path file = fs::path(folder) / "node"; !folder.empty() && access(file.c_str(), X_OK) == 0)
      return file.string();
  refuse_missing("node, which runs what reads them, is not installed");
}

struct Ends {
  Ends() {
    if (pipe2(ends.data(), O_CLOEXEC) != 0) throw Refused(std::string("no pipe opens: ") + std::strerror(errno));
  }
  std::array<int, 2> ends{};
};

}  // namespace

LazRecords::LazRecords(const fs::path& file, const LazLayout& layout)
    : record_(layout.format >= 6 ? kLateRecord : layout.record) {
  const std::string program = node();
  // Each call for a point leaves garbage; more room before it is collected saves a tenth of the time.
  std::vector<std::string> words{program, "--max-semi-space-size=16", script().string(), file.string()};
  for (const std::uint64_t number : {layout.first, layout.count, std::uint64_t{layout.format},
                                     std::uint64_t{layout.record}, std::uint64_t{layout.chunk}})
    words.push_back(std::to_string(number));
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  const Ends out, err;
  fcntl(out.ends[0], F_SETPIPE_SZ, static_cast<int>(kPipe));  // a smaller pipe is only slower
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, out.ends[1], STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&actions, err.ends[1], STDERR_FILENO);
  const int failure = posix_spawn(&process_, program.c_str(), &actions, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  close(out.ends[1]), close(err.ends[1]);
  records_ = out.ends[0], errors_ = err.ends[0];
  buffer_.resize(kPipe);
  if (failure == 0) return;
  process_ = -1;
  close(records_), close(errors_);
  refuse_missing(std::string("node cannot be started: ") + std::strerror(failure));
}

LazRecords::~LazRecords() {
  close(records_), close(errors_);
  if (process_ < 0) return;
  kill(process_, SIGKILL);
  waitpid(process_, nullptr, 0);
}

const char* LazRecords::next() {
  while (end_ - at_ < record_) {
    std::copy(buffer_.begin() + static_cast<std::ptrdiff_t>(at_), buffer_.begin() + static_cast<std::ptrdiff_t>(end_),
              buffer_.begin());
    end_ -= at_, at_ = 0;
    const ssize_t got = read(records_, buffer_.data() + end_, buffer_.size() - end_);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) fail();
    end_ += static_cast<std::size_t>(got);
  }
  at_ += record_;
  return buffer_.data() + (at_ - record_);
}

void LazRecords::fail() {
  constexpr int kData = 65, kUnavailable = 69;
  std::string said;
  std::array<char, 4096> text{};
  for (ssize_t got; said.size() < text.size() && (got = read(errors_, text.data(), text.size())) > 0;)
    said.append(text.data(), static_cast<std::size_t>(got));
  while (!said.empty() && said.back() == '\n') said.pop_back();
  said = said.substr(said.rfind('\n') + 1);
  int status = 0;
  waitpid(process_, &status, 0);
  process_ = -1;
  const int code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  if (code == kUnavailable) refuse_missing(said);
  if (code == kData && !said.empty()) throw Refused(said);
  throw Refused("its compressed points end before their number, or are damaged; copy or export it again");
}

}  // namespace vantage::importer
