// SPDX-License-Identifier: Apache-2.0
// Runs the fuzz targets without libFuzzer. `vantage-fuzz-replay TARGET MUTATIONS FILES…` tries each file and MUTATIONS
// mutations of each, always the same ones. `vantage-fuzz-replay --write-seeds tests/fuzz/seeds` rewrites the seeds of
// the program's own files, after a change of their format.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "core/philox.hpp"
#include "fuzz/target.hpp"

namespace vantage::fuzz {
namespace {

using Input = std::vector<std::uint8_t>;

// Makes one to eight changes: bits, odd bytes, numbers; runs copied, inserted or removed; ends cut off.
Input mutated(const Input& seed, RandomStream& random) {
  static constexpr const char* kWords[] = {"nan", "inf",  "-0",  "1e308", "1e-320", "0x1p9", "1,5",
                                           "",    "null", "[[[", "\"\"",  "-1",     "{",     "18446744073709551616"};
  Input out = seed;
  const auto below = [&](std::size_t n) { return n > 0 ? random.bits() % n : 0; };
  for (std::size_t changes = 1 + below(8); changes > 0; --changes) {
    const std::size_t at = below(out.size() + 1);
    const auto here = out.begin() + static_cast<std::ptrdiff_t>(at);
    switch (below(6)) {
      case 0:
        if (at < out.size()) out[at] = static_cast<std::uint8_t>(out[at] ^ (1u << below(8)));
        break;
      case 1:
        if (at < out.size()) out[at] = std::array<std::uint8_t, 6>{0, 0xFF, 0x7F, 0x80, '\n', '9'}[below(6)];
        break;
      case 2: {
        const std::string_view word = kWords[below(std::size(kWords))];
        out.insert(here, word.begin(), word.end());
        break;
      }
      case 3: {
        const std::size_t from = below(out.size()), n = std::min(out.size() - from, below(32));
        const Input run(out.begin() + static_cast<std::ptrdiff_t>(from),
                        out.begin() + static_cast<std::ptrdiff_t>(from + n));
        out.insert(here, run.begin(), run.end());
        break;
      }
      case 4: out.erase(here, here + static_cast<std::ptrdiff_t>(std::min(out.size() - at, below(32)))); break;
      default:
        if (below(4) == 0) out.resize(at);
    }
  }
  return out;
}

// Keeps the current input, to examine a finding.
Input current;
void keep() {
  std::ofstream("fuzz-finding", std::ios::binary)
      .write(reinterpret_cast<const char*>(current.data()), static_cast<std::streamsize>(current.size()));
  std::fprintf(stderr, "the input is in fuzz-finding\n");
}

void run(const Target& target, Input input) {
  current = std::move(input);
  target.run(current);
}

}  // namespace
}  // namespace vantage::fuzz

int main(int argc, char** argv) try {
  using namespace vantage::fuzz;
  if (argc == 3 && std::string_view(argv[1]) == "--write-seeds") {
    for (const auto& [name, bytes] : state_seeds()) {
      std::ofstream out(std::filesystem::path(argv[2]) / name, std::ios::binary);
      if (!out.write(bytes.data(), static_cast<std::streamsize>(bytes.size())).flush())
        throw std::runtime_error(std::string(argv[2]) + "/" + name + " cannot be written");
    }
    return 0;
  }
  if (argc < 4) {
    std::fprintf(stderr, "usage: %s TARGET MUTATIONS FILES... | --write-seeds FOLDER\n", argv[0]);
    return 2;
  }
  std::set_terminate([] {
    keep();
    if (const auto lost = std::current_exception()) try {
        std::rethrow_exception(lost);
      } catch (const std::exception& error) {
        std::fprintf(stderr, "%s\n", error.what());
      } catch (...) {
      }
    std::abort();
  });
  const Target& target = vantage::fuzz::target(argv[1]);
  const unsigned long mutations = std::strtoul(argv[2], nullptr, 10);
  vantage::RandomStream random(1);
  [&]() noexcept {
    for (int k = 3; k < argc; ++k) {
      std::ifstream in(argv[k], std::ios::binary);
      if (!in) std::fprintf(stderr, "%s cannot be read\n", argv[k]), std::exit(2);
      const Input seed{std::istreambuf_iterator<char>(in), {}};
      run(target, seed);
      for (unsigned long n = 0; n < mutations; ++n) run(target, mutated(seed, random));
    }
  }();
  std::printf("%s: %lu inputs\n", target.name, static_cast<unsigned long>(argc - 3) * (1 + mutations));
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 2;
}
