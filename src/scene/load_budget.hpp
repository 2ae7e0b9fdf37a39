// SPDX-License-Identifier: Apache-2.0
// Memory of loading a scene, asked for before it is taken: a small file may stand for a large scene.
#pragma once

#include <cstdint>
#include <string>

namespace vantage {

class LoadBudget {
 public:
  // `max_memory_bytes` of the whole process, 0: half of what is free. `source` opens messages.
  LoadBudget(std::uint64_t max_memory_bytes, std::string source);

  // Bytes that stay taken until the scene is loaded. Throws Error out_of_memory where they do not fit; `what` takes
  // them.
  void keep(std::uint64_t bytes, const std::string& what);
  // Bytes that are given back soon. Throws likewise.
  void require(std::uint64_t bytes, const std::string& what) const;
  std::uint64_t left() const { return limit_ - kept_; }

 private:
  std::uint64_t limit_, kept_;
  bool given_;
  std::string source_;
};

}  // namespace vantage
