// SPDX-License-Identifier: Apache-2.0
#include "import/gltf/source.hpp"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <iterator>
#include <limits>

#include "import/program.hpp"

namespace vantage::importer {
namespace {

using nlohmann::json;

std::string read_all(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw Refused("it names the file " + file.filename().string() + ", which cannot be read");
  return {std::istreambuf_iterator<char>(stream), {}};
}

std::string inflated(const std::string& packed) {
  constexpr std::size_t kMost = std::size_t{1} << 32;  // no GLB is larger
  z_stream stream{};
  constexpr int kGzip = 16;
  if (inflateInit2(&stream, kGzip + MAX_WBITS) != Z_OK) throw std::bad_alloc();
  std::string out, block(std::size_t{1} << 20, '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data()));
  int status = Z_OK;
  for (std::size_t left = packed.size(); status == Z_OK && out.size() < kMost;) {
    const auto given = static_cast<uInt>(std::min<std::size_t>(left, std::size_t{1} << 30));
    stream.avail_in = given;
    stream.next_out = reinterpret_cast<Bytef*>(block.data());
    stream.avail_out = static_cast<uInt>(block.size());
    status = inflate(&stream, Z_NO_FLUSH);
    left -= given - stream.avail_in;
    out.append(block.data(), block.size() - stream.avail_out);
    if (status == Z_OK && left == 0 && stream.avail_out > 0) status = Z_BUF_ERROR;  // cut off
  }
  inflateEnd(&stream);
  if (status != Z_STREAM_END) throw Refused("the gzip file is damaged or cut off; copy it again");
  return out;
}

std::uint32_t word_at(std::string_view bytes, std::size_t offset) {
  std::uint32_t value = 0;  // little endian, like the host
  std::memcpy(&value, part_of(bytes, offset, sizeof value).data(), sizeof value);
  return value;
}

std::string from_base64(std::string_view text) {
  std::array<int, 256> digits;
  digits.fill(-1);
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  for (std::size_t i = 0; i < kDigits.size(); ++i) digits[static_cast<unsigned char>(kDigits[i])] = static_cast<int>(i);
  std::string out;
  out.reserve(text.size() / 4 * 3);
  std::uint32_t bits = 0;
  int count = 0;
  for (const char c : text) {
    if (c == '=') break;
    const int digit = digits[static_cast<unsigned char>(c)];
    if (digit < 0) throw Refused("a data URI is not base64");
    bits = bits << 6 | static_cast<std::uint32_t>(digit);
    count += 6;
    if (count >= 8) out += static_cast<char>(bits >> (count -= 8) & 0xFF);
  }
  return out;
}

std::string percent_decoded(const std::string& uri) {
  std::string out;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    const std::string digits = uri.substr(std::min(i + 1, uri.size()), 2);
    if (uri[i] == '%' && digits.size() == 2 &&
        digits.find_first_not_of("0123456789abcdefABCDEF") == std::string::npos) {
      out += static_cast<char>(std::stoi(digits, nullptr, 16));
      i += 2;
    } else {
      out += uri[i];
    }
  }
  return out;
}

// Puts the binary chunk into `binary`.
json read_container(std::string_view bytes, std::string& binary) {
  constexpr std::uint32_t kJson = 0x4E4F534A, kBinary = 0x004E4942;
  if (bytes.starts_with("b3dm")) {
    std::size_t at = 28;  // the header, then four tables
    for (std::size_t table = 0; table < 4; ++table) at += word_at(bytes, 12 + 4 * table);
    const json features = json::parse(part_of(bytes, 28, word_at(bytes, 12)), nullptr, false);
    json document = read_container(part_of(bytes, at, std::max(bytes.size(), at) - at), binary);
    if (features.is_object() && features.contains("RTC_CENTER"))
      document["extensions"]["CESIUM_RTC"]["center"] = features["RTC_CENTER"];
    return document;
  }
  if (!bytes.starts_with("glTF")) return json::parse(bytes);
  if (word_at(bytes, 4) != 2)
    throw Refused("it is a GLB of version " + std::to_string(word_at(bytes, 4)) + "; export glTF 2.0");
  json document;
  for (std::size_t at = 12; at + 8 <= bytes.size();) {
    const std::string_view chunk = part_of(bytes, at + 8, word_at(bytes, at));
    if (word_at(bytes, at + 4) == kJson && document.is_null()) document = json::parse(chunk);
    if (word_at(bytes, at + 4) == kBinary && binary.empty()) binary = chunk;
    at += 8 + chunk.size();
  }
  return document;
}

}  // namespace

std::string_view part_of(std::string_view bytes, std::size_t offset, std::size_t length) {
  if (offset > bytes.size() || length > bytes.size() - offset)
    throw Refused("bytes " + std::to_string(offset) + " + " + std::to_string(length) + " are wanted of " +
                  std::to_string(bytes.size()) + "; the file is damaged or cut off");
  return bytes.substr(offset, length);
}

std::string read_uri(const Source& source, const std::string& uri) {
  if (uri.starts_with("data:")) {
    const std::size_t comma = uri.find(',');
    if (comma == std::string::npos || !uri.substr(0, comma).ends_with(";base64"))
      throw Refused("it has a data URI that is not base64");
    return from_base64(std::string_view(uri).substr(comma + 1));
  }
  const std::filesystem::path name = percent_decoded(uri);
  if (name.is_absolute() || uri.find("://") != std::string::npos)
    throw Refused("it names " + uri + "; only files below its own folder are read");
  const auto file = std::filesystem::weakly_canonical(source.folder / name);
  const auto folder = std::filesystem::weakly_canonical(source.folder);
  if (std::mismatch(folder.begin(), folder.end(), file.begin(), file.end()).first != folder.end())
    throw Refused("it names " + uri + "; only files below its own folder are read");
  return read_all(file);
}

Source read_source(const std::filesystem::path& file) {
  std::string bytes = read_all(file), binary;
  const bool packed = bytes.starts_with("\x1F\x8B");
  if (packed) bytes = inflated(bytes);
  if (packed && !bytes.starts_with("glTF") && !bytes.starts_with("b3dm") &&
      bytes.find_first_not_of(" \t\r\n") != bytes.find('{'))
    throw Refused("this gzip file holds no glTF; unpack it with gunzip and give its content");
  Source source;
  source.folder = file.parent_path();
  source.document = read_container(bytes, binary);
  if (!source.document.is_object()) throw Refused("it has no JSON object, so it is not a glTF");
  for (const json& buffer : source.document.value("buffers", json::array())) {
    if (buffer.contains("uri"))
      source.buffers.push_back(read_uri(source, buffer["uri"].get<std::string>()));
    else  // a buffer without a URI is the GLB's, or stands for decoded bytes
      source.buffers.push_back(source.buffers.empty() ? binary : std::string());
  }
  return source;
}

}  // namespace vantage::importer
