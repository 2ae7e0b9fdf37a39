// SPDX-License-Identifier: Apache-2.0
#include "search/checkpoint.hpp"

#include <exception>
#include <sstream>
#include <string_view>
#include <system_error>

#include "core/archive.hpp"
#include "core/atomic_file.hpp"
#include "core/read_file.hpp"
#include "vantage/error.hpp"

namespace vantage {
namespace {

constexpr ArchiveFormat kFormat{"vantage checkpoint\n", 5};

// `Archive` is an ArchiveWriter or an ArchiveReader.
template <class Archive, class T>
void pass(Archive& archive, T& checkpoint) {
  const auto reals = [&](auto& values) { archive.array(values); };
  archive.text(checkpoint.identity);
  archive.raw(checkpoint.seconds), archive.raw(checkpoint.trace_seconds);
  auto& snapshot = checkpoint.snapshot;
  archive.text(snapshot.optimiser), archive.text(snapshot.evaluator);
  archive.whole(snapshot.drawn), archive.whole(snapshot.redrawn);
  // None is empty. Lists of empty ones would take far more memory than bytes in a file.
  constexpr std::size_t kLeastRealsBytes = 1 + sizeof(double);
  constexpr std::size_t kLeastLineBytes = 19;  // two counts, two reals, a length
  archive.list(snapshot.history, kLeastLineBytes, [&](auto& line) {
    archive.whole(line.iteration), archive.whole(line.evaluations);
    archive.raw(line.hypervolume), archive.raw(line.seconds);
    archive.list(line.front, kLeastRealsBytes, reals);
  });
  archive.list(checkpoint.since, kLeastRealsBytes, reals);
}

}  // namespace

std::filesystem::path checkpoint_before(const std::filesystem::path& file) {
  return std::filesystem::path(file).concat(".before");
}

void write_checkpoint(const std::filesystem::path& file, const Checkpoint& checkpoint, bool keep_before) {
  ArchiveWriter payload;
  pass(payload, checkpoint);
  AtomicFile out(file);
  out.write(sealed(kFormat, payload.bytes()));
  out.settle();
  std::error_code ignored;  // if this fails, there is one checkpoint less to fall back on
  if (keep_before) std::filesystem::rename(file, checkpoint_before(file), ignored);
  out.commit();
}

Checkpoint parse_checkpoint(std::string_view bytes, const std::filesystem::path& file) {
  const std::string damaged = "checkpoint " + file.string() + " is damaged; start again without resuming";
  std::istringstream in{std::string(bytes)};
  const Unsealed found = unseal(in, kFormat);
  if (found.state == Unsealed::State::foreign)
    throw Error(Errc::malformed_file, file.string() + " is no checkpoint of vantage");
  if (found.state == Unsealed::State::other_version)
    throw Error(Errc::malformed_file, "checkpoint " + file.string() + " has format " + std::to_string(found.version) +
                                          ", this is " + std::to_string(kFormat.version) +
                                          "; resume with the vantage that wrote it, or start again");
  if (found.state != Unsealed::State::whole || in.peek() != std::istringstream::traits_type::eof())
    throw Error(Errc::malformed_file, damaged);
  ArchiveReader archive(found.payload, Errc::malformed_file, damaged);
  Checkpoint checkpoint;
  pass(archive, checkpoint);
  if (!archive.at_end()) archive.fail();
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
