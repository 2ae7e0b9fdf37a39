// SPDX-License-Identifier: Apache-2.0
#include "import/child_process.hpp"

#include <arpa/inet.h>
#include <linux/landlock.h>
#include <netinet/in.h>
#include <signal.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <chrono>

#include "import_fixture.hpp"

namespace vantage::test {
namespace {

using importers::Ended;
using importers::Limits;

class ChildProcessTest : public ImportTest {
 protected:
  Ended shell(const std::string& script, const Limits& limits = {}) const {
    return importers::run_limited({"/bin/bash", "-c", script}, {folder_ / "readable"}, limits);
  }
};

std::string text(const Ended& ended) { return {ended.output.begin(), ended.output.end()}; }

TEST_F(ChildProcessTest, LinesOfProgressAreReportedAndNoErrors) {
  std::vector<double> told;
  const Ended ended = importers::run_limited(
      {"/bin/bash", "-c",
       "exec >&2; printf 'progress 0.25\\nprogress 0.'; printf '5\\nprogress of my own\\nprogress 7\\nbad'"},
      {}, {}, {[&](double done) { told.push_back(done); }, {}});
  EXPECT_EQ(told, (std::vector<double>{0.25, 0.5}));
  EXPECT_EQ(ended.errors, "progress of my own\nprogress 7\nbad");
}

TEST_F(ChildProcessTest, IsEndedWhenItIsStopped) {
  std::stop_source stop;
  stop.request_stop();
  const auto begin = std::chrono::steady_clock::now();
  const Ended ended =
      importers::run_limited({"/bin/bash", "-c", "sleep 60"}, {}, {}, {.report = {}, .stop = stop.get_token()});
  EXPECT_TRUE(ended.stopped);
  EXPECT_NE(ended.exit_code, 0);
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(30));
}

TEST_F(ChildProcessTest, GivesOutputErrorsAndExitCode) {
  const Ended ended = shell("printf 'a\\0b'; printf 'first\\n\\033[31mred\\303\\251' >&2; exit 7");
  EXPECT_EQ(text(ended), std::string("a\0b", 3));
  EXPECT_EQ(ended.errors, "first\n?[31mred??");
  EXPECT_EQ(ended.exit_code, 7);
  EXPECT_EQ(ended.signal, 0);
  EXPECT_EQ(shell("read line || echo end").output.size(), 4u);  // its input is empty
}

TEST_F(ChildProcessTest, TellsSignals) {
  EXPECT_EQ(shell("kill -SEGV $$").signal, SIGSEGV);
  EXPECT_EQ(shell("kill -SEGV $$").exit_code, -1);
}

TEST_F(ChildProcessTest, KeepsOfErrorsTheirBeginning) {
  const Ended ended = shell("for i in $(seq 4000); do echo line $i >&2; done; echo done");
  EXPECT_EQ(ended.errors.size(), 4096u);
  EXPECT_TRUE(ended.errors.starts_with("line 1\n"));
  EXPECT_EQ(text(ended), "done\n");  // it was not held up
}

TEST_F(ChildProcessTest, EndsWhatTakesTooLong) {
  const auto start = std::chrono::steady_clock::now();
  EXPECT_TRUE(shell("sleep 60", {.wall_s = 1}).timed_out);
  // Also one that has closed what it is listened to by.
  EXPECT_TRUE(shell("exec >&- 2>&-; sleep 60", {.wall_s = 1}).timed_out);
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(40));
  EXPECT_EQ(shell("while :; do :; done", {.cpu_s = 1}).signal, SIGXCPU);
}

TEST_F(ChildProcessTest, EndsWhatWritesTooMuch) {
  const Ended ended = shell("head -c 3000000 /dev/zero; echo never >&2; sleep 60", {.output = 1'000'000});
  EXPECT_TRUE(ended.too_large);
  EXPECT_LE(ended.output.size(), 1'000'000u);
}

TEST_F(ChildProcessTest, LimitsMemory) {
  constexpr const char* kAllocate = "x=$(head -c 30000000 /dev/zero | tr '\\0' x); echo ${#x}";
  EXPECT_EQ(text(shell(kAllocate)), "30000000\n");
  EXPECT_EQ(text(shell(kAllocate, {.memory = 20'000'000})), "");
}

TEST_F(ChildProcessTest, WritesNoFile) {
  shell("echo text > " + (folder_ / "written").string());
  EXPECT_TRUE(!std::filesystem::exists(folder_ / "written") || std::filesystem::file_size(folder_ / "written") == 0);
}

TEST_F(ChildProcessTest, ReadsOnlyWhatItMay) {
  write("readable/model", "model");
  write("private/key", "key");
  EXPECT_EQ(text(shell("cat " + (folder_ / "readable/model").string())), "model");
  const bool landlock = syscall(SYS_landlock_create_ruleset, nullptr, 0, LANDLOCK_CREATE_RULESET_VERSION) > 0;
  EXPECT_EQ(text(shell("cat " + (folder_ / "private/key").string())), landlock ? "" : "key");
}

TEST_F(ChildProcessTest, ReachesNoNetwork) {
  const int door = socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  ASSERT_EQ(bind(door, reinterpret_cast<sockaddr*>(&address), size), 0);
  ASSERT_EQ(listen(door, 4), 0);
  ASSERT_EQ(getsockname(door, reinterpret_cast<sockaddr*>(&address), &size), 0);
  const std::string connect =
      "exec 3<>/dev/tcp/127.0.0.1/" + std::to_string(ntohs(address.sin_port)) + " && echo connected";
  ASSERT_EQ(std::system(("/bin/bash -c '" + connect + "' >/dev/null").c_str()), 0);  // without limits
  EXPECT_EQ(text(shell(connect)), "");
  close(door);
}

TEST_F(ChildProcessTest, SaysWhatCannotBeStarted) {
  EXPECT_EQ(importers::run_limited({(folder_ / "nothing").string()}, {}, {}).exit_code, 127);
}

}  // namespace
}  // namespace vantage::test
