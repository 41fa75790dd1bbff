// PeopleWatch: whether the one who is followed is still the same after somebody crossed in front.
// It remembers how everybody moved before they met; once they have parted, whoever stands where the
// one who is followed would be by that motion is the one.
//
// Units/frames: regions in pixels; times are those of the frames.
// Ownership:    plain value, no heap.
// Threads:      none inside.
// Failure:      none; where it cannot be told, nobody is exchanged.
#pragma once

#include <array>
#include <optional>
#include <span>

#include "core/base/time.h"
#include "producers/camera/estimator/person_detector.h"

namespace dance {

class PeopleWatch {
 public:
  // So often the whole picture is looked at while somebody is followed: alone, and in company.
  static constexpr Duration kAlone = Duration::s(1);
  static constexpr Duration kInCompany = Duration::ms(200);

  bool is_due(MonoTime now) const;
  // Everybody in the picture, and the region of the one who is followed. Gives the region of the
  // one who is to be followed from now on, where that is somebody else.
  std::optional<BodyRegion> look(std::span<const SeenPerson> people, const BodyRegion& followed,
                                 MonoTime now);
  // The one who is followed was lost, maybe behind somebody.
  void lose(MonoTime now);
  void forget() { *this = {}; }

 private:
  static constexpr std::size_t kMostOthers = PersonDetector::kMostPeople;
  struct Walker {
    BodyRegion region;
    Eigen::Vector2f speed_px_s = Eigen::Vector2f::Zero();
    MonoTime seen;
    int looks = 0;
    Eigen::Vector2f expected(MonoTime now) const;
    void see(const BodyRegion& is, MonoTime now);
  };
  struct Meeting {
    Walker ours, other;
  };

  // Whoever is known and nearest to the place, where somebody is within it.
  const Walker* nearest_other(const Eigen::Vector2f& place_px, float within_px, MonoTime now) const;
  std::optional<BodyRegion> part(std::span<const SeenPerson> people, const BodyRegion& followed,
                                 MonoTime now);
  void note_others(std::span<const SeenPerson> people, const BodyRegion& followed, MonoTime now);

  std::optional<MonoTime> last_look_;
  Walker ours_;
  std::array<Walker, kMostOthers> others_;
  std::size_t other_count_ = 0;
  std::optional<Meeting> meeting_;  // as it was before
};

}  // namespace dance
