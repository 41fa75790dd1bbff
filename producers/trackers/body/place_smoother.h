// PlaceSmoother: takes the tremble out of a tracker that is nearly still, and follows one that
// moves at once.
//
// Units/frames: W, metres.
// Ownership:    plain value; never allocates.
// Threads:      none inside; one owner.
// Failure:      none.
// Source:       the 1 euro filter (Casiez, Roussel and Vogel, CHI 2012).
#pragma once

#include <cmath>
#include <numbers>

#include "core/motion/rotation_vector.h"
#include "producers/trackers/tracker_mounts.h"

namespace dance {

class PlaceSmoother {
 public:
  void reset() { began_ = false; }

  Place follow(const Place& place, float seconds) {
    if (!began_ || seconds <= 0.0f || seconds > kLongestGap_s) {
      shown_ = newest_ = place;
      speed_m_s_ = speed_rad_s_ = kFast;
      began_ = true;
      return shown_;
    }
    const float known = share(kSpeedCutoff_hz, seconds);
    speed_m_s_ += known * ((place.p_W_m - newest_.p_W_m).norm() / seconds - speed_m_s_);
    speed_rad_s_ += known * (place.R_W.angularDistance(newest_.R_W) / seconds - speed_rad_s_);
    newest_ = place;
    const float moves = std::max(0.0f, speed_m_s_ - kTremble_m_s);
    const float turns = std::max(0.0f, speed_rad_s_ - kTremble_rad_s);
    shown_.p_W_m +=
        share(kLeastCutoff_hz + kPerSpeed_hz * moves, seconds) * (place.p_W_m - shown_.p_W_m);
    shown_.R_W = shown_.R_W.slerp(share(kLeastCutoff_hz + kPerTurn_hz * turns, seconds), place.R_W);
    return shown_;
  }

 private:
  static constexpr float kFast = 1.0f, kLongestGap_s = 0.2f;
  static constexpr float kSpeedCutoff_hz = 6.0f, kLeastCutoff_hz = 2.5f;
  static constexpr float kTremble_m_s = 0.05f, kTremble_rad_s = 0.2f;
  static constexpr float kPerSpeed_hz = 60.0f, kPerTurn_hz = 15.0f;

  static float share(float cutoff_hz, float seconds) {
    return 1.0f - std::exp(-2.0f * std::numbers::pi_v<float> * cutoff_hz * seconds);
  }

  Place shown_, newest_;
  float speed_m_s_ = 0.0f, speed_rad_s_ = 0.0f;
  bool began_ = false;
};

}  // namespace dance
