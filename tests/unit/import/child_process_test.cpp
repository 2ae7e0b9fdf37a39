// SPDX-License-Identifier: Apache-2.0
#include "import/child_process.hpp"

#include <arpa/inet.h>
#include <fcntl.h>
#include <linux/landlock.h>
#include <netinet/in.h>
#include <signal.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>

#include "import_fixture.hpp"

namespace vantage::test {
namespace {

using importers::Ended;
using importers::Limits;

class ChildProcessTest : public ImportTest {
 protected:
  Ended shell(const std::string& script, const Limits& limits = {}) const {
    return importers::run_limited({"/bin/bash", "-c", script}, {}, {folder_ / "readable"}, limits);
  }
  // Returns the numbers of the lines of Python that may run, each on its own.
  Ended python(const std::vector<std::string>& lines) const {
    std::string script = "import ctypes, mmap, os, resource, signal, socket, subprocess, sys, threading\n";
    for (std::size_t k = 0; k < lines.size(); ++k)
      script += "try:\n  " + lines[k] + "\n  print(" + std::to_string(k) +
                ", end=' ', flush=True)\nexcept BaseException: pass\n";
    return importers::run_limited({"/usr/bin/python3", "-I", "-c", script}, {}, {folder_ / "readable"}, {});
  }
};

std::string text(const Ended& ended) { return {ended.output.begin(), ended.output.end()}; }

TEST_F(ChildProcessTest, LinesOfProgressAreReportedAndNoErrors) {
  std::vector<double> told;
  const Ended ended = importers::run_limited(
      {"/bin/bash", "-c",
       "exec >&2; printf 'progress 0.25\\nprogress 0.'; printf '5\\nprogress of my own\\nprogress 7\\nbad'"},
      {}, {}, {}, {[&](double done) { told.push_back(done); }, {}});
  EXPECT_EQ(told, (std::vector<double>{0.25, 0.5}));
  EXPECT_EQ(ended.errors, "progress of my own\nprogress 7\nbad");
}

TEST_F(ChildProcessTest, IsEndedWhenItIsStopped) {
  std::stop_source stop;
  stop.request_stop();
  const auto begin = std::chrono::steady_clock::now();
  const Ended ended = importers::run_limited({"/bin/bash", "-c", "sleep 60"}, {}, {}, {}, {.stop = stop.get_token()});
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
  const Ended ended = shell("for i in {1..4000}; do echo line $i >&2; done; echo done");
  EXPECT_EQ(ended.errors.size(), 4096u);
  EXPECT_TRUE(ended.errors.starts_with("line 1\n"));
  EXPECT_EQ(text(ended), "done\n");  // it was not held up
}

TEST_F(ChildProcessTest, EndsWhatTakesTooLong) {
  const auto start = std::chrono::steady_clock::now();
  EXPECT_TRUE(shell("sleep 60", {.wall_s = 1}).timed_out);
  // The limit also ends a program that has closed its output.
  EXPECT_TRUE(shell("exec >&- 2>&-; exec sleep 60", {.wall_s = 1}).timed_out);
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(40));
  EXPECT_EQ(shell("while :; do :; done", {.cpu_s = 1}).signal, SIGXCPU);
}

TEST_F(ChildProcessTest, EndsWhatWritesTooMuch) {
  const Ended ended = shell("exec head -c 3000000 /dev/zero", {.output = 1'000'000});
  EXPECT_TRUE(ended.too_large);
  EXPECT_LE(ended.output.size(), 1'000'000u);
}

TEST_F(ChildProcessTest, LimitsMemory) {
  constexpr const char* kAllocate = "printf -v x '%30000000s' ''; echo ${#x}";
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

// Actions that an importer may and may not do, by the lines of docs/evidence/reliability.md.
TEST_F(ChildProcessTest, ChangesNothingOfAnyFile) {
  const std::string file = write("readable/model", "model").string(), other = (folder_ / "other").string();
  const auto before = std::filesystem::last_write_time(file);
  const Ended ended = python({"open('" + file + "').read()", "open('" + file + "', 'w')", "open('" + file + "', 'r+')",
                              "open('" + other + "', 'x')", "os.chmod('" + file + "', 0)", "os.utime('" + file + "')",
                              "os.unlink('" + file + "')", "os.rename('" + file + "', '" + other + "')",
                              "os.link('" + file + "', '" + other + "')", "os.symlink('/', '" + other + "')",
                              "os.mkdir('" + other + "')", "os.truncate('" + file + "', 0)",
                              "os.setxattr('" + file + "', 'user.a', b'1')"});
  EXPECT_EQ(text(ended), "0 ");
  EXPECT_EQ(std::filesystem::last_write_time(file), before);
  EXPECT_FALSE(std::filesystem::exists(other));
}

TEST_F(ChildProcessTest, StartsNoProcessAndSignalsNone) {
  const Ended ended = python({"t = threading.Thread(target=print); t.start(); t.join()", "os.kill(os.getpid(), 0)",
                              "os.fork() or os._exit(0)", "subprocess.run(['/bin/true'])", "os.kill(os.getppid(), 0)",
                              "os.kill(1, 0)", "os.kill(0, 0)", "os.kill(-1, 0)", "os.setsid()", "os.setpgid(0, 0)",
                              "os.setpriority(os.PRIO_PROCESS, os.getppid(), 19)",
                              "resource.prlimit(os.getppid(), resource.RLIMIT_CORE, (0, 0))"});
  EXPECT_EQ(text(ended), "\n0 1 ");
}

// A program that an importer starts has the same sandbox, and ends with it.
TEST_F(ChildProcessTest, SpawnsWhereItMayInTheSameSandbox) {
  const std::string script =
      "import os\n"
      "p = os.posix_spawn('/bin/bash', ['bash', '-c', 'echo in; echo text > ' + " +
      ("'" + (folder_ / "written").string() + "'") +
      " + '; exec sleep 60'], os.environ)\n"
      "for f in (os.fork, os.setsid, lambda: os.kill(os.getppid(), 0)):\n"
      "  try: f(); print('let')\n"
      "  except PermissionError: pass\n"
      "os.waitpid(p, 0)\n";
  const std::vector<std::string> words{"/usr/bin/python3", "-I", "-c", script};
  const auto begin = std::chrono::steady_clock::now();
  const Ended ended = importers::run_limited(words, {}, {}, {.wall_s = 3, .spawns = true});
  EXPECT_EQ(text(ended), "in\n");
  EXPECT_TRUE(ended.timed_out);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "written"));
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(30)) << "the spawned one holds no pipe open";
  EXPECT_EQ(text(importers::run_limited(words, {}, {}, {})), "");
}

TEST_F(ChildProcessTest, HasNeitherSharedMemoryNorSockets) {
  const Ended ended = python({"mmap.mmap(-1, 4096, flags=mmap.MAP_PRIVATE)", "mmap.mmap(-1, 4096)",
                              "os.memfd_create('a')", "assert ctypes.CDLL(None).shmget(0, 4096, 0o1600) >= 0",
                              "socket.socket(socket.AF_UNIX)", "socket.socket(socket.AF_INET)", "socket.socketpair()"});
  EXPECT_EQ(text(ended), "0 ");
}

TEST_F(ChildProcessTest, HasNoEnvironmentAndNoDescriptors) {
  setenv("SECRET", "1", 1);
  const std::string secret = write("private/key", "key").string();
  const int open_file = open(secret.c_str(), O_RDONLY);  // without O_CLOEXEC
  ASSERT_GT(open_file, 2);
  const Ended ended = python({"assert 'PATH' not in os.environ and 'SECRET' not in os.environ",
                              "os.read(" + std::to_string(open_file) + ", 1)"});
  EXPECT_EQ(text(ended), "0 ");
  close(open_file);
  unsetenv("SECRET");
}

TEST_F(ChildProcessTest, SeesNoOtherProcessAndNoSettingsOfTheSystem) {
  const bool landlock = syscall(SYS_landlock_create_ruleset, nullptr, 0, LANDLOCK_CREATE_RULESET_VERSION) > 0;
  const Ended ended =
      python({"open('/proc/self/status').read()", "open('/etc/passwd').read()",
              "open('/proc/%d/cmdline' % os.getppid()).read()", "open('/proc/%d/environ' % os.getppid()).read()",
              "os.listdir('/')", "os.listdir(os.path.dirname('" + (folder_ / "readable").string() + "'))"});
  EXPECT_EQ(text(ended), landlock ? "0 " : text(ended));
  EXPECT_TRUE(text(ended).starts_with("0 "));
}

TEST_F(ChildProcessTest, SaysWhatCannotBeStarted) {
  EXPECT_EQ(importers::run_limited({(folder_ / "nothing").string()}, {}, {}, {}).exit_code, 127);
}

}  // namespace
}  // namespace vantage::test
