// SPDX-License-Identifier: Apache-2.0
#include "import/import.hpp"

#include <signal.h>
#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <cstring>
#include <optional>
#include <set>
#include <span>
#include <string_view>

#include "core/atomic_file.hpp"
#include "core/crc32c.hpp"
#include "core/free_memory.hpp"
#include "core/hash.hpp"
#include "core/read_file.hpp"
#include "import/importers.hpp"
#include "vantage/error.hpp"
#include "vantage/version.hpp"

namespace vantage::importers {
namespace {

namespace fs = std::filesystem;

// Memory of a process besides what it allocates, mainly code.
constexpr std::uint64_t kCode = std::uint64_t{32} << 20;
constexpr int kRefused = 65, kUnavailable = 69, kMemory = 71;  // of sysexits.h: EX_DATAERR, EX_UNAVAILABLE, EX_OSERR

// Returns true if its header is that of a complete GLB.
bool is_glb(std::span<const std::uint8_t> bytes) {
  if (bytes.size() < 20 || std::memcmp(bytes.data(), "glTF", 4) != 0) return false;
  std::uint32_t length = 0;
  std::memcpy(&length, bytes.data() + 8, sizeof length);
  return length == bytes.size();
}

// Bytes that are read for a key, of all files together. Files beyond them count by what their folder says of them, as a
// key must not take longer than the import.
constexpr std::uint64_t kMostRead = std::uint64_t{1} << 30;

// Collects the names of material tables in the blocks of an OBJ, the only format here whose other files matter.
class TableNames {
 public:
  void add(std::string_view block) {
    while (!block.empty()) {
      const std::size_t end = block.find('\n');
      const std::string_view part = block.substr(0, end);
      other_ = other_ || (line_.empty() && part.size() >= kWord.size() && !part.starts_with(kWord)) ||
               line_.size() + part.size() > kLongest;
      if (!other_) line_ += part;
      if (end == std::string_view::npos) return;
      end_line();
      block.remove_prefix(end + 1);
    }
  }
  const std::set<std::string>& finish() {
    end_line();
    return names_;
  }

 private:
  static constexpr std::string_view kWord = "mtllib";
  static constexpr std::size_t kLongest = 4096;  // longest path
  static constexpr std::size_t kMost = 1000;

  void end_line() {
    if (!other_ && line_.starts_with(kWord) && names_.size() < kMost) {
      line_.erase(0, std::min(line_.find_first_not_of(" \t", kWord.size()), line_.size()));
      while (!line_.empty() && (line_.back() == '\r' || line_.back() == ' ')) line_.pop_back();
      names_.insert(line_);
    }
    line_.clear(), other_ = false;
  }

  std::set<std::string> names_;
  std::string line_;    // the beginning of the open line
  bool other_ = false;  // it begins otherwise, so that it names no table
};

// Returns true if a file lies below a folder, after following links.
bool is_below(const fs::path& file, const fs::path& folder) {
  std::error_code failure;
  const fs::path inner = fs::canonical(file, failure);
  if (failure) return false;
  const fs::path outer = fs::canonical(folder, failure);
  if (failure) return false;
  return std::mismatch(outer.begin(), outer.end(), inner.begin(), inner.end()).first == outer.end();
}

struct Stopped {};

// Hashes what an importer reads. Throws Stopped, or Error io if a file cannot be read or is not regular.
class KeyReader {
 public:
  explicit KeyReader(const Progress& progress) : progress_(progress) {}

  void add(std::string_view text) { hash_.add_bytes(text.data(), text.size()); }
  template <class Number>
  void add_number(Number number) {
    hash_.add(number);
  }
  void add_model(const fs::path& file, bool names_tables) {
    TableNames tables;
    read(file, names_tables ? &tables : nullptr);
    for (const std::string& name : tables.finish()) {
      if (progress_.stopped()) throw Stopped{};
      std::error_code failure;
      const fs::path table = file.parent_path() / name;
      if (!fs::is_regular_file(table, failure) || !is_below(table, file.parent_path())) continue;
      read(table, nullptr);
      tables_.push_back(table);
    }
  }
  const std::vector<fs::path>& tables() const { return tables_; }
  std::string text() const {
    char text[17];
    std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(hash_.value()));
    return text;
  }

 private:
  void read(const fs::path& path, TableNames* tables) {
    RegularFile file(path, "the model cannot be read");
    hash_.add(file.size());
    if (file.size() > kMostRead - read_) {
      std::error_code failure;
      add(path.string());
      hash_.add(fs::last_write_time(path, failure).time_since_epoch().count());
      if (!tables) return;
    }
    while (read_ < kMostRead) {
      if (progress_.stopped()) throw Stopped{};
      const std::size_t got = file.read_next(block_.data(), std::min<std::uint64_t>(block_.size(), kMostRead - read_));
      if (got == 0) return;
      read_ += got;
      hash_.add_bytes(block_.data(), got);
      if (tables) tables->add({block_.data(), got});
    }
  }

  const Progress& progress_;
  Hash hash_;
  std::vector<fs::path> tables_;
  std::uint64_t read_ = 0;
  std::vector<char> block_ = std::vector<char>(std::size_t{1} << 20);
};

struct Key {
  std::string text;
  std::vector<fs::path> tables;  // files that the model names and its importer may read
};

// Returns a key that changes with the model, the importer, its settings, and this program. Throws as KeyReader.
Key cache_key(const fs::path& model, const std::vector<fs::path>& files, const Format& format, const Importer& importer,
              const std::vector<std::string>& settings, const Progress& progress) {
  KeyReader key(progress);
  const std::string_view name = format.name;
  key.add(vantage::version());
  key.add(name);
  for (const std::string& setting : settings) key.add(setting);
  std::error_code failure;  // on failure, both numbers are -1
  key.add_number(fs::file_size(importer.program, failure));
  key.add_number(fs::last_write_time(importer.program, failure).time_since_epoch().count());
  // Storeys and scans of several files take these files' names.
  const bool named = files.size() > 1 || fs::is_directory(model, failure);
  for (const fs::path& file : files) {
    if (named) key.add(file.filename().string());
    key.add_model(file, name == "OBJ");
  }
  return {key.text(), key.tables()};
}

// Returns an empty path if the user has no cache folder.
fs::path cache_folder() {
  const char* given = std::getenv("XDG_CACHE_HOME");
  if (given && *given == '/') return fs::path(given) / "vantage/imports";
  const char* home = std::getenv("HOME");
  return home && *home == '/' ? fs::path(home) / ".cache/vantage/imports" : fs::path();
}

// Follows the GLB of a cache entry: the key of the entry, and a checksum.
struct Seal {
  std::array<char, 16> key{};
  std::uint32_t checksum = 0;

  Seal() = default;
  Seal(const fs::path& entry, std::span<const std::uint8_t> glb) : checksum(crc32c(glb.data(), glb.size())) {
    const std::string name = entry.stem().string();
    std::copy_n(name.begin(), std::min(name.size(), key.size()), key.begin());
  }
  friend bool operator==(const Seal&, const Seal&) = default;
};

// Returns nothing if there is no entry, or if it is not as it was written.
std::optional<std::vector<std::uint8_t>> cached(const fs::path& entry, const Limits& limits) {
  try {
    RegularFile file(entry);
    if (file.size() < sizeof(Seal) || file.size() - sizeof(Seal) > limits.output) return {};
    std::vector<std::uint8_t> glb(file.size());
    file.read(glb.data());
    Seal seal;
    std::memcpy(&seal, glb.data() + glb.size() - sizeof seal, sizeof seal);
    glb.resize(glb.size() - sizeof seal);
    if (is_glb(glb) && seal == Seal(entry, glb)) return glb;
  } catch (const Error&) {  // treated as absent
  }
  return {};
}

// Only the user may read it, since a model may be confidential. A cache that cannot be written only costs time.
void keep(const fs::path& entry, std::span<const std::uint8_t> glb) {
  try {
    fs::create_directories(entry.parent_path());
    AtomicFile file(entry, 0600);
    const Seal seal(entry, glb);
    file.write(glb.data(), glb.size());
    file.write(&seal, sizeof seal);
    file.commit();
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

// Returns the reason why an importer gave no GLB.
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
  rlimit space{};
  if (said.empty() && getrlimit(RLIMIT_AS, &space) == 0 && space.rlim_cur != RLIM_INFINITY)
    return Error(Errc::out_of_memory,
                 who + " ended early, perhaps since this process is limited to an address space of " +
                     bytes_text(space.rlim_cur) + " (ulimit -v): raise that limit; or the file is damaged");
  const std::string how = ended.signal > 0       ? "crashed (signal " + std::to_string(ended.signal) + ")"
                          : ended.exit_code != 0 ? "failed (exit code " + std::to_string(ended.exit_code) + ")"
                                                 : "gave no GLB";
  return Error(Errc::malformed_file, who + " " + how + (said.empty() ? "" : ": " + said) +
                                         "; the file may be damaged: export the model again, or as glTF");
}

}  // namespace

std::vector<std::uint8_t> as_glb(const fs::path& file, const Format& format, Limits limits,
                                 const std::vector<std::string>& settings, const Progress& progress,
                                 const std::vector<std::string>& beside) {
  limits.memory = memory_limit(limits.memory);
  limits.memory -= std::min(limits.memory / 8, kCode);
  std::vector<fs::path> files = files_of(file, beside);
  for (fs::path& one : files) one = fs::absolute(one);
  limits.cpu_s = std::min(limits.cpu_s, seconds_for(files));
  limits.wall_s = std::min(limits.wall_s, 60 + 6 * limits.cpu_s);  // it may share the processors with others
  limits.output = std::min(limits.output, limits.memory);
  Importer importer = [&] {
    try {
      return find_importer(format);
    } catch (const Error& error) {
      throw Error(error.code(), file.string() + ": " + error.what());
    }
  }();
  // The buffers of a textual glTF are separate files below its folder, which the key does not cover.
  const bool whole =
      std::string_view(format.name) != "compressed glTF" || file.filename().string().find(".gltf") == std::string::npos;
  const fs::path folder = whole ? cache_folder() : fs::path();
  fs::path entry;
  std::vector<fs::path> readable = files;
  if (whole) {
    try {
      const Key key = cache_key(file, files, format, importer, settings, progress);
      entry = folder / (key.text + ".glb");
      readable.insert(readable.end(), key.tables.begin(), key.tables.end());
    } catch (const Stopped&) {
      return {};
    }
  } else {
    readable.push_back(files.front().parent_path());
  }
  if (!folder.empty())
    if (auto glb = cached(entry, limits)) return std::move(*glb);
  importer.words.insert(importer.words.end(), settings.begin(), settings.end());
  for (const fs::path& one : files) importer.words.push_back(one.string());
  limits.spawns = importer.spawns;
  Ended ended = run_limited(importer.words, importer.readable, readable, limits, progress);
  if (ended.stopped) return {};
  if (ended.exit_code != 0 || ended.timed_out || ended.too_large || !is_glb(ended.output))
    throw failure_of(ended, file.string(), format, limits);
  if (!folder.empty()) keep(entry, ended.output);
  return std::move(ended.output);
}

}  // namespace vantage::importers
