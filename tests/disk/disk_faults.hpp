// SPDX-License-Identifier: Apache-2.0
// Disk calls that fail on request. Linked into a test they replace the C library's; as a library for LD_PRELOAD they do
// so in any program, controlled by the environment.
#pragma once

#include <string>

namespace vantage::test {

struct DiskFault {
  std::string below =
      {};              // counts calls on paths with this prefix: open for writing, write, pwrite, fsync, rename, mkdir
  int nth = 0;         // the call that fails, from 1; 0: none
  int error = 0;       // errno of the failure; 0: the process is killed, after half of a write
  bool stays = false;  // all later calls fail, too, as on a full disk
};

// Takes effect at once; calls are counted from 0 again.
void set_disk_fault(const DiskFault& fault);
int disk_calls();

// For a program: VANTAGE_DISK_FAULT="NTH ERROR STAYS SIGN BELOW". The file SIGN appears when the call is reached; with
// NTH 0 it holds the number of calls at the end.
inline constexpr const char* kDiskFaultVariable = "VANTAGE_DISK_FAULT";

}  // namespace vantage::test
