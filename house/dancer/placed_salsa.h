// PlacedSalsa: a synthetic salsa dancer at the spot that FloorSpots finds. A change of role or
// place takes kChange, in which the dancer glides from where it is to the new spot.
//
// Units/frames: as producers/dancer.h; t counts from `start`, on this house's clock.
// Ownership:    owns the dancer; never allocates in dance_at.
// Threads:      none inside; one owner.
// Failure:      none.
#pragma once

#include <optional>

#include "house/dancer/floor_spots.h"
#include "producers/salsa/salsa_dancer.h"

namespace dance {

class PlacedSalsa : public Dancer {
 public:
  static constexpr Duration kChange = Duration::ms(700);

  PlacedSalsa(SalsaDancer dancer, FloorSpots spots, MonoTime start);

  // Another dancer of the stage.
  void update_other(const GuestId& guest, const Pose& pose, MonoTime now) {
    spots_.update_other(guest, pose.p_WH_m, now);
  }
  // nullopt: whichever role is free.
  void choose_role(std::optional<SalsaRole> role) { chosen_ = role; }
  // The house has joined a room.
  void arrive(MonoTime now) { spots_.arrive(now); }
  const FloorSpot& spot() const { return spots_.spot(); }

  const Skeleton& skeleton() const override { return dancer_.skeleton(); }
  double natural_hz() const override { return dancer_.natural_hz(); }
  void dance_at(Duration t, Pose& out) override;
  bool hands_at(Duration t, Hands& out) override { return dancer_.hands_at(t, out); }
  bool is_moved_to_music(Duration t) const override { return dancer_.is_moved_to_music(t); }

 private:
  SalsaDancer dancer_;
  FloorSpots spots_;
  std::optional<std::optional<SalsaRole>> chosen_;  // not applied yet
  MonoTime start_;
  std::optional<Pose> shown_;  // the last one
  Pose before_;                // the last one at the spot before
  MonoTime changed_;           // not set: never
};

}  // namespace dance
