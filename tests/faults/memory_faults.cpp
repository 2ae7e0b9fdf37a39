// SPDX-License-Identifier: Apache-2.0
// Makes allocations of a small plan fail, one by one, and reports the outcome:
//     vantage-memory-faults ENGINE sites|EVERY [FIRST]
// sites: the first allocation of each place in the code, identified by its call stack. EVERY: one of EVERY allocations,
// from number FIRST on. Allocations by libraries for themselves are excluded: docs/evidence/reliability.md.
#include <dlfcn.h>
#include <execinfo.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <map>
#include <memory>
#include <new>
#include <set>
#include <string>
#include <vector>

#include "faults/small_plan.hpp"

namespace {

constexpr std::size_t never = ~std::size_t{0};
constexpr int most_frames = 40;

std::atomic<std::size_t> allocations{0}, fail_at{never};
std::atomic<bool> failed{false};
// Stack hash of each allocation while they are listed; allocated before, so as not to be counted.
std::atomic<std::uint64_t>* sites = nullptr;
constexpr std::size_t most_sites = std::size_t{1} << 22;

struct Stack {
  void* frames[most_frames];
  int depth;
  Stack() : depth(backtrace(frames, most_frames)) {}

  // True if the project allocates, directly or through the standard library.
  bool own() const { return asked_by_program() && !in_json_destructor(); }
  bool asked_by_program() const {
    for (int k = 1; k < depth; ++k) {
      Dl_info info{}, program{};
      if (!dladdr(frames[k], &info) || !info.dli_fname) return false;
      dladdr(reinterpret_cast<void*>(&backtrace_of_this_program), &program);
      if (info.dli_fbase == program.dli_fbase) {
        if (info.dli_sname && std::strncmp(info.dli_sname, "_Zn", 3) == 0) continue;  // operator new
        return true;
      }
      if (!std::strstr(info.dli_fname, "libstdc++")) return false;
    }
    return false;
  }
  // nlohmann's JSON allocates in its destructor; a failure there ends the process.
  bool in_json_destructor() const {
    for (int k = 1; k < std::min(depth, 10); ++k) {
      Dl_info info{};
      if (dladdr(frames[k], &info) && info.dli_sname && std::strstr(info.dli_sname, "json_value7destroy")) return true;
    }
    return false;
  }
  std::uint64_t hash() const {
    std::uint64_t sum = 1469598103934665603u;
    for (int k = 1; k < std::min(depth, 14); ++k)
      sum = (sum ^ reinterpret_cast<std::uint64_t>(frames[k])) * 1099511628211u;
    return sum;
  }
  static void backtrace_of_this_program() {}
};

bool fails() {
  const std::size_t number = allocations.fetch_add(1, std::memory_order_relaxed);
  if (sites && number < most_sites) {
    const Stack stack;
    sites[number] = stack.own() ? stack.hash() : 0;
  }
  if (number != fail_at.load(std::memory_order_relaxed) || !Stack().own()) return false;
  failed = true;
  return true;
}

void* allocate(std::size_t bytes, std::size_t alignment) {
  if (fails()) return nullptr;
  bytes = std::max<std::size_t>(bytes, 1);
  return alignment > alignof(std::max_align_t)
             ? std::aligned_alloc(alignment, (bytes + alignment - 1) / alignment * alignment)
             : std::malloc(bytes);
}
void* or_throw(void* memory) {
  if (!memory) throw std::bad_alloc();
  return memory;
}

}  // namespace

void* operator new(std::size_t bytes) { return or_throw(allocate(bytes, 1)); }
void* operator new[](std::size_t bytes) { return or_throw(allocate(bytes, 1)); }
void* operator new(std::size_t bytes, const std::nothrow_t&) noexcept { return allocate(bytes, 1); }
void* operator new[](std::size_t bytes, const std::nothrow_t&) noexcept { return allocate(bytes, 1); }
void* operator new(std::size_t bytes, std::align_val_t alignment) {
  return or_throw(allocate(bytes, static_cast<std::size_t>(alignment)));
}
void* operator new[](std::size_t bytes, std::align_val_t alignment) {
  return or_throw(allocate(bytes, static_cast<std::size_t>(alignment)));
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete[](void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete(void* memory, const std::nothrow_t&) noexcept { std::free(memory); }
void operator delete[](void* memory, const std::nothrow_t&) noexcept { std::free(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::align_val_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::size_t, std::align_val_t) noexcept { std::free(memory); }

namespace vantage::test {
namespace {

constexpr unsigned hang_seconds = 300;

void disarm() { fail_at = never; }
void arm(std::size_t number) {
  failed = false;
  allocations = 0;
  fail_at = number;
}

[[noreturn]] void tell_terminated() {
  std::printf("WRONG: std::terminate was called, by\n");
  std::fflush(stdout);
  void* frames[most_frames];
  backtrace_symbols_fd(frames, backtrace(frames, most_frames), STDOUT_FILENO);
  _exit(1);
}

// Numbers of the first allocation of each place.
std::vector<std::size_t> one_of_each(SmallPlan& plan) {
  const TemporaryFolder folder;
  const auto listed = std::make_unique<std::atomic<std::uint64_t>[]>(most_sites);
  sites = listed.get();
  arm(never);
  plan.run(folder / "checkpoint", false);
  sites = nullptr;
  std::vector<std::size_t> numbers;
  std::set<std::uint64_t> met{0};
  for (std::size_t k = 0; k < std::min<std::size_t>(allocations, most_sites); ++k)
    if (met.insert(listed[k]).second) numbers.push_back(k);
  return numbers;
}

int run(Engine engine, const std::string& which, std::size_t first) {
  SmallPlan plan(engine, false);
  const auto fresh = [&] {
    const TemporaryFolder folder;
    return plan.run(folder / "checkpoint", false);
  };
  fresh();  // creates objects that are made once and kept
  arm(never);
  const std::string front = fresh();
  const std::size_t all = allocations;
  std::vector<std::size_t> numbers;
  if (which == "sites") {
    numbers = one_of_each(plan);
  } else {
    for (std::size_t k = first; k < all; k += std::max(1ul, std::stoul(which))) numbers.push_back(k);
  }
  std::map<Outcome::Kind, std::size_t> outcomes;
  std::size_t left_alone = 0;
  bool wrong = front.empty();
  for (const std::size_t number : numbers) {
    alarm(hang_seconds);
    const Outcome outcome = attempt(
        plan, front, [&] { arm(number); }, disarm);
    alarm(0);
    if (!failed) {
      ++left_alone;
      if (outcome.kind == Outcome::Kind::same) continue;
    }
    ++outcomes[outcome.kind];
    if (outcome.kind != Outcome::Kind::wrong) continue;
    wrong = true;
    std::printf("WRONG: allocation %zu of %zu: %s\n", number, all, outcome.text.c_str());
    std::fflush(stdout);
  }
  std::printf("| %s | %zu of %zu allocations, %zu of them of libraries | %zu | %zu | %zu | %zu |\n",
              to_string(engine).c_str(), numbers.size(), all, left_alone, outcomes[Outcome::Kind::same],
              outcomes[Outcome::Kind::saved], outcomes[Outcome::Kind::refused], outcomes[Outcome::Kind::wrong]);
  return wrong || outcomes[Outcome::Kind::saved] == 0 ? 1 : 0;
}

}  // namespace
}  // namespace vantage::test

int main(int argc, char** argv) {
  using namespace vantage;
  if (argc < 3) return std::fprintf(stderr, "usage: vantage-memory-faults ENGINE sites|EVERY [FIRST]\n"), 2;
  std::set_terminate(test::tell_terminated);
  return test::run(engine_from_string(argv[1]), argv[2], argc > 3 ? std::strtoul(argv[3], nullptr, 10) : 0);
}
