#include "tunnel/files/file_sender.h"

#include <algorithm>

namespace dance {
namespace {

// Never two at once: of what waits in the network before a pose, one chunk is the most.
constexpr double kOneChunk = wire::kFileChunkCost;
// Asked for again within this, it was lost on its way.
constexpr Duration kLostWithin = Duration::s(5);

}  // namespace

FileSender::FileSender(double bytes_per_second) : pace_(bytes_per_second, kOneChunk) {
  offers_.reserve(wire::kMaxGuestsPerLink);
}

void FileSender::offer(const GuestId& guest, const FileHash& hash, FileBytes bytes) {
  std::erase_if(offers_, [&](const Offer& it) { return it.guest == guest; });
  if (!bytes || bytes->empty() || bytes->size() > wire::kMaxFileBytes ||
      offers_.size() == wire::kMaxGuestsPerLink)
    return;
  offers_.push_back({guest, hash, std::move(bytes)});
}

bool FileSender::offers(const GuestId& guest, const FileHash& hash) const {
  return std::ranges::any_of(offers_,
                             [&](const auto& it) { return it.guest == guest && it.hash == hash; });
}

const FileSender::Offer* FileSender::find(const FileHash& hash) const {
  const auto found = std::ranges::find(offers_, hash, &Offer::hash);
  return found == offers_.end() ? nullptr : &*found;
}

bool FileSender::want(const GuestId& guest, const wire::FileWant& want, MonoTime now) {
  if (!offers(guest, want.file.hash)) {
    ++counters_.not_offered;
    return false;
  }
  const std::size_t chunks =
      wire::chunks_of(static_cast<std::uint32_t>(find(want.file.hash)->bytes->size()));
  for (std::size_t i = 0; i < wire::kChunksPerWant; ++i) {
    const std::size_t index = want.first + i;
    if (!want.has(index) || index >= chunks) continue;
    const Queued queued{want.file, static_cast<std::uint16_t>(index)};
    if (queue_.contains(queued)) continue;
    const bool was_sent = std::ranges::any_of(sent_, [&](const Sent& it) {
      return it.what == queued && it.at.is_set() && now - it.at < kLostWithin;
    });
    if (!queue_.try_push(queued)) {
      ++counters_.queue_full;
      continue;
    }
    if (!was_sent) {
      pace_.see_arrival();
      continue;
    }
    ++counters_.chunks_again;
    pace_.see_loss(now);
  }
  return true;
}

std::optional<wire::FileChunk> FileSender::next(MonoTime now) {
  while (!queue_.empty()) {
    const Queued queued = queue_[0];
    const Offer* offer = find(queued.file.hash);
    if (offer == nullptr) {  // taken back meanwhile
      queue_.erase_at(0);
      continue;
    }
    if (!pace_.take(wire::kFileChunkCost, now)) return std::nullopt;
    queue_.erase_at(0);
    note_sent(queued, now);
    wire::FileChunk chunk;
    chunk.file = queued.file;
    chunk.size_bytes = static_cast<std::uint32_t>(offer->bytes->size());
    chunk.index = queued.index;
    chunk.data = wire::Bytes(*offer->bytes)
                     .subspan(queued.index * wire::kFileChunk,
                              wire::chunk_bytes(chunk.size_bytes, queued.index));
    ++counters_.chunks_sent;
    counters_.bytes_sent += chunk.data.size();
    return chunk;
  }
  return std::nullopt;
}

void FileSender::note_sent(const Queued& what, MonoTime now) {
  sent_[sent_at_] = {what, now};
  sent_at_ = (sent_at_ + 1) % kRemembered;
}

MonoTime FileSender::next_deadline() const {
  return queue_.empty() ? MonoTime() : pace_.ready_at(wire::kFileChunkCost);
}

}  // namespace dance
