// PartnerGuide: what the dancers of this house, who are known without any delay, tell of a remote
// dancer who is predicted: finds the partner, and draws predicted palms to where the partner's are,
// as far as that has proved right (transformers/partner/hand_holds.h). Where there is no partner,
// or one whose hands say nothing, predictions stay as they are.
//
// Units/frames: moments are capture times of the remote dancer, mapped to this house's clock; what
//               is shown of a moment is shown beside what this house dances `lag` after it.
// Ownership:    refers to the tracks, which must outlive it; never allocates.
// Threads:      none inside; one owner.
// Failure:      none.
#pragma once

#include <array>
#include <optional>

#include "transformers/partner/couple_finder.h"
#include "transformers/partner/hand_holds.h"
#include "transformers/partner/partner_tracks.h"
#include "transformers/predict/extrapolator.h"

namespace dance {

class PartnerGuide {
 public:
  PartnerGuide();
  void set_dancers(const PartnerTracks* dancers);
  void set_body(const Skeleton& skeleton);
  // The remote dancer began anew.
  void restart();
  // Once a picture, before what is shown is asked for: the moment that is shown at `now`.
  void set_shown(MonoTime moment, MonoTime now);
  // A pose of the remote dancer has come at `now`; the extrapolator has it already.
  void observe(const Pose& pose, MonoTime now, const Extrapolator& extrapolator);
  // Whether the partner was seen to dance on between the last two pictures: predictions change.
  bool has_news() const { return has_news_; }
  // Corrects the prediction of a moment behind the newest pose.
  void guide(MonoTime moment, Pose& pose) const;
  // What the partner says of the palms of that prediction; nothing while that is not known.
  std::optional<std::array<PalmGuesses, 2>> guesses(MonoTime moment, const Pose& pose) const;

  // Nobody while there is no couple.
  std::optional<GuestId> partner() const;
  const HandHolds& holds() const { return holds_; }

 private:
  // A prediction that waits for its moment.
  struct Probe {
    MonoTime moment;
    Meeting met;
    Figure predicted;
    float ahead_s;
  };
  static constexpr std::size_t kProbes = 64;
  struct Shape {
    MonoTime time;
    Figure figure;
  };

  Shape shape_of(const Pose& pose) const;
  const PartnerTrack* track() const;
  std::optional<Meeting> meeting() const;
  void learn(const Shape& now);
  void probe(const Extrapolator& extrapolator);
  void follow_strength(bool is_couple, double step_s);

  const PartnerTracks* dancers_ = nullptr;
  Skeleton skeleton_;
  CoupleFinder finder_;
  std::optional<std::size_t> partner_;  // whose hands are learnt of
  std::uint32_t partner_generation_ = 0;
  HandHolds holds_;
  float strength_ = 0.0f;
  Duration lag_;
  Shape newest_{};
  bool has_newest_ = false;
  bool was_met_ = false;
  bool has_news_ = false;
  MonoTime partner_seen_;
  std::array<Probe, kProbes> probes_;
  std::size_t first_probe_ = 0, probe_count_ = 0;
  MonoTime probed_at_, learnt_at_;
  std::uint64_t clock_id_ = 0;
  // How far ahead predictions are asked for.
  Duration ahead_ = Duration::ms(150);
};

}  // namespace dance
