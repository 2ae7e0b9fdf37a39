// SPDX-License-Identifier: Apache-2.0
// Calls of the disk that fail when they are told to. Linked into a test they stand before the C library's; as a library
// for LD_PRELOAD they do so in any program, which is then told by the environment.
#pragma once

#include <string>

namespace vantage::test {

struct DiskFault {
  std::string below =
      {};         // calls on paths that begin so are counted: open for writing, write, pwrite, fsync, rename, mkdir
  int nth = 0;    // the call that fails, from 1; 0: none
  int error = 0;  // with this errno; 0: the process is killed, a write having been done by half
  bool stays = false;  // and all later calls too, as on a full disk
};

// From now on; calls are counted from 0 again.
void set_disk_fault(const DiskFault& fault);
int disk_calls();

// Of a program: VANTAGE_DISK_FAULT="NTH ERROR STAYS SIGN BELOW"; the file SIGN appears when the call is reached;
// with NTH 0 it holds the number of calls at the end.
inline constexpr const char* kDiskFaultVariable = "VANTAGE_DISK_FAULT";

}  // namespace vantage::test
