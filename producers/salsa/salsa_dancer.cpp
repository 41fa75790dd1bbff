#include "producers/salsa/salsa_dancer.h"

#include "producers/salsa/salsa_ease.h"

namespace dance {

SalsaDancer::SalsaDancer(const SalsaStyle& style)
    : style_(style),
      score_(style),
      lead_{SalsaRole::kLead, salsa_skeleton(SalsaRole::kLead, style.seed), {}, {}},
      follow_{SalsaRole::kFollow, salsa_skeleton(SalsaRole::kFollow, style.seed), {}, {}} {}

const Skeleton& SalsaDancer::skeleton() const { return own().skeleton; }

double SalsaDancer::music_beats_at(Duration t) const {
  if (is_moved_to_music(t)) return music_->position(start_ + t);
  return style_.start_beat + t.as_seconds() * style_.tempo_bpm / 60.0;
}

void SalsaDancer::dance_at(Duration t, Pose& out) {
  // The upper body follows the hips after a twentieth of a second.
  constexpr double kDelay_s = 0.05;
  const double beats = music_beats_at(t);
  const double delay_beats = kDelay_s * style_.tempo_bpm / 60.0;
  for (Partner* partner : {&lead_, &follow_}) {
    score_.counts_around(partner->role, beats, partner->counts);
    pose_salsa_body(partner->counts, partner->skeleton, beats, delay_beats, style_.energy,
                    partner->body);
  }
  const CoupleGoals goals =
      couple_goals(lead_.skeleton, lead_.body, follow_.skeleton, follow_.body, beats);
  const bool is_lead = style_.role == SalsaRole::kLead;
  Partner& self = own();
  const Partner& other = is_lead ? follow_ : lead_;
  pose_arms(self.skeleton, is_lead ? goals.lead : goals.follow, self.body);
  pose_head(self.skeleton, other.body.frames.position(Bone::kHead), self.body);

  out.R_PB = self.body.pose.R_PB;
  out.p_WH_m = self.body.pose.p_WH_m;
  out.presence = kAllBones;
  out.confidence = 1.0f;
  out.music_beats = beats;
}

bool SalsaDancer::hands_at(Duration t, Hands& out) {
  const double beats = music_beats_at(t);
  score_.counts_around(own().role, beats, own().counts);
  pose_fingers(salsa_hold(own().counts, beats), style_.role == SalsaRole::kLead, beats, out);
  return true;
}

}  // namespace dance
