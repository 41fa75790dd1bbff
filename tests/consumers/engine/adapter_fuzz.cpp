// A house's memory into which anything has been written: each input is a list of places and words
// that are put there, in order, and an engine that goes on reading through all calls. Each call
// ends, and what it gives out may be used.

#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <string>

#include "consumers/engine/dance_adapter.h"
#include "core/net/mono_clock.h"
#include "formats/engine/segment_writer.h"
#include "formats/engine/shared_memory.h"
#include "tests/formats/engine/stored_poses.h"
#include "tests/fuzz_target.h"

namespace {

using namespace dance;
using namespace dance::engine;

constexpr std::size_t kPatchBytes = 12;  // a place, and a word for it
constexpr std::size_t kMostPatches = 64;

void fail_unless(bool is_right) {
  if (!is_right) std::abort();
}

// Two dancers with all that a dancer can have.
struct House {
  House() : memory(*OwnedSegment::open(*GuestId::parse("fuzz-" + std::to_string(getpid())))) {
    const MonoTime now = mono_now();
    SegmentWriter writer(memory->segment(), now);
    for (const char* id : {"alice", "bob"}) {
      const std::size_t slot = *writer.reserve(*GuestId::parse(id));
      for (std::uint32_t n = 0; n < 40; ++n) {
        StoredPose pose = numbered(n);
        pose.capture_ns = pose.staged_ns = (now + Duration::ms(10) * n).since_zero_ns();
        writer.write(slot, pose);
      }
      StoredHands hands{};
      for (auto& q : hands.rotation_xyzw) q[3] = 1.0f;
      hands.capture_ns = now.since_zero_ns();
      writer.write(slot, hands);
      writer.write(slot, StoredSkeleton{});
      writer.show(slot);
    }
    StoredBeat beat{};
    beat.time_ns = beat.beat_time_ns = now.since_zero_ns();
    beat.tempo_bpm = 120.0;
    beat.playing = 1;
    writer.write(beat);
    image = std::make_unique<unsigned char[]>(sizeof(Segment));
    std::memcpy(image.get(), &memory->segment(), sizeof(Segment));
    adapter = dance_adapter_open(std::string(name()).c_str(), DANCE_AXES_UNREAL);
  }
  std::string name() const { return "fuzz-" + std::to_string(getpid()); }

  std::unique_ptr<OwnedSegment> memory;
  std::unique_ptr<unsigned char[]> image;
  dance_adapter* adapter = nullptr;
};

void check(const dance_pose& pose) {
  for (const auto& q : pose.rotation) {
    const float n = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
    fail_unless(std::abs(n - 1.0f) < 0.01f);
  }
  for (const float x : pose.hips_position) fail_unless(std::abs(x) <= 110'000.0f);
  fail_unless(pose.kind <= DANCE_POSE_HELD && !std::isinf(pose.music_beats));
}

void read_all(dance_adapter* adapter) {
  dance_guest guests[DANCE_MAX_GUESTS];
  guests[0].struct_size = sizeof(dance_guest);
  const std::uint32_t count = dance_adapter_guests(adapter, guests, DANCE_MAX_GUESTS);
  fail_unless(count <= DANCE_MAX_GUESTS);
  for (std::uint32_t i = 0; i < count; ++i) fail_unless(std::strlen(guests[i].id) < 25);
  const std::int64_t now_ns = dance_adapter_now_ns();
  for (const std::uint32_t slot : {0u, 1u, 2u, 63u}) {
    dance_pose pose{};
    pose.struct_size = sizeof pose;
    if (dance_adapter_newest(adapter, slot, &pose) == DANCE_OK) check(pose);
    for (const std::int64_t ahead_ns : {-900'000'000, -30'000'000, 0, 15'000'000, 900'000'000})
      if (dance_adapter_at(adapter, slot, now_ns + ahead_ns, &pose) == DANCE_OK) check(pose);
    dance_skeleton skeleton{};
    skeleton.struct_size = sizeof skeleton;
    if (dance_adapter_skeleton(adapter, slot, &skeleton) == DANCE_OK)
      for (const auto& offset : skeleton.offset) fail_unless(std::abs(offset[0]) <= 201.0f);
    dance_hands hands{};
    hands.struct_size = sizeof hands;
    dance_adapter_hands(adapter, slot, &hands);
  }
  dance_beat beat{};
  beat.struct_size = sizeof beat;
  if (dance_adapter_beat(adapter, now_ns, &beat) == DANCE_OK)
    fail_unless(std::isfinite(beat.position_beats));
}

}  // namespace

DANCE_FUZZ_TARGET(engine_memory) {
  static House house;
  auto* bytes = reinterpret_cast<unsigned char*>(&house.memory->segment());
  const std::size_t patches = std::min(size / kPatchBytes, kMostPatches);
  const auto place_of = [&](std::size_t i) {
    std::uint32_t place = 0;
    std::memcpy(&place, data + i * kPatchBytes, sizeof place);
    return place % (sizeof(Segment) / 8) * 8;
  };
  // As a house that is alive.
  house.memory->segment().header.heartbeat_ns.store(mono_now().since_zero_ns());
  for (std::size_t i = 0; i < patches; ++i) {
    std::memcpy(bytes + place_of(i), data + i * kPatchBytes + 4, 8);
    if (i % 4 == 3) read_all(house.adapter);
  }
  read_all(house.adapter);
  for (std::size_t i = 0; i < patches; ++i)
    std::memcpy(bytes + place_of(i), house.image.get() + place_of(i), 8);
  return 0;
}
