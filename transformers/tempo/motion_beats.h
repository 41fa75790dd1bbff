// MotionBeats: the moments of a dance that people see on the beat: a foot that comes to stand, hips
// that turn back from one side to the other. Onsets of movement are not among them: nobody judges
// time by those.
//
// Units/frames: times of the poses' clock; strength in m/s of the foot's swing before it stood, or
//               metres between two turns of the hips. Known about a tenth of a second after they
//               happened.
// Ownership:    keeps the last 32; never allocates.
// Threads:      none inside; one owner.
// Failure:      none.
// Source:       end points on the beat are judged synchronous (Takehana 2019, PLOS ONE).
#pragma once

#include <array>
#include <cstdint>

#include "transformers/tempo/motion_channels.h"

namespace dance {

struct MotionBeat {
  enum class Kind : std::uint8_t { kLeftFootFall, kRightFootFall, kSwayToLeft, kSwayToRight };
  MonoTime time;
  Kind kind = Kind::kLeftFootFall;
  float strength = 0.0f;

  bool is_foot_fall() const { return kind == Kind::kLeftFootFall || kind == Kind::kRightFootFall; }
};

class MotionBeats {
 public:
  static constexpr std::size_t kKept = 32;

  // Frames at a steady rate; returns how many beats it brought.
  std::size_t add(const MotionFrame& frame);
  void forget();
  // How many there were so far, and the newest of them; back < min(count(), kKept).
  std::uint64_t count() const { return count_; }
  const MotionBeat& newest(std::size_t back = 0) const {
    return beats_[(count_ - 1 - back) % kKept];
  }

 private:
  struct Foot {
    Eigen::Vector3f p_W_m = Eigen::Vector3f::Zero();
    float speed = 0.0f;
    float peak = 0.0f;
    bool is_swinging = false;
  };

  void step(std::size_t side, const MotionFrame& frame, float dt_s);
  void sway(const MotionFrame& frame);
  void put(MonoTime time, MotionBeat::Kind kind, float strength);

  std::array<MotionBeat, kKept> beats_{};
  std::uint64_t count_ = 0;
  MonoTime last_;
  bool has_last_ = false;
  std::array<Foot, 2> feet_{};
  std::array<float, 3> sway_m_{};  // newest first
  int sway_count_ = 0;
  float extreme_m_ = 0.0f,
        turned_m_ = 0.0f;  // the furthest since the last turn, and where that was
  MonoTime extreme_time_;
  bool is_to_left_ = true;
};

}  // namespace dance
