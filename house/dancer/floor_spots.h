// FloorSpots: where on the floor, and in which role, a synthetic dancer dances, so that no two
// dancers overlap. Each house decides for its own dancers alone, by the poses of the others; the
// timeouts make one of two dancers move, so that houses need not agree first.
//
// The first couple dances in the middle, further ones on rings around it. If two dancers overlap
// for longer than a timeout, one moves to the first free spot: beside a dancer without a partner,
// otherwise to a new couple. A newcomer moves at once; of two who arrive together, the later name
// moves. A chosen role is never changed, and its timeout is 5 s longer.
//
// Units/frames: metres in W; times of this house's clock.
// Ownership:    plain values; room for kMaxGuests others, further ones are ignored. No heap.
// Threads:      none inside; one owner.
// Failure:      where all spots are taken the dancer stays.
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>

#include "core/base/fixed_list.h"
#include "core/base/guest_id.h"
#include "core/base/time.h"
#include "manager/roster.h"
#include "producers/salsa/salsa_style.h"

namespace dance {

struct FloorSpot {
  SalsaRole role = SalsaRole::kLead;
  std::size_t couple = 0;
  bool operator==(const FloorSpot&) const = default;
};

// Middle of a couple.
constexpr std::size_t kFloorCouples = 37;
Eigen::Vector3f couple_middle_m(std::size_t couple);

class FloorSpots {
 public:
  // Dancers overlap if their hips are nearer to each other.
  static constexpr float kOverlap_m = 0.35f;
  // A spot is free if no hips are within this distance. In closed hold partners are 0.54 m apart.
  static constexpr float kFree_m = 0.4f;
  // A dancer without a pose for this long has left.
  static constexpr Duration kGone = Duration::s(1);
  static constexpr Duration kNewcomer = Duration::s(5);

  // Without a chosen role the dancer leads until another dancer leads at the same spot.
  FloorSpots(const GuestId& own, std::optional<SalsaRole> chosen, MonoTime start);

  // The house joins a room: dancers who are seen in the next moments were there before.
  void arrive(MonoTime now);
  // Changes the role; nullopt takes whichever is free. A partner without a chosen role yields.
  void choose(std::optional<SalsaRole> role);
  // Another dancer's hips.
  void update_other(const GuestId& guest, const Eigen::Vector3f& p_WH_m, MonoTime now);
  // The spot from now on. hips_m: the own hips now in each role, of a couple in the middle.
  const FloorSpot& update(const std::array<Eigen::Vector3f, 2>& hips_m, MonoTime now);
  const FloorSpot& spot() const { return spot_; }

 private:
  struct Other {
    GuestId guest;
    Eigen::Vector3f p_WH_m;
    MonoTime seen;
    bool was_here = false;  // before this dancer
    MonoTime overlap;       // start of the overlap; not set while apart
    bool operator==(const Other& other) const { return guest == other.guest; }
  };
  Duration overlap_timeout(const Other& other) const;
  std::optional<FloorSpot> free_spot(const std::array<Eigen::Vector3f, 2>& hips_m) const;

  GuestId own_;
  std::optional<SalsaRole> chosen_;
  MonoTime arrival_;
  FloorSpot spot_;
  FixedList<Other, kMaxGuests> others_;
};

}  // namespace dance
