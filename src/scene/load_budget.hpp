// SPDX-License-Identifier: Apache-2.0
// Checks the memory for loading a scene before it is allocated, since a small file may describe a large scene.
#pragma once

#include <cstdint>
#include <string>

namespace vantage {

class LoadBudget {
 public:
  // `max_memory_bytes` of the whole process; 0: half of the free memory. Messages begin with `source`.
  LoadBudget(std::uint64_t max_memory_bytes, std::string source);

  // Reserves bytes until the scene is loaded. Throws Error out_of_memory if they do not fit; `what` names their use.
  void keep(std::uint64_t bytes, const std::string& what);
  // Checks for bytes that are freed soon. Throws likewise.
  void require(std::uint64_t bytes, const std::string& what) const;
  std::uint64_t left() const { return limit_ - kept_; }

 private:
  std::uint64_t limit_, kept_;
  bool given_;
  std::string source_;
};

}  // namespace vantage
