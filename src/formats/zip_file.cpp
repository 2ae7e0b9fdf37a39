// SPDX-License-Identifier: Apache-2.0
#include "formats/zip_file.hpp"

#include <zip.h>

#include <algorithm>
#include <cstring>

#include "vantage/error.hpp"

namespace vantage {
namespace {

// Memory that minizip writes to, in place of a file.
struct Memory {
  std::string bytes;
  std::size_t at = 0;
};

Memory& memory(voidpf stream) { return *static_cast<Memory*>(stream); }

voidpf open(voidpf opaque, const void*, int) { return opaque; }
uLong read(voidpf, voidpf, void*, uLong) { return 0; }  // nothing is appended to an archive that is there
uLong write(voidpf, voidpf stream, const void* data, uLong size) {
  Memory& to = memory(stream);
  to.bytes.resize(std::max<std::size_t>(to.bytes.size(), to.at + size));
  std::memcpy(to.bytes.data() + to.at, data, size);
  to.at += size;
  return size;
}
ZPOS64_T tell(voidpf, voidpf stream) { return memory(stream).at; }
long seek(voidpf, voidpf stream, ZPOS64_T offset, int origin) {
  Memory& in = memory(stream);
  const std::size_t from = origin == ZLIB_FILEFUNC_SEEK_CUR   ? in.at
                           : origin == ZLIB_FILEFUNC_SEEK_END ? in.bytes.size()
                                                              : 0;
  in.at = from + offset;
  return 0;
}
int close(voidpf, voidpf) { return 0; }
int error(voidpf, voidpf) { return 0; }

void require(int result) {
  if (result != ZIP_OK)
    throw Error(Errc::io, "a ZIP archive could not be made: minizip tells error " + std::to_string(result));
}

}  // namespace

std::string zip_archive(std::span<const std::pair<std::string, std::string>> files) {
  constexpr uLong kFirstDate = 1u << 21 | 1u << 16;  // the first day that a ZIP can tell
  Memory memory;
  zlib_filefunc64_def functions{open, read, write, tell, seek, close, error, &memory};
  const zipFile zip = zipOpen2_64("", APPEND_STATUS_CREATE, nullptr, &functions);
  if (!zip) throw Error(Errc::io, "a ZIP archive could not be made: minizip has no memory");
  zip_fileinfo info{};
  info.dosDate = kFirstDate;
  for (const auto& [name, text] : files) {
    require(zipOpenNewFileInZip(zip, name.c_str(), &info, nullptr, 0, nullptr, 0, nullptr, Z_DEFLATED,
                                Z_DEFAULT_COMPRESSION));
    require(zipWriteInFileInZip(zip, text.data(), static_cast<unsigned>(text.size())));
    require(zipCloseFileInZip(zip));
  }
  require(zipClose(zip, nullptr));
  return std::move(memory.bytes);
}

}  // namespace vantage
