// Dances to style, and what the filter makes of them.
//
// Units/frames: as transformers/style/stylize.h; takes are seconds long.
// Ownership:    plain values.
// Threads:      any.
// Failure:      none.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "producers/salsa/salsa_dancer.h"
#include "research/style/stylize_eval.h"
#include "transformers/style/stylize.h"

namespace dance {

inline Style style_of(BodyZone zone, double gain, double mix) {
  Style style;
  style.gain[index_of(zone)] = static_cast<float>(gain);
  style.dynamic = static_cast<float>(mix);
  return style;
}

inline StyleTake salsa_take(double hz, double length_s, bool with_music = true) {
  SalsaStyle style;
  style.seed = 4;
  SalsaDancer dancer(style);
  StyleTake take{"salsa", dancer.skeleton(), hz, style.tempo_bpm, {}};
  for (int i = 0; i < static_cast<int>(length_s * hz); ++i) {
    Pose pose;
    dancer.dance_at(Duration::seconds(i / hz), pose);
    pose.capture_time = MonoTime::from_ns(static_cast<std::int64_t>(1e9 * (1.0 + i / hz)));
    pose.clock_id = 1;
    if (!with_music) pose.music_beats = kNoMusic;
    take.poses.push_back(pose);
  }
  return take;
}

inline bool is_bit_for_bit(const Pose& a, const Pose& b) {
  return std::memcmp(a.R_PB.data(), b.R_PB.data(), sizeof(a.R_PB)) == 0 && a.p_WH_m == b.p_WH_m;
}

inline bool is_sound(const Pose& pose) {
  for (const auto& R : pose.R_PB)
    if (!R.coeffs().allFinite() || std::abs(R.norm() - 1.0f) > 1e-5f) return false;
  return pose.p_WH_m.allFinite();
}

inline Pose shown(Stylize& filter, const Pose& pose) {
  filter.observe(pose, pose.capture_time);
  Pose out = pose;
  filter.apply(pose.capture_time, out);
  return out;
}

}  // namespace dance
