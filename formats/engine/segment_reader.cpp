#include "formats/engine/segment_reader.h"

#include <algorithm>

namespace dance::engine {

SegmentCheck SegmentReader::check(std::int64_t now_ns) const {
  const SegmentHeader& header = segment_.header;
  const std::uint64_t magic = header.magic.load(std::memory_order_acquire);
  if (magic == 0) return SegmentCheck::kNoWriter;
  if (magic != kMagic) return SegmentCheck::kDamaged;
  if (header.version.load(std::memory_order_relaxed) != kVersion)
    return SegmentCheck::kWrongVersion;
  if (header.guest_slots.load(std::memory_order_relaxed) != kGuestSlots ||
      header.segment_bytes.load(std::memory_order_relaxed) != sizeof(Segment))
    return SegmentCheck::kDamaged;
  const auto state = static_cast<SegmentState>(header.state.load(std::memory_order_acquire));
  if (state == SegmentState::kOpening || state == SegmentState::kClosed)
    return SegmentCheck::kNoWriter;
  if (state != SegmentState::kOpen) return SegmentCheck::kDamaged;
  const std::int64_t heartbeat = header.heartbeat_ns.load(std::memory_order_acquire);
  if (!is_time(heartbeat)) return SegmentCheck::kDamaged;
  return std::abs(now_ns - heartbeat) <= kHeartbeatStays_ns ? SegmentCheck::kFine
                                                            : SegmentCheck::kNoWriter;
}

std::uint32_t SegmentReader::generation(std::size_t slot) const {
  const std::uint32_t generation = segment_.guests[slot].generation.load(std::memory_order_acquire);
  return generation % 2 == 1 ? generation : 0;
}

Outcome SegmentReader::guest(std::size_t slot, GuestEntry& entry) {
  const GuestSlot& guest = segment_.guests[slot];
  for (int i = 0; i < kTries; ++i) {
    entry.generation = generation(slot);
    if (entry.generation == 0) return Outcome::kNoGuest;
    std::array<char, kIdBytes> id;
    for (std::size_t w = 0; w < kIdBytes / sizeof(Word); ++w) {
      const std::uint64_t word = guest.id[w].load(std::memory_order_acquire);
      std::memcpy(id.data() + w * sizeof word, &word, sizeof word);
    }
    entry.newest_staged_ns = guest.newest_staged_ns.load(std::memory_order_acquire);
    entry.has_skeleton = guest.skeletons.newest.load(std::memory_order_acquire) != 0;
    entry.has_hands = guest.hands.newest.load(std::memory_order_acquire) != 0;
    if (generation(slot) != entry.generation) {
      ++counters_.retries;
      continue;
    }
    const auto end = std::find(id.begin(), id.end(), '\0');
    const auto parsed = GuestId::parse({id.data(), static_cast<std::size_t>(end - id.begin())});
    if (!parsed || !is_time(entry.newest_staged_ns)) return damaged();
    entry.id = *parsed;
    return Outcome::kFine;
  }
  ++counters_.busy;
  return Outcome::kBusy;
}

Outcome SegmentReader::damaged() {
  ++counters_.damaged;
  return Outcome::kDamaged;
}

template <class Ring, class Value>
Outcome SegmentReader::newest_of(const Ring& ring, Value& value, std::uint64_t& number) {
  ++counters_.reads;
  for (int i = 0; i < kTries; ++i) {
    number = ring.newest.load(std::memory_order_acquire);
    if (number == 0) return Outcome::kNoData;
    if (ring.read(number, value)) return is_valid(value) ? Outcome::kFine : damaged();
    ++counters_.retries;
  }
  ++counters_.busy;
  return Outcome::kBusy;
}

template <class Ring, class Value>
Outcome SegmentReader::newest_of(const Ring& ring, std::size_t slot, std::uint32_t generation,
                                 Value& value, std::uint64_t& number) {
  const Outcome outcome = newest_of(ring, value, number);
  // What was read is the dancer's whose slot it still is.
  return this->generation(slot) == generation ? outcome : Outcome::kNoGuest;
}

Outcome SegmentReader::newest(std::size_t slot, std::uint32_t generation, StoredPose& pose,
                              std::uint64_t& number) {
  return newest_of(segment_.guests[slot].poses, slot, generation, pose, number);
}

Outcome SegmentReader::newest(std::size_t slot, std::uint32_t generation, StoredSkeleton& skeleton,
                              std::uint64_t& number) {
  return newest_of(segment_.guests[slot].skeletons, slot, generation, skeleton, number);
}

Outcome SegmentReader::newest(std::size_t slot, std::uint32_t generation, StoredHands& hands,
                              std::uint64_t& number) {
  return newest_of(segment_.guests[slot].hands, slot, generation, hands, number);
}

Outcome SegmentReader::newest(StoredBeat& beat, std::uint64_t& number) {
  return newest_of(segment_.beats, beat, number);
}

SegmentReader::Numbers SegmentReader::poses_after(std::size_t slot, std::uint64_t known) const {
  const auto& ring = segment_.guests[slot].poses;
  const std::uint64_t newest = ring.newest.load(std::memory_order_acquire);
  const std::uint64_t first = std::max(ring.first.load(std::memory_order_acquire), known + 1);
  if (newest == 0 || newest < first) return {};
  const std::uint64_t count = std::min<std::uint64_t>(newest - first, kMostPoses - 1) + 1;
  return {newest - count + 1, count};
}

Outcome SegmentReader::pose(std::size_t slot, std::uint32_t generation, std::uint64_t number,
                            StoredPose& pose) {
  ++counters_.reads;
  if (!segment_.guests[slot].poses.read(number, pose)) {
    ++counters_.retries;
    return Outcome::kBusy;
  }
  if (this->generation(slot) != generation) return Outcome::kNoGuest;
  return is_valid(pose) ? Outcome::kFine : damaged();
}

}  // namespace dance::engine
