#include "formats/engine/segment_writer.h"

#include <algorithm>

#include "core/base/assert.h"

namespace dance::engine {

SegmentWriter::SegmentWriter(Segment& segment, MonoTime now)
    : segment_(segment), beats_(static_cast<std::uint64_t>(now.since_zero_ns())) {
  SegmentHeader& header = segment.header;
  header.state.store(static_cast<std::uint32_t>(SegmentState::kOpening));
  for (std::size_t i = 0; i < kGuestSlots; ++i) {
    GuestSlot& slot = segment.guests[i];
    // Even, and another than before: readers' dancers of an earlier run are gone.
    slots_[i].generation = (slot.generation.load() | 1u) + 1u;
    slot.generation.store(slots_[i].generation);
    slots_[i].freed = freed_++;
    slots_[i].poses = slots_[i].hands = slots_[i].skeletons = beats_;
  }
  segment.beats.clear(beats_);
  header.version.store(kVersion);
  header.guest_slots.store(kGuestSlots);
  header.segment_bytes.store(sizeof(Segment));
  header.epoch.store(beats_);
  update_heartbeat(now);
  header.state.store(static_cast<std::uint32_t>(SegmentState::kOpen));
  header.magic.store(kMagic);
}

std::optional<std::size_t> SegmentWriter::reserve(const GuestId& guest) {
  const auto before = [](const Slot& a, const Slot& b) {
    return std::pair(a.is_taken, a.freed) < std::pair(b.is_taken, b.freed);
  };
  const auto found = std::min_element(slots_.begin(), slots_.end(), before);
  if (found->is_taken) return std::nullopt;
  found->is_taken = true;
  const auto index = static_cast<std::size_t>(found - slots_.begin());
  GuestSlot& slot = segment_.guests[index];
  std::array<char, kIdBytes> id{};
  std::copy(guest.view().begin(), guest.view().end(), id.begin());
  for (std::size_t i = 0; i < id.size() / sizeof(Word); ++i) {
    std::uint64_t word = 0;
    std::memcpy(&word, id.data() + i * sizeof word, sizeof word);
    slot.id[i].store(word, std::memory_order_release);
  }
  slot.newest_staged_ns.store(0, std::memory_order_release);
  slot.poses.clear(found->poses);
  slot.skeletons.clear(found->skeletons);
  slot.hands.clear(found->hands);
  return index;
}

void SegmentWriter::show(std::size_t slot) {
  DANCE_ASSERT(slots_[slot].is_taken, slot);
  if (slots_[slot].generation % 2 == 1) return;
  segment_.guests[slot].generation.store(++slots_[slot].generation, std::memory_order_release);
}

void SegmentWriter::release(std::size_t slot) {
  DANCE_ASSERT(slots_[slot].is_taken, slot);
  slots_[slot].is_taken = false;
  slots_[slot].freed = freed_++;
  if (slots_[slot].generation % 2 == 1)
    segment_.guests[slot].generation.store(++slots_[slot].generation, std::memory_order_release);
}

void SegmentWriter::write(std::size_t slot, const StoredPose& pose) {
  GuestSlot& guest = segment_.guests[slot];
  guest.poses.write(slots_[slot].poses++, pose);
  guest.newest_staged_ns.store(pose.staged_ns, std::memory_order_release);
}

void SegmentWriter::write(std::size_t slot, const StoredHands& hands) {
  segment_.guests[slot].hands.write(slots_[slot].hands++, hands);
}

void SegmentWriter::write(std::size_t slot, const StoredSkeleton& skeleton) {
  segment_.guests[slot].skeletons.write(slots_[slot].skeletons++, skeleton);
}

void SegmentWriter::write(const StoredBeat& beat) { segment_.beats.write(beats_++, beat); }

void SegmentWriter::update_heartbeat(MonoTime now) {
  segment_.header.heartbeat_ns.store(now.since_zero_ns(), std::memory_order_release);
}

void SegmentWriter::close() {
  segment_.header.state.store(static_cast<std::uint32_t>(SegmentState::kClosed));
}

}  // namespace dance::engine
