#include "consumers/engine/adapter/stage_reader.h"

#include <algorithm>
#include <cstring>

#include "consumers/engine/adapter/prediction.h"
#include "core/pose/skeleton.h"

namespace dance::engine {
namespace {

static_assert(kLongestPrediction.count_ns() == DANCE_LONGEST_PREDICTION_NS);
static_assert(kGuestSlots == DANCE_MAX_GUESTS && kBoneCount == DANCE_BONES &&
              kFingerBoneCount == DANCE_FINGER_BONES && kTipCount == DANCE_TIPS);
static_assert(kIdBytes == sizeof(dance_guest::id));
static_assert(sizeof(BoneRotations) == sizeof(StoredPose::rotation_xyzw));  // one after the other

constexpr std::size_t kPrefetched = 1;
// A capture time that goes back further is another recording, not a pose that was overtaken; so are
// several in turn that went back less.
constexpr Duration kAnotherDance = Duration::ms(500);
constexpr int kMostOvertaken = 2;

dance_status status_of(Outcome outcome) {
  switch (outcome) {
    case Outcome::kFine:
      return DANCE_OK;
    case Outcome::kNoGuest:
      return DANCE_NO_GUEST;
    case Outcome::kNoData:
      return DANCE_NO_DATA;
    case Outcome::kBusy:
      return DANCE_BUSY;
    case Outcome::kDamaged:
      return DANCE_DAMAGED;
  }
  return DANCE_DAMAGED;
}

dance_status status_of(SegmentCheck check) {
  switch (check) {
    case SegmentCheck::kFine:
      return DANCE_OK;
    case SegmentCheck::kNoWriter:
      return DANCE_NO_HOUSE;
    case SegmentCheck::kWrongVersion:
      return DANCE_WRONG_VERSION;
    case SegmentCheck::kDamaged:
      return DANCE_DAMAGED;
  }
  return DANCE_DAMAGED;
}

Pose pose_of(const StoredPose& stored) {
  Pose pose;
  for (std::size_t b = 0; b < kBoneCount; ++b)
    pose.R_PB[b].coeffs() = Eigen::Vector4f(stored.rotation_xyzw[b]);
  pose.p_WH_m = Eigen::Vector3f(stored.hips_m);
  pose.presence = stored.presence;
  pose.confidence = stored.confidence;
  pose.sequence = stored.sequence;
  pose.capture_time = MonoTime::from_ns(stored.capture_ns);
  pose.stamp(Hop::kStaged, MonoTime::from_ns(stored.staged_ns));
  pose.music_beats = stored.music_beats;
  return pose;
}

}  // namespace

StageReader::StageReader(const GuestId& name, const Axes& axes)
    : seen_(name), axes_(axes), dancers_(kGuestSlots) {}

dance_status StageReader::refresh(std::int64_t now_ns) {
  if (seen_.segment()) {
    status_ = status_of(reader().check(now_ns));
    if (status_ == DANCE_OK) {
      if (reader().epoch() != epoch_) forget_dancers();
      return status_;
    }
  }
  if (now_ns - looked_ns_ < kLookAgain_ns) return status_;
  looked_ns_ = now_ns;
  status_ = look();
  if (status_ == DANCE_OK) status_ = status_of(reader().check(now_ns));
  if (status_ == DANCE_OK && reader().epoch() != epoch_) forget_dancers();
  if (status_ == DANCE_DAMAGED) ++counters_.damaged;
  return status_;
}

dance_status StageReader::look() {
  switch (seen_.look()) {
    case SeenSegment::Look::kSame:
    case SeenSegment::Look::kNew:
      return DANCE_OK;
    case SeenSegment::Look::kNothing:
      // What is mapped has no name and no writer any more.
      seen_.forget();
      return DANCE_NO_HOUSE;
    case SeenSegment::Look::kWrongVersion:
      return DANCE_WRONG_VERSION;
    case SeenSegment::Look::kDamaged:
      return DANCE_DAMAGED;
  }
  return DANCE_DAMAGED;
}

void StageReader::forget_dancers() {
  epoch_ = reader().epoch();
  ++attached_;
  for (Dancer& dancer : dancers_) dancer.generation = 0;
  beat_ = BeatClock();
  beat_number_ = 0;
}

Outcome StageReader::guest(std::size_t slot, dance_guest& out) {
  GuestEntry entry;
  const Outcome outcome = reader().guest(slot, entry);
  if (outcome != Outcome::kFine) return outcome;
  out = {};
  out.slot = static_cast<std::uint32_t>(slot);
  std::memcpy(out.id, entry.id.c_str(), entry.id.view().size());
  out.newest_ns = entry.newest_staged_ns;
  out.has_skeleton = entry.has_skeleton;
  out.has_hands = entry.has_hands;
  out.generation = entry.generation;
  return Outcome::kFine;
}

dance_status StageReader::newest(std::size_t slot, dance_pose& out) {
  const std::uint32_t generation = reader().generation(slot);
  if (generation == 0) return DANCE_NO_GUEST;
  StoredPose stored;
  std::uint64_t number = 0;
  const Outcome outcome = reader().newest(slot, generation, stored, number);
  if (outcome != Outcome::kFine) return status_of(outcome);
  give(stored, out);
  out.kind = DANCE_POSE_NEWEST;
  out.time_ns = stored.staged_ns;
  out.generation = generation;
  return DANCE_OK;
}

Outcome StageReader::catch_up(std::size_t slot, std::uint32_t generation) {
  Dancer& dancer = dancers_[slot];
  if (dancer.generation != generation) {
    dancer.poses.clear();
    dancer.number = 0;
    dancer.overtaken = 0;
    dancer.generation = generation;
  }
  const SegmentReader::Numbers numbers = reader().poses_after(slot, dancer.number);
  Outcome worst = dancer.poses.empty() ? Outcome::kNoData : Outcome::kFine;
  for (std::uint64_t i = 0; i < numbers.count; ++i) {
    StoredPose stored;
    const Outcome outcome = reader().pose(slot, generation, numbers.first + i, stored);
    if (outcome == Outcome::kNoGuest) return outcome;
    worst = outcome;
    if (outcome != Outcome::kFine) continue;
    dancer.number = numbers.first + i;
    remember(dancer, stored);
  }
  return dancer.poses.empty() ? worst : Outcome::kFine;
}

void StageReader::remember(Dancer& dancer, const StoredPose& stored) {
  const Pose pose = pose_of(stored);
  dancer.lag_ns = stored.lag_ns;
  if (!dancer.poses.empty() &&
      (dancer.poses.newest().capture_time - pose.capture_time > kAnotherDance ||
       dancer.overtaken >= kMostOvertaken))
    dancer.poses.clear();
  dancer.overtaken = dancer.poses.push(pose) ? 0 : dancer.overtaken + 1;
}

// Engines read one dancer after the other, and most of the time of a read is that of memory which
// was not used since the last frame: the next dancer's is on its way while this one is worked out.
void StageReader::prefetch(std::size_t slot) const {
  const Dancer& dancer = dancers_[slot];
  if (dancer.seen == 0) return;
  const auto fetch = [](const void* begin, std::size_t bytes) {
    for (std::size_t at = 0; at < bytes; at += 64)
      __builtin_prefetch(static_cast<const char*>(begin) + at);
  };
  const GuestSlot& guest = seen_.segment()->guests[slot];
  fetch(&guest, 1);
  fetch(&guest.poses, 1);
  // Most frames bring a pose, or two.
  for (std::uint64_t next = dancer.seen; next <= dancer.seen + 2; ++next)
    fetch(&guest.poses.entries[next % kPoseRing], sizeof guest.poses.entries[0]);
}

// The commonest question, a time after the newest pose, needs no history: two poses out of the
// memory answer it, and a third of the bytes is touched.
bool StageReader::is_ahead(std::size_t slot, std::uint32_t generation, std::int64_t time_ns,
                           dance_pose& out) {
  StoredPose stored;
  std::uint64_t number = 0;
  if (reader().newest(slot, generation, stored, number) != Outcome::kFine) return false;
  dancers_[slot].seen = number;
  const MonoTime t = MonoTime::from_ns(time_ns - stored.lag_ns);
  if (t <= MonoTime::from_ns(stored.capture_ns)) return false;
  const MonoTime captured = MonoTime::from_ns(stored.capture_ns);
  const Duration ahead = std::min(t - captured, kLongestPrediction);
  const SegmentReader::Numbers numbers = reader().poses_after(slot, 0);
  StoredPose before;
  for (std::uint64_t earlier = number - 1; earlier >= numbers.first; --earlier) {
    if (reader().pose(slot, generation, earlier, before) != Outcome::kFine) break;
    const Duration age = captured - MonoTime::from_ns(before.capture_ns);
    if (age <= Duration()) return false;  // overtaken
    if (age > kMostBaseline) break;
    if (age < kLeastBaseline) continue;
    predict(stored, before, t);
    break;
  }
  stored.capture_ns += ahead.count_ns();
  stored.staged_ns += ahead.count_ns();
  give(stored, out);
  out.kind = t - captured <= kLongestPrediction ? DANCE_POSE_PREDICTED : DANCE_POSE_HELD;
  out.time_ns = stored.capture_ns + stored.lag_ns;
  out.generation = generation;
  return true;
}

dance_status StageReader::at(std::size_t slot, std::int64_t time_ns, dance_pose& out) {
  const std::uint32_t generation = reader().generation(slot);
  if (generation == 0) return DANCE_NO_GUEST;
  for (std::size_t next = slot + 1; next < kGuestSlots && next <= slot + kPrefetched; ++next)
    prefetch(next);
  if (is_ahead(slot, generation, time_ns, out)) return DANCE_OK;
  const Outcome outcome = catch_up(slot, generation);
  if (outcome != Outcome::kFine) return status_of(outcome);
  const Dancer& dancer = dancers_[slot];
  const MonoTime t = MonoTime::from_ns(time_ns - dancer.lag_ns);
  const MonoTime newest = dancer.poses.newest().capture_time;
  if (t > newest) {
    give(predict(dancer.poses, t), out);
    out.kind = t - newest <= kLongestPrediction ? DANCE_POSE_PREDICTED : DANCE_POSE_HELD;
  } else {
    const auto answer = dancer.poses.at(t);
    give(answer->pose, out);
    out.kind = answer->how == PoseHistory::How::kHeldFirst ? DANCE_POSE_HELD
               : t == newest                               ? DANCE_POSE_NEWEST
                                                           : DANCE_POSE_INTERPOLATED;
  }
  out.time_ns = out.capture_ns + dancer.lag_ns;
  out.generation = generation;
  return DANCE_OK;
}

void StageReader::give(const StoredPose& stored, dance_pose& out) const {
  out.sequence = stored.sequence;
  out.presence = stored.presence;
  out.confidence = stored.confidence;
  axes_.point_out(stored.hips_m, out.hips_position);
  axes_.rotations_out(stored.rotation_xyzw[0], out.rotation[0], kBoneCount);
  out.capture_ns = stored.capture_ns;
  out.staged_ns = stored.staged_ns;
  out.music_beats = stored.music_beats;
  out.reserved = 0;
}

void StageReader::give(const Pose& pose, dance_pose& out) const {
  out.sequence = pose.sequence;
  out.presence = pose.presence;
  out.confidence = pose.confidence;
  axes_.point_out(pose.p_WH_m.data(), out.hips_position);
  axes_.rotations_out(pose.R_PB[0].coeffs().data(), out.rotation[0], kBoneCount);
  out.capture_ns = pose.capture_time.since_zero_ns();
  out.staged_ns = pose.stamped(Hop::kStaged).since_zero_ns();
  out.music_beats = pose.music_beats;
  out.reserved = 0;
}

dance_status StageReader::skeleton(std::size_t slot, dance_skeleton& out) {
  const std::uint32_t generation = reader().generation(slot);
  if (generation == 0) return DANCE_NO_GUEST;
  StoredSkeleton stored;
  std::uint64_t number = 0;
  const Outcome outcome = reader().newest(slot, generation, stored, number);
  if (outcome == Outcome::kNoData) {
    const Skeleton average = average_skeleton();
    for (std::size_t b = 0; b < kBoneCount; ++b)
      axes_.point_out(average.offset_m[b].data(), out.offset[b]);
    for (std::size_t t = 0; t < kTipCount; ++t)
      axes_.point_out(average.tip_m[t].data(), out.tip[t]);
    out.version = 0;
    return DANCE_OK;
  }
  if (outcome != Outcome::kFine) return status_of(outcome);
  for (std::size_t b = 0; b < kBoneCount; ++b) axes_.point_out(stored.offset_m[b], out.offset[b]);
  for (std::size_t t = 0; t < kTipCount; ++t) axes_.point_out(stored.tip_m[t], out.tip[t]);
  out.version = stored.version;
  return DANCE_OK;
}

dance_status StageReader::hands(std::size_t slot, dance_hands& out) {
  const std::uint32_t generation = reader().generation(slot);
  if (generation == 0) return DANCE_NO_GUEST;
  StoredHands stored;
  std::uint64_t number = 0;
  const Outcome outcome = reader().newest(slot, generation, stored, number);
  if (outcome != Outcome::kFine) return status_of(outcome);
  out.presence = stored.presence;
  axes_.rotations_out(stored.rotation_xyzw[0], out.rotation[0], kFingerBoneCount);
  out.capture_ns = stored.capture_ns;
  return DANCE_OK;
}

dance_status StageReader::beat(std::int64_t time_ns, dance_beat& out) {
  StoredBeat stored;
  std::uint64_t number = 0;
  const Outcome outcome = reader().newest(stored, number);
  if (outcome != Outcome::kFine) return status_of(outcome);
  if (number != beat_number_) {
    Beat heard;
    heard.time = MonoTime::from_ns(stored.time_ns);
    heard.beat_time = MonoTime::from_ns(stored.beat_time_ns);
    heard.beat = stored.beat;
    heard.tempo_bpm = stored.tempo_bpm;
    heard.beats_per_bar = stored.beats_per_bar;
    heard.confidence = stored.confidence;
    heard.playing = stored.playing != 0;
    beat_.hear(heard);
    beat_number_ = number;
  }
  const MonoTime t = MonoTime::from_ns(time_ns);
  const Beat& newest = beat_.newest();
  // Paused music is known as long as somebody says so.
  if (newest.playing ? !beat_.is_known(t) : t - newest.time > BeatClock::kTimeout)
    return DANCE_NO_DATA;
  out.position_beats = newest.playing ? beat_.position(t) : newest.beat;
  out.beats_per_bar = static_cast<std::uint32_t>(newest.beats_per_bar);
  out.tempo_bpm = newest.tempo_bpm;
  out.confidence = newest.confidence;
  out.playing = newest.playing;
  return DANCE_OK;
}

dance_counters StageReader::counters() const {
  dance_counters out{};
  out.reads = counters_.reads;
  out.retries = counters_.retries;
  out.busy = busy_;
  out.damaged = counters_.damaged;
  out.attached = attached_;
  return out;
}

}  // namespace dance::engine
