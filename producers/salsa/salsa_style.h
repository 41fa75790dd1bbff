// What makes one synthetic salsa dancer: role, tempo, seed, place. Two dancers whose styles differ
// in the role only are a couple.
//
// Units/frames: place and heading are the couple's, in W: heading 0 has the lead face +Z, positive
//               turns him to his left. Count 1 of each eight is danced where the musical time is
//               a multiple of 8 beats.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      checked_style() names the value that no salsa is danced with.
#pragma once

#include <cstdint>

#include "core/base/result.h"
#include "core/pose/skeleton.h"

namespace dance {

enum class SalsaRole : std::uint8_t { kLead, kFollow };

struct SalsaStyle {
  SalsaRole role = SalsaRole::kLead;
  double tempo_bpm = 184.0;  // beats of the music; six steps in eight beats
  std::uint64_t seed = 1;    // figures, bodies and small variations
  double start_beat = 0.0;   // musical time at t = 0
  double energy = 1.0;       // 0 marks the steps, 1 is social dancing, 1.5 a show
  double x_m = 0.0;
  double z_m = 0.0;
  double heading_deg = 0.0;
};

constexpr double kSlowestSalsa_bpm = 60.0;
constexpr double kFastestSalsa_bpm = 240.0;

// The style, or what is wrong with it and the cure.
Result<SalsaStyle> checked_style(const SalsaStyle& style);

// The body of the lead or the follow of that seed: he is about 1.78 m tall, she about 1.66 m.
Skeleton salsa_skeleton(SalsaRole role, std::uint64_t seed);

}  // namespace dance
