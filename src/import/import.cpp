// SPDX-License-Identifier: Apache-2.0
#include "import/import.hpp"

#include <signal.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <optional>
#include <span>
#include <string_view>

#include "core/atomic_file.hpp"
#include "core/free_memory.hpp"
#include "core/hash.hpp"
#include "core/read_file.hpp"
#include "import/importers.hpp"
#include "vantage/error.hpp"
#include "vantage/version.hpp"

namespace vantage::importers {
namespace {

namespace fs = std::filesystem;

// What a process takes besides what it allocates: code, above all.
constexpr std::uint64_t kCode = std::uint64_t{32} << 20;
constexpr int kRefused = 65, kUnavailable = 69, kMemory = 71;  // of sysexits.h: EX_DATAERR, EX_UNAVAILABLE, EX_OSERR

// Whether it is a whole GLB, by its header.
bool is_glb(std::span<const std::uint8_t> bytes) {
  if (bytes.size() < 20 || std::memcmp(bytes.data(), "glTF", 4) != 0) return false;
  std::uint32_t length = 0;
  std::memcpy(&length, bytes.data() + 8, sizeof length);
  return length == bytes.size();
}

void add_file(Hash& hash, const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::vector<char> block(std::size_t{1} << 20);
  while (stream) {
    stream.read(block.data(), static_cast<std::streamsize>(block.size()));
    hash.add_bytes(block.data(), static_cast<std::size_t>(stream.gcount()));
  }
  if (!stream.eof()) throw Error(Errc::io, file.string() + ": the model cannot be read");
}

// Adds other files that an importer reads: of these formats, only OBJ names some that matter, its material tables.
void add_material_tables(Hash& hash, const fs::path& file) {
  std::ifstream stream(file);
  for (std::string line; std::getline(stream, line);) {
    if (!line.starts_with("mtllib")) continue;
    line.erase(0, std::min(line.find_first_not_of(" \t", 6), line.size()));
    while (!line.empty() && (line.back() == '\r' || line.back() == ' ')) line.pop_back();
    std::error_code failure;
    const fs::path table = file.parent_path() / line;
    if (fs::is_regular_file(table, failure)) add_file(hash, table);
  }
}

// Changes with the model, the importer, what it is told, and this program.
std::string cache_key(const std::vector<fs::path>& files, const Format& format, const Importer& importer,
                      const std::vector<std::string>& settings) {
  Hash hash;
  const std::string_view version = vantage::version(), name = format.name;
  hash.add_bytes(version.data(), version.size());
  hash.add_bytes(name.data(), name.size());
  for (const std::string& setting : settings) hash.add_bytes(setting.c_str(), setting.size() + 1);
  std::error_code failure;  // then both are -1
  hash.add(fs::file_size(importer.program, failure));
  hash.add(fs::last_write_time(importer.program, failure).time_since_epoch().count());
  for (const fs::path& file : files) {
    add_file(hash, file);
    if (name == "OBJ") add_material_tables(hash, file);
  }
  char text[17];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(hash.value()));
  return text;
}

// Empty if the user has none.
fs::path cache_folder() {
  const char* given = std::getenv("XDG_CACHE_HOME");
  if (given && *given == '/') return fs::path(given) / "vantage/imports";
  const char* home = std::getenv("HOME");
  return home && *home == '/' ? fs::path(home) / ".cache/vantage/imports" : fs::path();
}

std::optional<std::vector<std::uint8_t>> cached(const fs::path& entry, const Limits& limits) {
  try {
    RegularFile file(entry);
    if (file.size() > limits.output) return {};
    std::vector<std::uint8_t> glb(file.size());
    file.read(glb.data());
    if (is_glb(glb)) return glb;
  } catch (const Error&) {  // treated as absent
  }
  return {};
}

// A cache that cannot be written only costs time.
void keep(const fs::path& entry, std::span<const std::uint8_t> glb) {
  try {
    fs::create_directories(entry.parent_path());
    write_atomically(entry, {reinterpret_cast<const char*>(glb.data()), glb.size()});
  } catch (const Error&) {
  } catch (const fs::filesystem_error&) {
  }
}

// Upper bound of a reader's time, which grows with the file, on a slow machine. Readers of damaged files may never end.
unsigned seconds_for(const std::vector<fs::path>& files) {
  constexpr double kLeast = 20, kEachMegabyte = 10;
  std::error_code failure;
  double bytes = 0;
  for (const fs::path& file : files) bytes += static_cast<double>(fs::file_size(file, failure));
  return static_cast<unsigned>(std::min(kLeast + kEachMegabyte * bytes / 1e6, 1e6));
}

std::string last_line(std::string text) {
  while (!text.empty() && text.back() == '\n') text.pop_back();
  return text.substr(text.rfind('\n') + 1);
}

// Why an importer gave no GLB.
Error failure_of(const Ended& ended, const std::string& file, const Format& format, const Limits& limits) {
  const std::string who = file + ": the importer of " + format.name, said = last_line(ended.errors);
  constexpr const char* kOtherwise = "; export the model again, or as glTF";
  if (ended.timed_out)
    return Error(Errc::malformed_file, who + " took more than " + std::to_string(limits.wall_s) + " s" + kOtherwise);
  if (ended.signal == SIGXCPU)
    return Error(Errc::malformed_file,
                 who + " took more than " + std::to_string(limits.cpu_s) + " s of computing" + kOtherwise);
  if (ended.too_large)
    return Error(Errc::malformed_file, file + ": as glTF the model would take more than " + bytes_text(limits.output) +
                                           "; export parts of it");
  if (ended.exit_code == kRefused && !said.empty()) return Error(Errc::malformed_file, file + ": " + said);
  if (ended.exit_code == kUnavailable && !said.empty()) return Error(Errc::io, file + ": " + said);
  if (ended.exit_code == kCannotStart)
    return Error(Errc::io, who + " cannot be started" + (said.empty() ? "" : ": " + said) +
                               "; install vantage again, with its importers and their libraries");
  if (ended.exit_code == kMemory)
    return Error(Errc::out_of_memory, who + " needs more memory than the " + bytes_text(limits.memory) +
                                          " that are free; close other programs, or export parts of the model");
  if (ended.signal == SIGINT || ended.signal == SIGTERM || ended.signal == SIGHUP)
    return Error(Errc::io, who + " was stopped (signal " + std::to_string(ended.signal) + ")");
  const std::string how = ended.signal > 0       ? "crashed (signal " + std::to_string(ended.signal) + ")"
                          : ended.exit_code != 0 ? "failed (exit code " + std::to_string(ended.exit_code) + ")"
                                                 : "gave no GLB";
  return Error(Errc::malformed_file, who + " " + how + (said.empty() ? "" : ": " + said) +
                                         "; the file may be damaged: export the model again, or as glTF");
}

}  // namespace

std::vector<std::uint8_t> as_glb(const fs::path& file, const Format& format, Limits limits,
                                 const std::vector<std::string>& settings, const Progress& progress) {
  limits.memory = memory_limit(limits.memory);
  limits.memory -= std::min(limits.memory / 8, kCode);
  std::vector<fs::path> files = files_of(file);
  for (fs::path& one : files) one = fs::absolute(one);
  limits.cpu_s = std::min(limits.cpu_s, seconds_for(files));
  limits.wall_s = std::min(limits.wall_s, 60 + 6 * limits.cpu_s);  // it may have to share the processors
  limits.output = std::min(limits.output, limits.memory);
  Importer importer = [&] {
    try {
      return find_importer(format);
    } catch (const Error& error) {
      throw Error(error.code(), file.string() + ": " + error.what());
    }
  }();
  // The buffers of a textual glTF are other files, which the key does not cover.
  const bool whole =
      std::string_view(format.name) != "compressed glTF" || file.filename().string().find(".gltf") == std::string::npos;
  const fs::path folder = whole ? cache_folder() : fs::path();
  const fs::path entry = folder / (cache_key(files, format, importer, settings) + ".glb");
  if (!folder.empty())
    if (auto glb = cached(entry, limits)) return std::move(*glb);
  importer.words.insert(importer.words.end(), settings.begin(), settings.end());
  for (const fs::path& one : files) {
    importer.words.push_back(one.string());
    importer.readable.push_back(one.parent_path());
    std::error_code failure;
    if (const fs::path target = fs::canonical(one, failure); !failure)
      importer.readable.push_back(target.parent_path());
  }
  Ended ended = run_limited(importer.words, importer.readable, limits, progress);
  if (ended.stopped) return {};
  if (ended.exit_code != 0 || ended.timed_out || ended.too_large || !is_glb(ended.output))
    throw failure_of(ended, file.string(), format, limits);
  if (!folder.empty()) keep(entry, ended.output);
  return std::move(ended.output);
}

}  // namespace vantage::importers
