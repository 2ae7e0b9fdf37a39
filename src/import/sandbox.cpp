// SPDX-License-Identifier: Apache-2.0
#include "import/sandbox.hpp"

#include <fcntl.h>
#include <linux/seccomp.h>
#include <sched.h>
#include <seccomp.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#if __has_include(<linux/landlock.h>)
#include <linux/landlock.h>
#endif

namespace vantage::importers {
namespace {

#ifdef LANDLOCK_CREATE_RULESET_VERSION
constexpr std::uint64_t kReadFile = LANDLOCK_ACCESS_FS_READ_FILE;
constexpr std::uint64_t kReadFolder = kReadFile | LANDLOCK_ACCESS_FS_READ_DIR;
// Returns all file accesses that a version of Landlock knows. Renames between folders came with version 2, truncation
// with 3, ioctl of devices with 5. Headers may not name them yet.
std::uint64_t known_accesses(long version) {
  std::uint64_t last = LANDLOCK_ACCESS_FS_MAKE_SYM;
  for (const long since : {2, 3, 5})
    if (version >= since) last <<= 1;
  return (last << 1) - 1;
}

// Matches landlock_ruleset_attr of later headers: TCP since version 4, signals and abstract sockets since version 6.
struct Handled {
  std::uint64_t files, network, scoped;
};

int make_ruleset() {
  const long version = syscall(SYS_landlock_create_ruleset, nullptr, 0, LANDLOCK_CREATE_RULESET_VERSION);
  if (version < 1) return -1;
  constexpr std::uint64_t kBindAndConnect = 3, kSocketsAndSignals = 3;
  const Handled handled{known_accesses(version), kBindAndConnect, kSocketsAndSignals};
  const std::size_t known = version >= 6   ? sizeof handled
                            : version >= 4 ? offsetof(Handled, scoped)
                                           : offsetof(Handled, network);
  return static_cast<int>(syscall(SYS_landlock_create_ruleset, &handled, known, 0));
}

void allow(int rules, const char* path, bool running) noexcept {
  const int place = open(path, O_PATH | O_CLOEXEC);
  if (place < 0) return;  // this system lacks the folder
  struct stat status {};
  if (fstat(place, &status) == 0) {
    landlock_path_beneath_attr rule{};
    rule.allowed_access = S_ISDIR(status.st_mode) ? kReadFolder : kReadFile;
    if (running) rule.allowed_access |= LANDLOCK_ACCESS_FS_EXECUTE;
    rule.parent_fd = place;
    syscall(SYS_landlock_add_rule, rules, LANDLOCK_RULE_PATH_BENEATH, &rule, 0);
  }
  close(place);
}
#endif

// System calls that an importer, and node, may make with any arguments.
constexpr std::initializer_list<const char*> kAllowed{
    // open files
    "read", "readv", "pread64", "preadv", "write", "writev", "close", "close_range", "lseek", "fstat", "newfstatat",
    "stat", "lstat", "statx", "statfs", "fstatfs", "access", "faccessat", "faccessat2", "readlink", "readlinkat",
    "getdents", "getdents64", "getcwd", "dup", "dup2", "dup3", "fadvise64", "pipe", "pipe2", "poll", "ppoll", "select",
    "pselect6", "epoll_create1", "epoll_ctl", "epoll_wait", "epoll_pwait", "epoll_pwait2", "eventfd2",
    // memory, threads, and its own signals
    "munmap", "mprotect", "mremap", "madvise", "brk", "mincore", "membarrier", "pkey_alloc", "pkey_free",
    "pkey_mprotect", "futex", "get_robust_list", "set_robust_list", "rseq", "set_tid_address", "sched_yield",
    "sched_getaffinity", "sched_getparam", "sched_getscheduler", "sched_get_priority_max", "sched_get_priority_min",
    "getcpu", "exit", "exit_group", "rt_sigaction", "rt_sigprocmask", "rt_sigreturn", "rt_sigtimedwait", "sigaltstack",
    "restart_syscall", "arch_prctl", "wait4",
    // what it is, and when
    "gettid", "getpid", "getppid", "getpgrp", "getpgid", "getuid", "geteuid", "getgid", "getegid", "getresuid",
    "getresgid", "getgroups", "capget", "uname", "sysinfo", "getrandom", "getrlimit", "getrusage", "clock_gettime",
    "clock_getres", "clock_nanosleep", "nanosleep", "gettimeofday", "time", "times", "umask",
    // the importer itself
    "execve"};

class Filter {
 public:
  Filter() : context_(seccomp_init(SCMP_ACT_ERRNO(EPERM))) {}
  Filter(const Filter&) = delete;
  Filter& operator=(const Filter&) = delete;
  ~Filter() {
    if (context_) seccomp_release(context_);
  }

  // Skips calls that this architecture lacks.
  template <class... Conditions>
  void allow(const char* call, Conditions... conditions) {
    add(SCMP_ACT_ALLOW, call, conditions...);
  }
  template <class... Conditions>
  void add(std::uint32_t action, const char* call, Conditions... conditions) {
    const int number = seccomp_syscall_resolve_name(call);
    if (context_ && number >= 0)
      seccomp_rule_add(context_, action, number, static_cast<unsigned>(sizeof...(conditions)), conditions...);
  }
  // Returns the program of the filter; empty if it cannot be made.
  std::vector<sock_filter> program() const {
    std::vector<sock_filter> lines;
    const int memory = context_ ? memfd_create("filter", MFD_CLOEXEC) : -1;
    if (memory < 0) return lines;
    if (seccomp_export_bpf(context_, memory) == 0) {
      lines.resize(static_cast<std::size_t>(lseek(memory, 0, SEEK_END)) / sizeof(sock_filter));
      const std::size_t bytes = lines.size() * sizeof(sock_filter);
      if (pread(memory, lines.data(), bytes, 0) != static_cast<ssize_t>(bytes)) lines.clear();
    }
    close(memory);
    return lines;
  }

 private:
  scmp_filter_ctx context_;
};

// Placeholder for the id of the process that the filter is for, which does not exist yet.
constexpr std::uint32_t kItself = 0x7E570001;

scmp_arg_cmp masked(unsigned argument, std::uint64_t mask, std::uint64_t value) {
  return SCMP_CMP64(argument, SCMP_CMP_MASKED_EQ, mask, value);
}
scmp_arg_cmp equal(unsigned argument, std::uint64_t value) { return masked(argument, 0xFFFFFFFF, value); }

std::vector<sock_filter> make_filter(bool spawns) {
  Filter filter;
  for (const char* call : kAllowed) filter.allow(call);
  // Files may be opened only for reading.
  constexpr std::uint64_t kWriting = O_ACCMODE | O_CREAT | O_TRUNC | O_APPEND | (O_TMPFILE & ~O_DIRECTORY);
  filter.allow("open", masked(1, kWriting, O_RDONLY));
  filter.allow("openat", masked(2, kWriting, O_RDONLY));
  // Forbids shared memory without a file, since it counts towards no limit.
  for (const std::uint64_t kind : {std::uint64_t{0}, std::uint64_t{MAP_SHARED}, std::uint64_t{MAP_ANONYMOUS}})
    filter.allow("mmap", masked(3, MAP_SHARED | MAP_ANONYMOUS, kind));
  // Allows threads, but no processes. The C library falls back to clone, whose flags the filter can check.
  constexpr std::uint64_t kThread = CLONE_VM | CLONE_THREAD;
  filter.allow("clone", masked(0, kThread, kThread));
  constexpr std::uint64_t kSpawn = CLONE_VM | CLONE_VFORK;
  if (spawns) filter.allow("clone", masked(0, kSpawn | CLONE_THREAD, kSpawn));
  filter.add(SCMP_ACT_ERRNO(ENOSYS), "clone3");
  // Forbids an owner, who would get signals, and a larger pipe.
  for (const int command : {F_DUPFD, F_DUPFD_CLOEXEC, F_GETFD, F_SETFD, F_GETFL, F_SETFL})
    filter.allow("fcntl", equal(1, static_cast<std::uint64_t>(command)));
  for (const std::uint64_t request : {std::uint64_t{FIOCLEX}, std::uint64_t{FIONCLEX}, std::uint64_t{FIONBIO},
                                      std::uint64_t{FIONREAD}, std::uint64_t{TCGETS}, std::uint64_t{TIOCGWINSZ}})
    filter.allow("ioctl", equal(1, request));
  // No descriptor is a socket, but shells ask.
  for (const char* call : {"getpeername", "getsockname", "getsockopt"}) filter.add(SCMP_ACT_ERRNO(ENOTSOCK), call);
  constexpr std::uint64_t kNameMemory = 0x53564D41;  // PR_SET_VMA
  for (const std::uint64_t option : {std::uint64_t{PR_SET_NAME}, std::uint64_t{PR_GET_NAME}, kNameMemory})
    filter.allow("prctl", equal(0, option));
  filter.allow("prlimit64", equal(0, 0));                                             // of itself only
  for (const char* call : {"kill", "tgkill"}) filter.allow(call, equal(0, kItself));  // abort() ends with one
  return filter.program();
}

}  // namespace

Sandbox::Sandbox(const std::vector<std::filesystem::path>& programs, const std::vector<std::filesystem::path>& readable,
                 bool spawns)
    : filter_(make_filter(spawns)) {
#ifdef LANDLOCK_CREATE_RULESET_VERSION
  rules_ = make_ruleset();
  if (rules_ < 0) return;
  for (const char* folder : {"/usr", "/lib", "/lib32", "/lib64", "/bin", "/sbin", "/nix"}) allow(rules_, folder, true);
  for (const auto& place : programs) allow(rules_, place.c_str(), true);
  // Files of the dynamic linker, and files that node looks for.
  for (const char* file : {"/etc/ld.so.cache", "/etc/localtime", "/etc/ssl/openssl.cnf", "/dev/null", "/dev/zero",
                           "/dev/random", "/dev/urandom", "/proc/meminfo", "/proc/cpuinfo", "/proc/stat",
                           "/proc/version_signature", "/proc/sys/vm/overcommit_memory", "/sys/devices/system/cpu",
                           "/sys/fs/cgroup", "/sys/kernel/mm/transparent_hugepage"})
    allow(rules_, file, false);
  for (const auto& place : readable) allow(rules_, place.c_str(), false);
#else
  static_cast<void>(programs), static_cast<void>(readable);
#endif
}

Sandbox::~Sandbox() {
  if (rules_ >= 0) close(rules_);
}

void Sandbox::enter() noexcept {
  prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0);
#ifdef LANDLOCK_CREATE_RULESET_VERSION
  if (rules_ >= 0) {
    allow(rules_, "/proc/self", false);  // of this process only
    syscall(SYS_landlock_restrict_self, rules_, 0);
  }
#endif
  if (filter_.empty()) return;
  const auto itself = static_cast<std::uint32_t>(getpid());
  for (sock_filter& line : filter_)
    if (BPF_CLASS(line.code) == BPF_JMP && line.k == kItself) line.k = itself;
  const sock_fprog program{static_cast<unsigned short>(filter_.size()), filter_.data()};
  prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program);
}

}  // namespace vantage::importers
