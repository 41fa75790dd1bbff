#include "tests/viewer/replay/recorded_night.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/bus/encode.h"

namespace dance {
namespace {

constexpr std::uint64_t kClock = 7;
constexpr std::size_t kGuests = 5;

MonoTime night(double s) { return MonoTime() + Duration::seconds(500.0 + s); }

class Night {
 public:
  Night(const std::string& path, bool is_packed)
      : writer_(std::move(*LogWriter::create(path))), is_packed_(is_packed) {}

  template <class Message>
  void write(double s, const Channel& channel, const Message& message) {
    MessageBuffer buffer;
    const std::size_t size = encode(message, buffer);
    const LogEvent event{count_++,
                         night(s).since_zero_us() + kNightWallAhead_us,
                         channel.view(),
                         {buffer.data(), size}};
    ASSERT_TRUE(writer_.append(is_packed_ ? packer_.pack(event) : event));
  }
  void finish() { ASSERT_TRUE(writer_.flush()); }

 private:
  LogWriter writer_;
  bool is_packed_;
  LogPacker packer_;
  std::int64_t count_ = 0;
};

// 120 beats a minute, and from the 20th second on another song at 96.
double beats_at(double s) { return s < 20.0 ? 2.0 * s : 1.6 * (s - 20.0); }

Pose pose_at(double s, std::size_t guest, std::uint32_t sequence) {
  Pose pose;
  for (std::size_t bone = 0; bone < kBoneCount; ++bone) {
    const double angle = 0.4 * std::sin(3.0 * s + static_cast<double>(bone + 7 * guest));
    pose.R_PB[bone] = Eigen::Quaternionf(
        Eigen::AngleAxisf(static_cast<float>(angle), Eigen::Vector3f(0.6f, 0.0f, 0.8f)));
  }
  pose.p_WH_m = {static_cast<float>(guest), 1.0f, static_cast<float>(std::sin(s))};
  pose.clock_id = kClock;
  pose.sequence = sequence;
  pose.capture_time = night(s);
  pose.music_beats = beats_at(s) + 0.01 * static_cast<double>(guest);
  return pose;
}

Hands hands_at(double s) {
  Hands hands;
  for (auto& rotation : hands.R_PB)
    rotation =
        Eigen::AngleAxisf(static_cast<float>(0.3 * std::sin(5.0 * s)), Eigen::Vector3f::UnitX());
  hands.presence = (1u << kFingerBoneCount) - 1;
  hands.clock_id = kClock;
  hands.capture_time = night(s);
  return hands;
}

// A line every four seconds, a sign every three.
std::optional<Chat> chat_at(double s, int frame) {
  Chat chat;
  chat.time = night(s);
  chat.clock_id = kClock;
  if (frame % 240 == 100) {
    const std::string text = "the song since " + std::to_string(frame) + " \xe2\x99\xa5";
    return chat.text.assign(text) ? std::optional(chat) : std::nullopt;
  }
  chat.kind = frame % 360 == 90 ? ChatKind::kHeart : ChatKind::kApplause;
  return frame % 180 == 90 ? std::optional(chat) : std::nullopt;
}

// Guest 1 pauses for a second every nine, guest 2 comes late and leaves, guest 3 is slow.
bool dances(std::size_t guest, double s, int frame) {
  if (guest == 1) return std::fmod(s, 9.0) < 8.0;
  if (guest == 2) return s > 6.0 && s < 31.0;
  if (guest == 3) return frame % 5 == 0;
  return true;
}

}  // namespace

void write_recorded_night(const std::string& path, double seconds, bool is_packed) {
  Night log(path, is_packed);
  std::array<std::uint32_t, kGuests> sequence{};
  for (int frame = 0; frame < static_cast<int>(60.0 * seconds); ++frame) {
    const double s = frame / 60.0;
    if (frame % 15 == 0 && (s < 18.0 || s > 20.0)) {
      Beat beat;
      beat.time = night(s);
      beat.clock_id = kClock;
      beat.beat = std::ceil(beats_at(s) + 0.01);
      beat.tempo_bpm = s < 20.0 ? 120.0 : 96.0;
      beat.beat_time =
          night(s) + Duration::seconds((beat.beat - beats_at(s)) * 60.0 / beat.tempo_bpm + 0.002);
      beat.beats_per_bar = s < 20.0 ? 4 : 3;
      beat.confidence = 1.0f;
      beat.playing = true;
      log.write(s, Channel::of_house(Signal::kBeat), beat);
    }
    if (const auto chat = chat_at(s, frame)) {
      const bool is_own = frame % 480 < 240;
      log.write(s,
                Channel::of(Signal::kChat, is_own ? Where::kCapture : Where::kGuest,
                            *GuestId::parse(is_own ? "guest-0" : "guest-4")),
                *chat);
    }
    for (std::size_t guest = 0; guest < kGuests; ++guest) {
      if (!dances(guest, s, frame)) continue;
      const GuestId id = *GuestId::parse("guest-" + std::to_string(guest));
      const double at = s + 0.0015 * static_cast<double>(guest);
      if (frame % 60 == static_cast<int>(guest)) {
        TimedSkeleton timed;
        timed.skeleton = average_skeleton(1.5f + 0.1f * static_cast<float>(guest) +
                                          0.001f * static_cast<float>(frame / 600));
        timed.clock_id = kClock;
        timed.capture_time = night(at);
        log.write(at,
                  Channel::of(Signal::kSkeleton, guest < 2 ? Where::kCapture : Where::kStage, id),
                  timed);
      }
      if (guest < 3)
        log.write(at, Channel::of(Signal::kHands, guest < 2 ? Where::kCapture : Where::kStage, id),
                  hands_at(at));
      ++sequence[guest];
      if (guest == 4 && frame % 50 == 7) continue;  // lost
      Pose pose = pose_at(at - 0.03, guest, sequence[guest]);
      if (guest < 2) {
        pose.stamp(Hop::kPublished, night(at));
        log.write(at, Channel::of(Signal::kPose, Where::kCapture, id), pose);
      }
      pose.stamp(Hop::kStaged, night(at + 0.0002));
      log.write(at + 0.0003, Channel::of(Signal::kPose, Where::kStage, id), pose);
      if (guest == 4 && frame % 60 == 30) {
        GuestStatus status;
        status.alive = true;
        status.arrival_hz = 59.0f;
        status.age_p50_ms = static_cast<float>(frame % 7);
        status.received = frame;
        status.lost = frame / 50;
        status.time = night(at);
        status.clock_id = kClock;
        if (s < 15.0) log.write(at, Channel::of(Signal::kGuest, Where::kStage, id), status);
      }
    }
  }
  log.finish();
}

}  // namespace dance
