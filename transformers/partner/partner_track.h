// PartnerTrack: where the hands and the hips of a dancer of this house have been in the last second
// and are now: what the prediction of a remote partner may know without any delay.
//
// Units/frames: metres in W; capture times of this house's clock.
// Ownership:    a ring of kKept moments; never allocates after construction.
// Threads:      none inside; one owner.
// Failure:      at() is nothing for a moment before those that are kept, or further beyond the
//               newest than kAhead. Poses that are not newer are refused.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <optional>

#include "core/pose/pose.h"
#include "core/pose/skeleton.h"

namespace dance {

struct PartnerMoment {
  MonoTime time;
  std::array<Eigen::Vector3f, 2> p_WPalm_m;
  Eigen::Vector3f p_WHips_m;
  Eigen::Vector3f facing_W;  // horizontal, unit
  std::array<Eigen::Quaternionf, 2> R_WHand{Eigen::Quaternionf::Identity(),
                                            Eigen::Quaternionf::Identity()};
};

// Which way somebody faces on the floor who looks along v.
Eigen::Vector3f facing_along(const Eigen::Vector3f& v);

class PartnerTrack {
 public:
  static constexpr std::size_t kKept = 256;  // two seconds at 120 Hz
  static constexpr Duration kAhead = Duration::ms(60);
  // Shorter, a sensor's noise would be thrown far.
  static constexpr Duration kSlope = Duration::ms(40);
  // A pose that came after a longer gap does not go on from the one before.
  static constexpr Duration kGap = Duration::ms(250);

  PartnerTrack();
  void clear() { size_ = 0; }
  void set_body(const Skeleton& skeleton);
  void take(const Pose& pose);

  bool is_empty() const { return size_ == 0; }
  const PartnerMoment& newest() const { return moments_[(next_ + kKept - 1) % kKept]; }
  std::uint64_t clock_id() const { return clock_id_; }
  // Between two moments as a straight line; beyond the newest as it went over the last kSlope.
  std::optional<PartnerMoment> at(MonoTime time) const;
  // The same; further beyond the newest what would be there at kAhead.
  std::optional<PartnerMoment> at_latest(MonoTime time) const;

 private:
  const PartnerMoment& back(std::size_t age) const {
    return moments_[(next_ + 2 * kKept - 1 - age) % kKept];
  }

  Skeleton skeleton_;
  std::array<PartnerMoment, kKept> moments_;
  std::size_t next_ = 0, size_ = 0;
  std::uint64_t clock_id_ = 0;
};

}  // namespace dance
