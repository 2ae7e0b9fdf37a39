// SPDX-License-Identifier: Apache-2.0
#include "import/cloud/lzf.hpp"

#include <cstdint>

#include "import/program.hpp"

namespace vantage::importer {

std::string unpack_lzf(std::string_view packed, std::size_t bytes) {
  std::string out;
  out.reserve(bytes);
  std::size_t at = 0;
  const auto next = [&]() -> std::size_t {
    if (at == packed.size()) throw Refused("its compressed data end too early; copy or export it again");
    return static_cast<std::uint8_t>(packed[at++]);
  };
  const auto check = [&](bool sound) {
    if (!sound) throw Refused("its compressed data are damaged; copy or export it again");
  };
  while (at < packed.size()) {
    const std::size_t control = next();
    if (control < 32) {  // control + 1 bytes follow as they are
      const std::size_t n = control + 1;
      check(n <= packed.size() - at && n <= bytes - out.size());
      out.append(packed.substr(at, n));
      at += n;
      continue;
    }
    std::size_t n = control >> 5;  // repeats n + 2 bytes from before
    if (n == 7) n += next();
    const std::size_t back = ((control & 31) << 8) + next() + 1;
    n += 2;
    check(back <= out.size() && n <= bytes - out.size());
    for (std::size_t k = 0; k < n; ++k) out += out[out.size() - back];
  }
  check(out.size() == bytes);
  return out;
}

}  // namespace vantage::importer
