#include "tunnel/files/file_receiver.h"

#include <algorithm>

#include "core/base/deadline.h"

namespace dance {
namespace {

// Asked for together, where there are so many: a want costs a datagram.
constexpr std::size_t kChunksTogether = 8;
constexpr double kBurst = 2.0 * kChunksTogether * wire::kFileChunkCost;
// One that does not get on, or takes long, lets another have its turn.
constexpr Duration kFileTimeout = Duration::s(4);
constexpr Duration kLongestTurn = Duration::s(60);
constexpr Duration kRestAfterRefusal = Duration::s(20);
// A server that has just begun may not know yet what the guest has chosen.
constexpr Duration kRestNotOffered = Duration::s(1);
constexpr Duration kShortestTimeout = Duration::ms(300);
constexpr Duration kLongestTimeout = Duration::s(3);
constexpr Duration kLooksAgain = Duration::ms(50);
constexpr Duration kBetweenLooks = Duration::ms(2);
constexpr std::size_t kMostDownloads = wire::kMaxGuestsPerRoom;
constexpr std::size_t kMostBudgets = 256;

}  // namespace

FileReceiver::FileReceiver(double bytes_per_second) : pace_(bytes_per_second, kBurst) {
  downloads_.reserve(kMostDownloads);
}

bool FileReceiver::is_bad(const GuestId& guest, const FileHash& hash) const {
  return std::ranges::find(bad_, std::pair(guest, hash)) != bad_.end();
}

FileReceiver::Download* FileReceiver::find(const GuestId& guest) {
  const auto found = std::ranges::find(downloads_, guest, &Download::guest);
  return found == downloads_.end() ? nullptr : &*found;
}

bool FileReceiver::wants(const GuestId& guest, const FileHash& hash) const {
  return std::ranges::any_of(downloads_,
                             [&](const auto& it) { return it.guest == guest && it.hash == hash; });
}

void FileReceiver::want(const GuestId& guest, const FileHash& hash, ChunkedFile begin,
                        MonoTime now) {
  if (is_bad(guest, hash) || begin.chunks() == 0) return;
  const Download* known = find(guest);
  if (known != nullptr && known->hash == hash && known->file.size_bytes() == begin.size_bytes())
    return;
  drop(guest);
  if (downloads_.size() == kMostDownloads) return;
  // Without memory for what was brought along it is fetched again.
  if (held_bytes() + begin.held_bytes() > kMostBytes) begin = ChunkedFile(begin.size_bytes());
  Download download;
  download.guest = guest;
  download.hash = hash;
  download.was_asked.assign(begin.chunks(), false);
  download.is_resumed = begin.missing() < begin.chunks();
  download.file = std::move(begin);
  download.last_chunk = now;
  while (download.blocks_told < download.file.blocks() &&
         download.file.has_block(download.blocks_told))
    ++download.blocks_told;
  downloads_.push_back(std::move(download));
  Download& added = downloads_.back();
  if (!added.file.is_whole()) return;
  added.is_whole = true;
  if (on_whole) on_whole(guest, hash, std::move(added.file));
}

void FileReceiver::drop(const GuestId& guest) {
  std::erase_if(downloads_, [&](const Download& it) { return it.guest == guest; });
}

void FileReceiver::settle(const GuestId& guest, const FileHash& hash, FileVerdict verdict) {
  Download* download = find(guest);
  // Of one that was dropped meanwhile, and begun again, only that it is here is news.
  if (download == nullptr || download->hash != hash ||
      (!download->is_whole && verdict != FileVerdict::kRight))
    return;
  if (verdict == FileVerdict::kWrong && download->is_resumed) {
    ++counters_.files_anew;
    begin_anew(*download);
    return;
  }
  if (verdict == FileVerdict::kWrong) remember_bad(guest, hash);
  drop(guest);
}

void FileReceiver::remember_bad(const GuestId& guest, const FileHash& hash) {
  ++counters_.files_wrong;
  if (bad_.size() == kMostBad) bad_.erase(bad_.begin());
  bad_.emplace_back(guest, hash);
}

void FileReceiver::begin_anew(Download& download) {
  download.file = ChunkedFile(download.file.size_bytes());
  download.was_asked.assign(download.file.chunks(), false);
  download.asked.clear();
  download.cursor = download.blocks_told = 0;
  download.is_whole = download.is_resumed = false;
}

void FileReceiver::begin_session() {
  for (Download& download : downloads_) {
    download.asked.clear();
    download.cursor = 0;
    download.rests_until = MonoTime();
  }
}

// Four times what a chunk takes usually: the server may have to fetch it first.
Duration FileReceiver::timeout() const {
  return std::clamp(mean_wait_ * 4, kShortestTimeout, kLongestTimeout);
}

void FileReceiver::expire(Download& download, MonoTime now) {
  const std::size_t late = download.asked.expire(now - timeout());
  if (late == 0) return;
  counters_.chunks_again += late;
  download.cursor = 0;
  for (std::size_t i = 0; i < late; ++i) pace_.see_loss(now);
  mean_wait_ = std::min(mean_wait_ * 2, kLongestTimeout / 4);
}

// Whose turn it is.
FileReceiver::Download* FileReceiver::active(const SlotOf& slot_of, MonoTime now) {
  const auto can = [&](const Download& it) {
    return !it.is_whole && now >= it.rests_until && slot_of(it.guest).has_value();
  };
  auto first = std::ranges::find_if(downloads_, can);
  if (first == downloads_.end()) return nullptr;
  if (!first->begun.is_set()) {
    first->begun = first->last_chunk = now;
    make_room(*first);
  }
  const bool is_stuck = now - first->last_chunk > kFileTimeout || now - first->begun > kLongestTurn;
  const bool others_wait = std::find_if(first + 1, downloads_.end(), can) != downloads_.end();
  if (is_stuck && others_wait) {
    first->begun = MonoTime();
    std::rotate(first, first + 1, downloads_.end());
    first = std::ranges::find_if(downloads_, can);
    first->begun = first->last_chunk = now;
    make_room(*first);
  }
  return &*first;
}

std::size_t FileReceiver::held_bytes() const {
  std::size_t held = 0;
  for (const Download& it : downloads_)
    if (!it.is_whole) held += it.file.held_bytes();
  return held;
}

// What waits for its next turn loses what it has, where it is too much in all.
void FileReceiver::make_room(const Download& keep) {
  std::size_t held = keep.file.blocks() * ChunkedFile::kBlock;
  for (Download& it : downloads_) {
    if (&it == &keep || it.is_whole) continue;
    if (held + it.file.held_bytes() > kMostBytes) begin_anew(it);
    held += it.file.held_bytes();
  }
}

bool FileReceiver::pay(const GuestId& guest, double bytes, MonoTime now) {
  if (budgets_.size() > kMostBudgets)
    std::erase_if(budgets_, [&](const auto& it) { return now - it.second.used > Duration::s(60); });
  Budget& budget = budgets_[guest];
  budget.used = now;
  return budget.bytes.take(bytes, now);
}

// Of several at once, as a want costs a datagram.
bool FileReceiver::may_ask(const Download& download, MonoTime now) const {
  const MonoTime ready = pace_.ready_at(kChunksTogether * wire::kFileChunkCost);
  return ready.is_set() && ready <= now && download.asked.free() >= kChunksTogether &&
         now >= download.rests_until;
}

std::optional<wire::FileWant> FileReceiver::next(const SlotOf& slot_of, MonoTime now) {
  looked_ = now;
  Download* download = active(slot_of, now);
  if (download == nullptr) return std::nullopt;
  expire(*download, now);
  if (!may_ask(*download, now)) return std::nullopt;
  const ChunkedFile& file = download->file;
  std::optional<wire::FileWant> want;
  std::size_t index = file.next_missing(download->cursor);
  for (; index < file.chunks(); index = file.next_missing(index + 1)) {
    if (want && index - want->first >= wire::kChunksPerWant) break;
    if (download->asked.has(index)) continue;
    if (download->asked.is_full() || !pace_.take(wire::kFileChunkCost, now)) break;
    if (!pay(download->guest, wire::kFileChunk, now)) {
      download->rests_until = now + Duration::s(5);
      break;
    }
    if (!want) want = wire::FileWant{{*slot_of(download->guest), download->hash}, 0, 0};
    if (want->chunks == 0) want->first = static_cast<std::uint16_t>(index);
    want->chunks |= 1u << (index - want->first);
    download->asked.add(index, now);
    download->was_asked[index] = true;
    ++counters_.chunks_asked;
  }
  download->cursor = index;
  return want;
}

MonoTime FileReceiver::next_deadline() const {
  MonoTime next;
  const auto at = [&](MonoTime when) { next = earlier(next, when); };
  for (const Download& it : downloads_) {
    if (it.is_whole) continue;
    if (!looked_.is_set()) return MonoTime::from_ns(1);
    // Those that wait for their turn, a guest or a rest to end look again now and then.
    at(looked_ + kLooksAgain);
    if (!it.begun.is_set()) continue;
    if (!it.asked.is_empty()) at(it.asked.oldest() + timeout() + Duration::us(10));
    const bool has_more = it.file.next_missing(it.cursor) < it.file.chunks();
    if (has_more && it.asked.free() >= kChunksTogether && it.rests_until <= looked_)
      at(pace_.ready_at(kChunksTogether * wire::kFileChunkCost));
  }
  // Of one that is not there just now nothing changes: not again at once.
  return next.is_set() ? std::max(next, looked_ + kBetweenLooks) : next;
}

bool FileReceiver::take(const GuestId& from, const wire::FileChunk& chunk, MonoTime now) {
  Download* download = find(from);
  if (download == nullptr || download->is_whole || download->hash != chunk.file.hash ||
      chunk.index >= download->was_asked.size() || !download->was_asked[chunk.index]) {
    ++counters_.chunks_foreign;
    return false;
  }
  if (download->file.size_bytes() != chunk.size_bytes) {
    // Of the file that was asked for, and not as long as its guest said: never whole.
    remember_bad(from, download->hash);
    drop(from);
    return false;
  }
  // While another has its turn a late one finds no memory: it is asked for again in this one's.
  const bool takes_memory = download->file.needs_block(chunk.index);
  if (takes_memory && held_bytes() + ChunkedFile::kBlock > kMostBytes) {
    if (!download->begun.is_set()) return true;
    make_room(*download);
  }
  const MonoTime asked = download->asked.take(chunk.index);
  // One that was given up, and asked for again, may come twice.
  if (!download->file.put(chunk.index, chunk.data)) return true;
  ++counters_.chunks_taken;
  download->last_chunk = now;
  pace_.see_arrival();
  if (asked.is_set()) mean_wait_ += (now - asked - mean_wait_) / 8;
  tell_blocks(*download);
  if (!download->file.is_whole()) return true;
  ++counters_.files_whole;
  download->is_whole = true;
  if (on_whole) on_whole(from, chunk.file.hash, std::move(download->file));
  return true;
}

void FileReceiver::tell_blocks(Download& download) {
  while (download.blocks_told < download.file.blocks() &&
         download.file.has_block(download.blocks_told)) {
    if (on_block) on_block(download.guest, download.hash, download.file, download.blocks_told);
    ++download.blocks_told;
  }
}

bool FileReceiver::refuse(const GuestId& from, const wire::FileRefusal& refusal, MonoTime now) {
  Download* download = find(from);
  if (download == nullptr || download->hash != refusal.file.hash || download->is_whole)
    return false;
  ++counters_.files_refused;
  download->asked.clear();
  download->cursor = 0;
  download->rests_until =
      now +
      (refusal.cause == wire::FileRefusalCause::kNotOffered ? kRestNotOffered : kRestAfterRefusal);
  if (on_refused) on_refused(from, refusal.file.hash, refusal.cause);
  return true;
}

}  // namespace dance
