#include "tunnel/seal/newcomer_queue.h"

#include <algorithm>

#include "core/base/assert.h"

namespace dance {

NewcomerQueue::NewcomerQueue(std::size_t places, std::uint64_t secret)
    : turns_(secret), places_(places) {
  DANCE_ASSERT(places > 0 && places <= NetworkTurns::kMostEntries, places);
  networks_.reserve(places);
  waiting_.reserve(places);
  free_.reserve(places);
  for (std::size_t i = places; i-- > 0;) free_.push_back(i);
}

NewcomerQueue::Pushed NewcomerQueue::push(const Address& from, std::uint64_t id,
                                          seal::Bytes records, bool is_known, MonoTime now) {
  if (records.size() > seal::kMaxSealed) return Pushed::kTooLong;
  const auto same = std::ranges::find_if(waiting_, [&](std::size_t place) {
    return places_[place].id == id && places_[place].from == from;
  });
  if (same != waiting_.end()) return Pushed::kWaitsAlready;
  const bool is_full = free_.empty();
  if (is_full) remove(turns_.oldest_of_most_crowded(networks_));
  const std::size_t place = free_.back();
  free_.pop_back();
  waiting_.push_back(place);
  networks_.push_back(NetworkLevels::of(from));
  Newcomer& newcomer = places_[place];
  newcomer.from = from;
  newcomer.id = id;
  newcomer.is_known = is_known;
  newcomer.since = now;
  newcomer.size = records.size();
  std::copy(records.begin(), records.end(), newcomer.bytes.begin());
  known_ += is_known ? 1 : 0;
  return is_full ? Pushed::kOtherDropped : Pushed::kWaits;
}

const NewcomerQueue::Newcomer* NewcomerQueue::pop(bool only_known) {
  if (waiting_.empty()) return nullptr;
  const std::size_t index = turns_.next(waiting_.size(), [&](std::size_t i) {
    return !only_known || places_[waiting_[i]].is_known ? &networks_[i] : nullptr;
  });
  turns_.serve(networks_[index]);
  const Newcomer& newcomer = places_[waiting_[index]];
  remove(index);
  return &newcomer;
}

void NewcomerQueue::remove(std::size_t index) {
  known_ -= places_[waiting_[index]].is_known ? 1 : 0;
  free_.push_back(waiting_[index]);
  waiting_.erase(waiting_.begin() + static_cast<std::ptrdiff_t>(index));
  networks_.erase(networks_.begin() + static_cast<std::ptrdiff_t>(index));
}

std::size_t NewcomerQueue::drop_late(MonoTime now) {
  std::size_t dropped = 0;
  for (; !waiting_.empty() && now - places_[waiting_.front()].since > kLongestWait; ++dropped)
    remove(0);
  return dropped;
}

}  // namespace dance
