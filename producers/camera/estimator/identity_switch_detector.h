// IdentitySwitchDetector: detects that the tracker has switched to another person after two people
// crossed. It keeps everybody's motion from before; once they are apart again, the person nearest
// to the target's extrapolated place is the target.
//
// Units/frames: regions in pixels; times are those of the frames.
// Ownership:    plain value, no heap.
// Threads:      none inside.
// Failure:      none; in doubt the target is kept.
#pragma once

#include <array>
#include <optional>
#include <span>

#include "core/base/time.h"
#include "producers/camera/estimator/person_detector.h"

namespace dance {

class IdentitySwitchDetector {
 public:
  // How often the whole picture is searched during tracking: with one person in it, and with more.
  static constexpr Duration kAlone = Duration::s(1);
  static constexpr Duration kInCompany = Duration::ms(200);

  bool is_due(MonoTime now) const;
  // Everybody in the picture, and the target's region. Returns the region to track from now on
  // where the target was switched.
  std::optional<BodyRegion> update(std::span<const SeenPerson> people, const BodyRegion& followed,
                                   MonoTime now);
  // The target was lost, maybe hidden behind another person.
  void on_lost(MonoTime now);
  void reset() { *this = {}; }

 private:
  static constexpr std::size_t kMostOthers = PersonDetector::kMostPeople;
  struct Track {
    BodyRegion region;
    Eigen::Vector2f speed_px_s = Eigen::Vector2f::Zero();
    MonoTime seen;
    int updates = 0;
    Eigen::Vector2f expected(MonoTime now) const;
    void update(const BodyRegion& is, MonoTime now);
  };
  struct Crossing {
    Track ours, other;
  };

  // The nearest known track within that distance.
  const Track* nearest_other(const Eigen::Vector2f& place_px, float within_px, MonoTime now) const;
  std::optional<BodyRegion> resolve(std::span<const SeenPerson> people, const BodyRegion& followed,
                                    MonoTime now);
  void update_others(std::span<const SeenPerson> people, const BodyRegion& followed, MonoTime now);

  std::optional<MonoTime> last_update_;
  Track ours_;
  std::array<Track, kMostOthers> others_;
  std::size_t other_count_ = 0;
  std::optional<Crossing> crossing_;  // as it was before
};

}  // namespace dance
