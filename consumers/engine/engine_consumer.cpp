#include "consumers/engine/engine_consumer.h"

#include <cmath>
#include <utility>

namespace dance {
namespace {

using engine::kGuestSlots;

// Rotations off by more than rounding are made unit: readers take only those.
constexpr float kRounding = 1e-5f;

void store(const Eigen::Quaternionf& q, float* xyzw) {
  Eigen::Vector4f coeffs = q.coeffs();
  if (std::abs(coeffs.squaredNorm() - 1.0f) > kRounding) coeffs.normalize();
  Eigen::Vector4f::Map(xyzw) = coeffs;
}

}  // namespace

Result<std::unique_ptr<EngineConsumer>> EngineConsumer::open(const std::string& name, double hz,
                                                             std::uint64_t own_clock_id,
                                                             MonoTime now) {
  const auto id = GuestId::parse(name.empty() ? kUsualName : name);
  if (!id)
    return fail("the name '" + name + "' for engines: 1 to 24 characters of a-z, 0-9 and '-'");
  DANCE_TRY(auto memory, engine::OwnedSegment::open(*id));
  return std::unique_ptr<EngineConsumer>(
      new EngineConsumer(std::move(memory), hz, own_clock_id, now));
}

EngineConsumer::EngineConsumer(std::unique_ptr<engine::OwnedSegment> memory, double hz,
                               std::uint64_t own_clock_id, MonoTime now)
    : memory_(std::move(memory)),
      name_(memory_->name().view()),
      writer_(memory_->segment(), now),
      limit_(hz),
      own_clock_id_(own_clock_id) {}

std::size_t EngineConsumer::slot_of(const GuestId& guest, MonoTime now) {
  for (std::size_t i = 0; i < kGuestSlots; ++i)
    if (dancers_[i].guest == guest) return i;
  const auto slot = writer_.reserve(guest);
  if (!slot) return kGuestSlots;
  dancers_[*slot] = Dancer();
  dancers_[*slot].guest = guest;
  dancers_[*slot].heard = now;
  ++counters_.guests;
  return *slot;
}

void EngineConsumer::on_pose(const GuestId& guest, const Pose& pose, MonoTime now) {
  if (!memory_ || !limit_.lets_through(guest, pose.capture_time)) return;
  const std::size_t slot = slot_of(guest, now);
  if (slot == kGuestSlots) {
    ++counters_.too_many;
    return;
  }
  Dancer& dancer = dancers_[slot];
  const bool is_ours = pose.clock_id == own_clock_id_;
  // Not staged: captures that are listened to.
  const MonoTime shown =
      is_ours && pose.stamped(Hop::kStaged).is_set() ? pose.stamped(Hop::kStaged) : now;
  const Duration behind = shown - pose.capture_time;
  if (!engine::is_time(shown.since_zero_ns()) ||
      (is_ours && std::abs(behind.count_ns()) > engine::kLongestLag_ns)) {
    ++counters_.invalid;
    return;
  }
  // Captured well before the last one: another dance, or the recording from its begin.
  if (dancer.captured - pose.capture_time > kAnotherDance) dancer.lag = StageLag();
  dancer.captured = pose.capture_time;
  const std::int64_t lag_ns = dancer.lag.add(behind, shown).count_ns();
  engine::StoredPose stored{};
  for (std::size_t b = 0; b < kBoneCount; ++b) store(pose.R_PB[b], stored.rotation_xyzw[b]);
  Eigen::Vector3f::Map(stored.hips_m) = pose.p_WH_m;
  stored.presence = pose.presence & kAllBones;
  stored.confidence = pose.confidence;
  stored.sequence = pose.sequence;
  stored.capture_ns = pose.capture_time.since_zero_ns() + (is_ours ? 0 : lag_ns);
  stored.staged_ns = shown.since_zero_ns();
  stored.lag_ns = is_ours ? lag_ns : 0;
  stored.music_beats = pose.music_beats;
  if (!engine::is_valid(stored)) {
    ++counters_.invalid;
    return;
  }
  dancer.heard = now;
  dancer.lag_ns = lag_ns;
  writer_.write(slot, stored);
  if (!dancer.is_shown) writer_.show(slot);
  dancer.is_shown = true;
  writer_.update_heartbeat(now);
  ++counters_.poses;
}

void EngineConsumer::on_skeleton(const GuestId& guest, const Skeleton& skeleton, MonoTime now) {
  if (!memory_) return;
  // Before the first pose too, so that nobody is seen in another's body.
  const std::size_t slot = slot_of(guest, now);
  if (slot == kGuestSlots) return;
  Dancer& dancer = dancers_[slot];
  if (!dancer.is_shown) dancer.heard = now;
  // It is repeated; a version is this house's own count, as a producer that starts again begins
  // with 1 again.
  Skeleton numbered = skeleton;
  numbered.version = dancer.skeleton.version;
  if (dancer.skeleton_version > 0 && numbered == dancer.skeleton) return;
  dancer.skeleton = numbered;
  engine::StoredSkeleton stored{};
  for (std::size_t b = 0; b < kBoneCount; ++b)
    Eigen::Vector3f::Map(stored.offset_m[b]) = skeleton.offset_m[b];
  for (std::size_t t = 0; t < kTipCount; ++t)
    Eigen::Vector3f::Map(stored.tip_m[t]) = skeleton.tip_m[t];
  stored.version = ++dancer.skeleton_version;
  if (!engine::is_valid(stored)) {
    ++counters_.invalid;
    return;
  }
  writer_.write(slot, stored);
}

void EngineConsumer::on_hands(const GuestId& guest, const Hands& hands, MonoTime now) {
  if (!memory_) return;
  const std::size_t slot = slot_of(guest, now);
  if (slot == kGuestSlots) return;
  const Dancer& dancer = dancers_[slot];
  engine::StoredHands stored{};
  for (std::size_t b = 0; b < kFingerBoneCount; ++b) store(hands.R_PB[b], stored.rotation_xyzw[b]);
  stored.presence = hands.presence & engine::kAllFingers;
  const bool is_ours = hands.clock_id == own_clock_id_;
  stored.capture_ns = hands.capture_time.since_zero_ns() + (is_ours ? 0 : dancer.lag_ns);
  if (!engine::is_valid(stored)) {
    ++counters_.invalid;
    return;
  }
  writer_.write(slot, stored);
}

void EngineConsumer::on_beat(const Beat& beat, MonoTime now) {
  if (!memory_) return;
  engine::StoredBeat stored{};
  stored.time_ns = beat.time.since_zero_ns();
  stored.beat_time_ns = beat.beat_time.since_zero_ns();
  stored.beat = beat.beat;
  stored.tempo_bpm = beat.tempo_bpm;
  stored.beats_per_bar = beat.beats_per_bar;
  stored.confidence = beat.confidence;
  stored.playing = beat.playing ? 1 : 0;
  // The beat of another clock, as in a recording, says nothing about what is heard now.
  if (beat.clock_id != own_clock_id_ || !engine::is_valid(stored)) {
    ++counters_.invalid;
    return;
  }
  writer_.write(stored);
  writer_.update_heartbeat(now);
}

void EngineConsumer::on_second(MonoTime now) {
  if (!memory_) return;
  for (std::size_t i = 0; i < kGuestSlots; ++i) {
    Dancer& dancer = dancers_[i];
    if (!dancer.guest.is_set() || now - dancer.heard <= kSilence) continue;
    writer_.release(i);
    dancer.guest = GuestId();
  }
  writer_.update_heartbeat(now);
}

Result<void> EngineConsumer::finish() {
  if (!memory_) return {};
  writer_.close();
  memory_.reset();
  return {};
}

std::string EngineConsumer::summary() const {
  std::string text = std::to_string(counters_.poses) + " poses of " +
                     std::to_string(counters_.guests) + " dancers into shared memory " + name_;
  if (counters_.too_many > 0)
    text += "; " + std::to_string(counters_.too_many) + " of dancers beyond " +
            std::to_string(kGuestSlots) + " left out";
  if (counters_.invalid > 0)
    text += "; " + std::to_string(counters_.invalid) + " out of bounds left out";
  return text;
}

}  // namespace dance
