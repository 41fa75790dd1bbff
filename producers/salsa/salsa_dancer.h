// The synthetic salsa dancer, for machines that have no motion data at all: lead or follow of a
// couple that dances to a tempo, a different dance for each seed. A pure function of the musical
// time, so that two processes without any connection dance together.
//
// Units/frames: as producers/dancer.h; musical time is start_beat + t · tempo/60, or that of the
//               music which it hears.
// Ownership:    plain value; never allocates in dance_at.
// Threads:      none inside; one owner.
// Failure:      a style that checked_style() refuses is our bug: ask it first.
#pragma once

#include "core/base/beat_clock.h"
#include "producers/dancer.h"
#include "producers/salsa/salsa_arms.h"
#include "producers/salsa/salsa_score.h"
#include "producers/salsa/salsa_style.h"

namespace dance {

class SalsaDancer : public Dancer {
 public:
  explicit SalsaDancer(const SalsaStyle& style);

  const Skeleton& skeleton() const override;
  double natural_hz() const override { return 60.0; }
  void dance_at(Duration t, Pose& out) override;
  bool hands_at(Duration t, Hands& out) override;
  bool is_moved_to_music(Duration t) const override {
    return music_ && music_->is_known(start_ + t);
  }

  // The role counts from the next pose on.
  void set_role(SalsaRole role) { style_.role = role; }
  // Hips of either role in the last pose that was danced.
  const Eigen::Vector3f& hips_m(SalsaRole role) const {
    return (role == SalsaRole::kLead ? lead_ : follow_).body.pose.p_WH_m;
  }

  const SalsaStyle& style() const { return style_; }
  const SalsaScore& score() const { return score_; }
  double music_beats_at(Duration t) const;
  // From now on dances to the music that is heard, while there is some: `music` must outlive the
  // dancer, whose t counts from `start`.
  void listen_to(const BeatClock& music, MonoTime start) {
    music_ = &music;
    start_ = start;
  }
  // Intermediate results of dance_at: each body depends on the other.
  const SalsaBody& body() const { return own().body; }

 private:
  struct Partner {
    SalsaRole role;
    Skeleton skeleton;
    SalsaCounts counts;
    SalsaBody body;
  };
  Partner& own() { return style_.role == SalsaRole::kLead ? lead_ : follow_; }
  const Partner& own() const { return style_.role == SalsaRole::kLead ? lead_ : follow_; }

  const BeatClock* music_ = nullptr;
  MonoTime start_;
  SalsaStyle style_;
  SalsaScore score_;
  Partner lead_;
  Partner follow_;
};

}  // namespace dance
