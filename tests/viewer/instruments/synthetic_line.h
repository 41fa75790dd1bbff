// A dancer behind a line of known delay, jitter and loss, and the stage that shows the dancer, for
// the tests of instruments.
//
// Units/frames: times of the house's clock.
// Ownership:    plain values.
// Threads:      none.
// Failure:      none.
#pragma once

#include <cmath>
#include <string>

#include "core/base/guest_id.h"
#include "core/bus/messages.h"
#include "core/pose/pose.h"

namespace dance {

constexpr std::uint64_t kHouseClock = 42;
inline GuestId guest_called(const std::string& name) { return *GuestId::parse(name); }
inline MonoTime at_ms(double ms) { return MonoTime::from_ns(static_cast<std::int64_t>(ms * 1e6)); }

// The dance: the hips go to the side and the left arm turns, both at a constant speed, so that it
// is known between poses, too.
constexpr double kHips_m_per_s = 0.2;
constexpr double kArm_rad_per_s = 0.5;
inline Pose dance_at(MonoTime moment, std::uint32_t sequence) {
  const double t_s = std::fmod((moment - MonoTime()).as_seconds(), 1000.0);
  Pose pose;
  pose.clock_id = kHouseClock;
  pose.sequence = sequence;
  pose.capture_time = moment;
  pose.p_WH_m.x() = static_cast<float>(kHips_m_per_s * t_s);
  pose.R_PB[index_of(Bone::kLeftUpperArm)] =
      Eigen::AngleAxisf(static_cast<float>(kArm_rad_per_s * t_s), Eigen::Vector3f::UnitZ());
  return pose;
}

// Published after 1 ms, sent after 1 more, at the server 20 later, at the link 30 after that.
constexpr double kPublished_ms = 1.0, kSent_ms = 1.0, kServer_ms = 20.0, kReceived_ms = 30.0;
inline Pose arrived_at_house(MonoTime captured, std::uint32_t sequence, double jitter_ms = 0.0) {
  Pose pose = dance_at(captured, sequence);
  const auto after = [&](double ms) { return captured + Duration::seconds(1e-3 * ms); };
  pose.stamp(Hop::kPublished, after(kPublished_ms));
  pose.stamp(Hop::kLinkSent, after(kPublished_ms + kSent_ms));
  pose.stamp(Hop::kServer, after(kPublished_ms + kSent_ms + kServer_ms));
  pose.stamp(Hop::kLinkReceived,
             after(kPublished_ms + kSent_ms + kServer_ms + kReceived_ms + jitter_ms));
  return pose;
}

inline StageTime shown_at(const Pose& pose, MonoTime heard, MonoTime swap) {
  return {pose.clock_id, pose.sequence, pose.capture_time, pose.hops, heard, swap};
}

}  // namespace dance
