// CoupleFinder: with whom of this house a remote dancer dances, if with anyone: who is near, faces
// them and has had hands near theirs over the last seconds.
//
// Units/frames: metres in W; one call a pose of the remote dancer.
// Ownership:    plain value; never allocates.
// Threads:      none inside; one owner.
// Failure:      none(); a dancer who is not heard of any more is nobody's partner.
#pragma once

#include <array>
#include <optional>

#include "transformers/partner/hand_holds.h"
#include "transformers/partner/partner_tracks.h"

namespace dance {

class CoupleFinder {
 public:
  void clear() { *this = CoupleFinder(); }
  // A dancer of this house who was not seen for so long is nobody's partner.
  static constexpr Duration kUnseen = Duration::ms(500);

  // Where the remote dancer is, and when it is now in this house.
  struct Stance {
    Palms palms;
    Eigen::Vector3f hips, facing;
    std::uint64_t clock_id = 0;
    MonoTime then;  // the moment of this house at which the dancers are compared
    MonoTime now;
  };
  // Returns the place of the partner.
  std::optional<std::size_t> update(const PartnerTracks& dancers, const Stance& stance,
                                    double step_s);
  // How much of a couple two dancers have been, 0 to 1.
  float score(std::size_t place) const { return scores_[place]; }
  // How much two dancers are one at a moment, 0 to 1.
  static float likeness(const Palms& own, const Eigen::Vector3f& hips,
                        const Eigen::Vector3f& facing, const PartnerMoment& other);

 private:
  std::array<float, PartnerTracks::kMost> scores_{};
  std::array<std::uint32_t, PartnerTracks::kMost> generations_{};
  std::optional<std::size_t> partner_;
};

}  // namespace dance
