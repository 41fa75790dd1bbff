#include "house/dancer/placed_salsa.h"

#include <utility>

#include "core/pose/interpolate.h"

namespace dance {

PlacedSalsa::PlacedSalsa(SalsaDancer dancer, FloorSpots spots, MonoTime start)
    : dancer_(std::move(dancer)), spots_(std::move(spots)), start_(start) {}

void PlacedSalsa::dance_at(Duration t, Pose& out) {
  const MonoTime now = start_ + t;
  const FloorSpot here = spots_.spot();
  if (chosen_) spots_.choose(*std::exchange(chosen_, std::nullopt));
  dancer_.set_role(here.role);
  dancer_.dance_at(t, out);
  const FloorSpot& next =
      spots_.update({dancer_.hips_m(SalsaRole::kLead), dancer_.hips_m(SalsaRole::kFollow)}, now);
  if (next != here) {
    if (shown_) {
      before_ = *shown_;
      changed_ = now;
    }
    dancer_.set_role(next.role);
    dancer_.dance_at(t, out);
  }
  out.p_WH_m += couple_middle_m(next.couple);
  if (changed_.is_set() && now - changed_ < kChange) {
    const auto share = static_cast<float>((now - changed_).as_seconds() / kChange.as_seconds());
    const double beats = out.music_beats;
    out = interpolate(before_, out, share * share * (3.0f - 2.0f * share));
    out.music_beats = beats;
  }
  shown_ = out;
}

}  // namespace dance
