// SPDX-License-Identifier: Apache-2.0
#include "import/sandbox.hpp"

#include <fcntl.h>
#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#if __has_include(<linux/landlock.h>)
#include <linux/landlock.h>
#endif

namespace vantage::importers {
namespace {

#ifdef LANDLOCK_CREATE_RULESET_VERSION
constexpr std::uint64_t kReadFile = LANDLOCK_ACCESS_FS_READ_FILE | LANDLOCK_ACCESS_FS_EXECUTE;
constexpr std::uint64_t kReadFolder = kReadFile | LANDLOCK_ACCESS_FS_READ_DIR;
// All file accesses that a version of Landlock knows: renames between folders since version 2, truncation since version
// 3. Headers may not name them yet.
std::uint64_t known_accesses(long version) {
  std::uint64_t last = LANDLOCK_ACCESS_FS_MAKE_SYM;
  if (version >= 2) last <<= 1;
  if (version >= 3) last <<= 1;
  return (last << 1) - 1;
}

void allow_reading(int rules, const std::filesystem::path& path) {
  const int place = open(path.c_str(), O_PATH | O_CLOEXEC);
  if (place < 0) return;  // a system folder that this system lacks
  struct stat status {};
  if (fstat(place, &status) == 0) {
    landlock_path_beneath_attr rule{};
    rule.allowed_access = S_ISDIR(status.st_mode) ? kReadFolder : kReadFile;
    rule.parent_fd = place;
    syscall(SYS_landlock_add_rule, rules, LANDLOCK_RULE_PATH_BENEATH, &rule, 0);
  }
  close(place);
}
#endif

// Makes network system calls fail as if the system did not have them.
void deny_network() noexcept {
#if defined(__x86_64__)
  constexpr std::uint32_t kArchitecture = AUDIT_ARCH_X86_64;
#elif defined(__aarch64__)
  constexpr std::uint32_t kArchitecture = AUDIT_ARCH_AARCH64;
#endif
#if defined(__x86_64__) || defined(__aarch64__)
  constexpr std::uint32_t kDenied = SECCOMP_RET_ERRNO | EACCES;
  constexpr std::uint32_t kOtherAbi = 0x40000000;  // x32's calls begin here
  constexpr auto load = [](std::size_t offset) {
    return sock_filter{BPF_LD | BPF_W | BPF_ABS, 0, 0, static_cast<std::uint32_t>(offset)};
  };
  // Jumps of the filter skip the remaining comparisons, to the last line but one.
  std::array filter{load(offsetof(seccomp_data, arch)),
                    sock_filter{BPF_JMP | BPF_JEQ | BPF_K, 0, 6, kArchitecture},
                    load(offsetof(seccomp_data, nr)),
                    sock_filter{BPF_JMP | BPF_JGE | BPF_K, 4, 0, kOtherAbi},
                    sock_filter{BPF_JMP | BPF_JEQ | BPF_K, 3, 0, SYS_socket},
                    sock_filter{BPF_JMP | BPF_JEQ | BPF_K, 2, 0, SYS_ptrace},
                    sock_filter{BPF_JMP | BPF_JEQ | BPF_K, 1, 0, SYS_io_uring_setup},
                    sock_filter{BPF_RET | BPF_K, 0, 0, SECCOMP_RET_ALLOW},
                    sock_filter{BPF_RET | BPF_K, 0, 0, kDenied}};
  const sock_fprog program{static_cast<unsigned short>(filter.size()), filter.data()};
  prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program);
#endif
}

}  // namespace

Sandbox::Sandbox(const std::vector<std::filesystem::path>& readable) {
#ifdef LANDLOCK_CREATE_RULESET_VERSION
  const long version = syscall(SYS_landlock_create_ruleset, nullptr, 0, LANDLOCK_CREATE_RULESET_VERSION);
  if (version < 1) return;
  landlock_ruleset_attr handled{};
  handled.handled_access_fs = known_accesses(version);
  rules_ = static_cast<int>(syscall(SYS_landlock_create_ruleset, &handled, sizeof handled, 0));
  if (rules_ < 0) return;
  for (const char* folder : {"/usr", "/lib", "/lib32", "/lib64", "/bin", "/sbin", "/etc", "/opt", "/nix", "/proc",
                             "/sys", "/dev/null", "/dev/zero", "/dev/random", "/dev/urandom"})
    allow_reading(rules_, folder);
  for (const auto& folder : readable) allow_reading(rules_, folder);
#else
  static_cast<void>(readable);
#endif
}

Sandbox::~Sandbox() {
  if (rules_ >= 0) close(rules_);
}

void Sandbox::enter() const noexcept {
  prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0);
#ifdef LANDLOCK_CREATE_RULESET_VERSION
  if (rules_ >= 0) syscall(SYS_landlock_restrict_self, rules_, 0);
#endif
  deny_network();
}

}  // namespace vantage::importers
