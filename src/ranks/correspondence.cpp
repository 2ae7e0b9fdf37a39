// SPDX-License-Identifier: Apache-2.0
#include "ranks/correspondence.hpp"

#include <algorithm>
#include <stop_token>
#include <utility>

namespace vantage::ranks {

Correspondence::Correspondence(Post& post) : post_(post) {
  for (int rank = 0; rank < post.size(); ++rank) inboxes_.push_back(std::make_unique<Inbox>());
  post.deliver_to([this](int from, Letter letter) { receive(from, std::move(letter)); });
}

void Correspondence::receive(int from, Letter letter) {
  Inbox& inbox = *inboxes_[static_cast<std::size_t>(from)];
  {
    const std::lock_guard lock(inbox.mutex);
    inbox.letters.push_back(std::move(letter));
  }
  inbox.wake.notify_all();
}

void Correspondence::tell(int rank, Kind kind, const Letter& body) { post_.send(rank, begin(kind, 0).take() + body); }

std::uint64_t Correspondence::ask(int rank, Kind kind, const Letter& body) {
  Inbox& inbox = *inboxes_[static_cast<std::size_t>(rank)];
  const std::lock_guard lock(inbox.mutex);
  post_.send(rank, begin(kind, ++inbox.serial).take() + body);
  return inbox.serial;
}

std::optional<Letter> Correspondence::answer(int rank, std::uint64_t serial, const Progress& progress) {
  Inbox& inbox = *inboxes_[static_cast<std::size_t>(rank)];
  const std::stop_callback woken(progress.stop, [&] {
    const std::lock_guard lock(inbox.mutex);
    inbox.wake.notify_all();
  });
  for (;;) {
    Letter letter;
    {
      std::unique_lock lock(inbox.mutex);
      inbox.wake.wait(lock, [&] { return !inbox.letters.empty() || progress.stopped(); });
      if (inbox.letters.empty()) break;
      letter = std::move(inbox.letters.front());
      inbox.letters.pop_front();
    }
    Reader reader(letter);
    const Head head = read_head(reader);
    if (head.kind != Kind::failed && head.serial != serial) continue;  // answer to an abandoned question
    switch (head.kind) {
      case Kind::progress: progress(reader.raw<double>()); break;
      case Kind::answer: return reader.text();
      case Kind::error:
      case Kind::failed: {
        const auto code = reader.raw<Errc>();
        throw Error(code, "rank " + std::to_string(rank) + ": " + reader.text());
      }
      default: throw Error(Errc::device_failure, "rank " + std::to_string(rank) + " answers in no known way");
    }
  }
  post_.send(rank, begin(Kind::stop, serial).take());
  return std::nullopt;
}

void Correspondence::end() {
  for (int rank = 1; rank < ranks(); ++rank) tell(rank, Kind::end, {});
}

Correspondence::Sample Correspondence::kept(std::span<const std::uint32_t> sample) {
  const std::lock_guard lock(sample_mutex_);
  if (!sample_ || !std::ranges::equal(*sample_, sample))
    sample_ = std::make_shared<const std::vector<std::uint32_t>>(sample.begin(), sample.end());
  return sample_;
}

}  // namespace vantage::ranks
