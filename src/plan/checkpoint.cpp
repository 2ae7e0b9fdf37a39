// SPDX-License-Identifier: Apache-2.0
#include "plan/checkpoint.hpp"

#include <cstring>
#include <exception>
#include <sstream>
#include <string_view>
#include <system_error>
#include <type_traits>

#include "core/atomic_file.hpp"
#include "core/hash.hpp"
#include "core/read_file.hpp"
#include "vantage/error.hpp"

namespace vantage {
namespace {

constexpr std::string_view kMagic = "vantage checkpoint\n";
constexpr std::uint32_t kVersion = 4;

struct Writer {
  std::string bytes;
  template <class T>
  requires std::is_arithmetic_v<T>
  void put(T value) { bytes.append(reinterpret_cast<const char*>(&value), sizeof value); }
  void put(std::string_view text) {
    put(std::uint64_t{text.size()});
    bytes.append(text);
  }
  void put(const std::vector<double>& values) {
    put(std::uint64_t{values.size()});
    for (const double value : values) put(value);
  }
};

class Reader {
 public:
  Reader(std::string_view bytes, const std::filesystem::path& file) : left_(bytes), file_(file) {}
  template <class T>
  T get() {
    T value;
    std::memcpy(&value, take(sizeof value).data(), sizeof value);
    return value;
  }
  std::vector<double> reals() {
    std::vector<double> values(length(sizeof(double)));
    for (double& value : values) value = get<double>();
    return values;
  }
  std::string text() { return std::string(take(get<std::uint64_t>())); }
  // A length that the rest of the file can hold, so that damage cannot ask for all memory.
  std::uint64_t length(std::size_t bytes_each) {
    const auto n = get<std::uint64_t>();
    if (n > left_.size() / bytes_each) damaged();
    return n;
  }
  bool at_end() const { return left_.empty(); }
  [[noreturn]] void damaged() const {
    throw Error(Errc::malformed_file, "checkpoint " + file_.string() + " is damaged; start again without resuming");
  }

 private:
  std::string_view take(std::uint64_t bytes) {
    if (bytes > left_.size()) damaged();
    const auto taken = left_.substr(0, bytes);
    left_.remove_prefix(bytes);
    return taken;
  }
  std::string_view left_;
  const std::filesystem::path& file_;
};

std::uint64_t checksum(std::string_view bytes) {
  Hash hash;
  hash.add_bytes(bytes.data(), bytes.size());
  return hash.value();
}

}  // namespace

std::filesystem::path checkpoint_before(const std::filesystem::path& file) {
  return std::filesystem::path(file).concat(".before");
}

void write_checkpoint(const std::filesystem::path& file, const Checkpoint& checkpoint, bool keep_before) {
  Writer w;
  w.put(std::string_view(checkpoint.identity));
  w.put(checkpoint.seconds), w.put(checkpoint.trace_seconds);
  const SearchSnapshot& snapshot = checkpoint.snapshot;
  w.put(std::string_view(snapshot.optimiser));
  w.put(snapshot.drawn), w.put(snapshot.redrawn);
  const GrowingSample::State& sample = snapshot.sample;
  w.put(sample.step), w.put(sample.since), w.put(sample.from), w.put(sample.renewed), w.put(snapshot.sample_error);
  w.put(std::uint64_t{snapshot.memory.looks.size()});
  for (const auto& errors : snapshot.memory.looks) {
    w.put(std::uint64_t{errors.size()});
    for (const LookError& error : errors) w.put(error.mean), w.put(error.deviation);
  }
  w.put(std::uint64_t{snapshot.memory.known.size()});
  for (const auto& [x, measured] : snapshot.memory.known) w.put(x), w.put(measured.sum), w.put(measured.count);
  w.put(snapshot.memory.shift);
  w.put(std::uint64_t{snapshot.history.size()});
  for (const PlanIteration& line : snapshot.history) {
    w.put(std::uint64_t{line.iteration}), w.put(std::uint64_t{line.evaluations}), w.put(line.hypervolume),
        w.put(line.seconds);
    w.put(std::uint64_t{line.front.size()});
    for (const auto& f : line.front) w.put(f);
  }
  w.put(std::uint64_t{checkpoint.since.size()});
  for (const auto& values : checkpoint.since) w.put(values);

  Writer head;
  head.put(kVersion), head.put(std::uint64_t{w.bytes.size()}), head.put(checksum(w.bytes));
  AtomicFile out(file);
  out.write(kMagic), out.write(head.bytes), out.write(w.bytes);
  out.settle();
  std::error_code ignored;  // one less to fall back on
  if (keep_before) std::filesystem::rename(file, checkpoint_before(file), ignored);
  out.commit();
}

Checkpoint parse_checkpoint(std::string_view bytes, const std::filesystem::path& file) {
  if (!bytes.starts_with(kMagic)) throw Error(Errc::malformed_file, file.string() + " is no checkpoint of vantage");

  Reader head(bytes.substr(kMagic.size()), file);
  const auto version = head.get<std::uint32_t>();
  if (version != kVersion)
    throw Error(Errc::malformed_file, "checkpoint " + file.string() + " has format " + std::to_string(version) +
                                          ", this is " + std::to_string(kVersion) +
                                          "; resume with the vantage that wrote it, or start again");
  const auto size = head.get<std::uint64_t>();
  const auto sum = head.get<std::uint64_t>();
  const std::string_view body = bytes.substr(kMagic.size() + sizeof version + sizeof size + sizeof sum);
  if (body.size() != size || checksum(body) != sum) head.damaged();

  Reader r(body, file);
  Checkpoint checkpoint;
  checkpoint.identity = r.text();
  checkpoint.seconds = r.get<double>(), checkpoint.trace_seconds = r.get<double>();
  SearchSnapshot& snapshot = checkpoint.snapshot;
  snapshot.optimiser = r.text();
  snapshot.drawn = r.get<std::uint64_t>(), snapshot.redrawn = r.get<std::uint64_t>();
  GrowingSample::State& sample = snapshot.sample;
  sample.step = r.get<std::uint64_t>(), sample.since = r.get<std::uint64_t>();
  sample.from = r.get<std::uint64_t>(), sample.renewed = r.get<std::uint64_t>();
  snapshot.sample_error = r.get<double>();
  snapshot.memory.looks.resize(r.length(8));
  for (auto& errors : snapshot.memory.looks) {
    errors.resize(r.length(16));
    for (LookError& error : errors) error.mean = r.get<double>(), error.deviation = r.get<double>();
  }
  for (std::uint64_t left = r.length(24); left > 0; --left) {
    std::vector<double> x = r.reals();
    SampleMemory::Measurements& measured = snapshot.memory.known[std::move(x)];
    measured.sum = r.reals(), measured.count = r.get<std::uint64_t>();
  }
  snapshot.memory.shift = r.reals();
  snapshot.history.resize(r.length(40));
  for (PlanIteration& line : snapshot.history) {
    line.iteration = r.get<std::uint64_t>(), line.evaluations = r.get<std::uint64_t>();
    line.hypervolume = r.get<double>(), line.seconds = r.get<double>();
    line.front.resize(r.length(8));
    for (auto& f : line.front) f = r.reals();
  }
  checkpoint.since.resize(r.length(8));
  for (auto& values : checkpoint.since) values = r.reals();
  if (!r.at_end()) r.damaged();
  return checkpoint;
}

std::optional<Checkpoint> read_checkpoint(const std::filesystem::path& file) {
  std::error_code missing;
  if (!std::filesystem::exists(file, missing)) return std::nullopt;
  return parse_checkpoint(read_file(file), file);
}

std::optional<FoundCheckpoint> newest_checkpoint(const std::filesystem::path& file) {
  std::string why = "there is no " + file.string();
  std::exception_ptr failure;
  try {
    if (auto newest = read_checkpoint(file)) return FoundCheckpoint{.checkpoint = *std::move(newest)};
  } catch (const Error& error) {
    failure = std::current_exception();
    why = error.what();
  }
  try {
    if (auto before = read_checkpoint(checkpoint_before(file)))
      return FoundCheckpoint{.checkpoint = *std::move(before), .is_before = true, .why = std::move(why)};
  } catch (const Error&) {
    if (!failure) throw;
  }
  if (failure) std::rethrow_exception(failure);
  return std::nullopt;
}

void require_same_run(const std::filesystem::path& file, const std::string& found, const std::string& wanted) {
  if (found == wanted) return;
  std::istringstream old_lines(found), new_lines(wanted);
  std::vector<std::string> differences;
  for (std::string before, now; true;) {
    const bool more_before = static_cast<bool>(std::getline(old_lines, before));
    const bool more_now = static_cast<bool>(std::getline(new_lines, now));
    if (!more_before && !more_now) break;
    if (!more_before) before = "nothing";
    if (!more_now) now = "nothing";
    if (before != now || more_before != more_now)
      differences.push_back("the checkpoint has " + before + ", this run " + now);
  }
  throw Error(Errc::invalid_argument,
              "checkpoint " + file.string() + " belongs to another run: " + differences.front() +
                  (differences.size() > 1 ? " (and " + std::to_string(differences.size() - 1) + " more)" : "") +
                  "; repeat its parameters, or start again without resuming",
              differences);
}

}  // namespace vantage
