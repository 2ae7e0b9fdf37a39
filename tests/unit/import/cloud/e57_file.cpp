// SPDX-License-Identifier: Apache-2.0
#include "e57_file.hpp"

#include "cloud_files.hpp"
#include "formats/e57_paged_file.hpp"

namespace vantage::test {

std::string packed_bits(const std::vector<std::uint64_t>& values, unsigned bits) {
  std::string bytes;
  std::size_t at = 0;
  for (const std::uint64_t value : values)
    for (unsigned bit = 0; bit < bits; ++bit, ++at) {
      if (at % 8 == 0) bytes += '\0';
      bytes.back() = static_cast<char>(bytes.back() | static_cast<char>((value >> bit & 1) << at % 8));
    }
  return bytes;
}

void write_e57(const std::filesystem::path& path, const std::vector<E57TestScan>& scans, const std::string& root) {
  E57PagedFile file(path);
  std::string xml =
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<e57Root type=\"Structure\" "
      "xmlns=\"http://www.astm.org/COMMIT/E57/2010-e57-v1.0\">" +
      root + "<data3D type=\"Vector\">";
  for (const E57TestScan& scan : scans) {
    file.align();
    std::string packets;
    for (const auto& streams : scan.packets) {
      std::string packet = {'\1', '\0'};
      std::string body;
      put(body, static_cast<std::uint16_t>(streams.size()));
      for (const std::string& stream : streams) put(body, static_cast<std::uint16_t>(stream.size()));
      for (const std::string& stream : streams) body += stream;
      while ((4 + body.size()) % 4 != 0) body += '\0';
      put(packet, static_cast<std::uint16_t>(4 + body.size() - 1));
      packets += packet + body;
    }
    file.begin_patchable_page();
    const std::uint64_t section = file.physical();
    std::string header(8, '\0');
    header[0] = 1;
    put(header, static_cast<std::uint64_t>(32 + packets.size()));
    put(header, section + 32);
    put(header, std::uint64_t{0});
    file.write(header + packets);
    xml += "<vectorChild type=\"Structure\">" + scan.head + "<points type=\"CompressedVector\" fileOffset=\"" +
           std::to_string(section) + "\" recordCount=\"" + std::to_string(scan.count) +
           "\"><prototype type=\"Structure\">" + scan.prototype + "</prototype></points></vectorChild>";
  }
  xml += "</data3D></e57Root>";
  const std::uint64_t address = file.physical();
  file.write(xml);
  std::string header = "ASTM-E57";
  put(header, std::uint32_t{1}), put(header, std::uint32_t{0});
  put(header, file.physical_length()), put(header, address), put(header, static_cast<std::uint64_t>(xml.size()));
  put(header, static_cast<std::uint64_t>(E57PagedFile::kPageBytes));
  file.close(header);
}

}  // namespace vantage::test
