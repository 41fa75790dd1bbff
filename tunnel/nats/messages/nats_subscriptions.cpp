#include "tunnel/nats/messages/nats_subscriptions.h"

namespace dance {

NatsSubscriptions::NatsSubscriptions() : entries_(kMost) {
  free_.reserve(kMost);
  held_.reserve(kMost);
  to_say_.reserve(kMost);
  for (std::size_t i = kMost; i > 0; --i) free_.push_back(static_cast<Index>(i - 1));
}

bool NatsSubscriptions::listen(std::string_view subject) {
  if (const auto known = by_subject_.find(subject); known != by_subject_.end()) {
    Entry& entry = entries_[known->second];
    entry.is_wanted = true;
    if (!entry.is_said) queue(known->second);
    return true;
  }
  if (free_.empty()) return false;
  const Index index = free_.back();
  free_.pop_back();
  Entry& entry = entries_[index];
  entry.at = by_subject_.emplace(std::string(subject), index).first;
  entry.is_used = entry.is_wanted = true;
  queue(index);
  return true;
}

void NatsSubscriptions::end_listen(std::string_view subject, MonoTime now) {
  const auto known = by_subject_.find(subject);
  if (known == by_subject_.end() || !entries_[known->second].is_wanted) return;
  Entry& entry = entries_[known->second];
  entry.is_wanted = false;
  entry.unwanted_since = now;
  if (!entry.is_held) held_.push_back(known->second);
  entry.is_held = true;
}

void NatsSubscriptions::begin() {
  held_.clear();
  to_say_.clear();
  for (auto at = by_subject_.begin(); at != by_subject_.end();) {
    const Index index = (at++)->second;
    Entry& entry = entries_[index];
    entry.is_said = entry.is_held = entry.is_to_say = false;
    if (entry.is_wanted)
      queue(index);
    else
      release(index);
  }
}

void NatsSubscriptions::settle(MonoTime now) {
  for (std::size_t i = 0; i < held_.size();) {
    const Index index = held_[i];
    Entry& entry = entries_[index];
    if (!entry.is_wanted && now - entry.unwanted_since < kHeld) {
      ++i;
      continue;
    }
    entry.is_held = false;
    held_[i] = held_.back();
    held_.pop_back();
    if (!entry.is_wanted) queue(index);
  }
}

// A held one keeps its entry; what became of its wish is looked at when it is no longer held.
std::optional<NatsSubscriptions::Line> NatsSubscriptions::take_line() {
  while (!to_say_.empty()) {
    const Index index = to_say_.back();
    to_say_.pop_back();
    Entry& entry = entries_[index];
    entry.is_to_say = false;
    const std::uint32_t number = number_of(index, entry);
    if (entry.is_wanted) {
      if (entry.is_said) continue;
      entry.is_said = true;
      return Line{entry.at->first, number};
    }
    if (entry.is_held) continue;
    const bool was_said = entry.is_said;
    release(index);
    if (was_said) return Line{{}, number};
  }
  return std::nullopt;
}

bool NatsSubscriptions::is_wanted(std::uint32_t number) const {
  const Entry* entry = find(number);
  return entry != nullptr && entry->is_wanted;
}

void NatsSubscriptions::count(std::uint32_t number) {
  if (find(number) == nullptr) return;
  Entry& entry = entries_[number % kMost];
  if (entry.round != round_) entry.in_buffer = 0;
  entry.round = round_;
  ++entry.in_buffer;
}

bool NatsSubscriptions::is_newest(std::uint32_t number, std::uint32_t kept) {
  if (find(number) == nullptr) return true;
  Entry& entry = entries_[number % kMost];
  return entry.round != round_ || entry.in_buffer == 0 || entry.in_buffer-- <= kept;
}

const NatsSubscriptions::Entry* NatsSubscriptions::find(std::uint32_t number) const {
  const Entry& entry = entries_[number % kMost];
  return entry.is_used && entry.generation == number / kMost ? &entry : nullptr;
}

void NatsSubscriptions::queue(Index index) {
  if (entries_[index].is_to_say) return;
  entries_[index].is_to_say = true;
  to_say_.push_back(index);
}

void NatsSubscriptions::release(Index index) {
  Entry& entry = entries_[index];
  by_subject_.erase(entry.at);
  entry.is_used = entry.is_wanted = entry.is_said = false;
  entry.generation = entry.generation % kGenerations + 1;
  free_.push_back(index);
}

}  // namespace dance
