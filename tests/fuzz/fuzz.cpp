// SPDX-License-Identifier: Apache-2.0
// Entry points of libFuzzer: vantage-fuzz --target=NAME CORPUS…, or under a name that ends with the target's.
#include <cstdio>
#include <cstdlib>
#include <stdexcept>
#include <string>

#include "fuzz/target.hpp"

namespace {
const vantage::fuzz::Target* chosen = nullptr;
}

extern "C" int LLVMFuzzerInitialize(int* argc, char*** argv) {
  std::string name;
  for (int k = 1; k < *argc; ++k)
    if (const std::string word = (*argv)[k]; word.starts_with("--target=")) name = word.substr(9);
  try {
    chosen = &vantage::fuzz::target(name);
  } catch (const std::invalid_argument& error) {
    std::fprintf(stderr, "--target=NAME: %s\n", error.what());
    std::exit(2);
  }
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  chosen->run({data, size});
  return 0;
}
