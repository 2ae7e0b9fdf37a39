// SPDX-License-Identifier: Apache-2.0
#include "ranks/session.hpp"

#include <algorithm>
#include <stop_token>
#include <utility>

namespace vantage::ranks {

Session::Session(Transport& transport) : transport_(transport) {
  for (int rank = 0; rank < transport.size(); ++rank) inboxes_.push_back(std::make_unique<Inbox>());
  transport.deliver_to([this](int from, Message message) { receive(from, std::move(message)); });
}

void Session::receive(int from, Message message) {
  Inbox& inbox = *inboxes_[static_cast<std::size_t>(from)];
  {
    const std::lock_guard lock(inbox.mutex);
    inbox.messages.push_back(std::move(message));
  }
  inbox.wake.notify_all();
}

void Session::send(int rank, Kind kind, const Message& body) { transport_.send(rank, begin(kind, 0).take() + body); }

std::uint64_t Session::request(int rank, Kind kind, const Message& body) {
  Inbox& inbox = *inboxes_[static_cast<std::size_t>(rank)];
  const std::lock_guard lock(inbox.mutex);
  transport_.send(rank, begin(kind, ++inbox.serial).take() + body);
  return inbox.serial;
}

std::optional<Message> Session::answer(int rank, std::uint64_t serial, const Progress& progress) {
  Inbox& inbox = *inboxes_[static_cast<std::size_t>(rank)];
  const std::stop_callback woken(progress.stop, [&] {
    const std::lock_guard lock(inbox.mutex);
    inbox.wake.notify_all();
  });
  for (;;) {
    Message message;
    {
      std::unique_lock lock(inbox.mutex);
      inbox.wake.wait(lock, [&] { return !inbox.messages.empty() || progress.stopped(); });
      if (inbox.messages.empty()) break;
      message = std::move(inbox.messages.front());
      inbox.messages.pop_front();
    }
    Reader reader(message);
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
  transport_.send(rank, begin(Kind::stop, serial).take());
  return std::nullopt;
}

void Session::end() {
  for (int rank = 1; rank < ranks(); ++rank) send(rank, Kind::end, {});
}

Session::Sample Session::kept(std::span<const std::uint32_t> sample) {
  const std::lock_guard lock(sample_mutex_);
  if (!sample_ || !std::ranges::equal(*sample_, sample))
    sample_ = std::make_shared<const std::vector<std::uint32_t>>(sample.begin(), sample.end());
  return sample_;
}

}  // namespace vantage::ranks
