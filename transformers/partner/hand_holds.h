// HandHolds: what is known of a dancer's palms by those of the partner, who dances here and now:
// palms that were together stay as they were to each other. How far that holds is told by how they
// have been to each other lately (transformers/partner/palm_weights.h), and whether it holds for
// these two at all by what then came.
//
// Units/frames: metres in W; offsets of palms in a frame that turns with the line from one dancer's
//               hips to the other's.
// Ownership:    plain value; never allocates.
// Threads:      none inside; one owner.
// Failure:      without evidence nothing is pulled.
#pragma once

#include <array>

#include "core/motion/palm_pull.h"
#include "transformers/partner/partner_track.h"

namespace dance {

using Palms = std::array<Eigen::Vector3f, 2>;
constexpr std::size_t kPalmPairs = 4;  // own palm k / 2, the partner's k % 2

// What of a body has to do with the partner's.
struct Figure {
  Palms palms;
  Eigen::Vector3f p_WHips_m;
  Eigen::Vector3f facing_W;  // horizontal, unit
  std::array<Eigen::Quaternionf, 2> R_WForearm{Eigen::Quaternionf::Identity(),
                                               Eigen::Quaternionf::Identity()};
};

// How two dancers stood to each other at a moment that is known of both.
struct Meeting {
  std::array<Eigen::Vector3f, kPalmPairs> offset_m;  // of the own palm from the partner's
  Figure own;
  PartnerMoment partner;
  // As HandHolds had learnt by then.
  std::array<float, kPalmPairs> drift_m{};  // of the offset, beside its mean over some tenths
  std::array<float, kPalmPairs> proved_now{};
  std::array<float, kPalmPairs> proved{};  // -1: the prediction was right, 1: the offset
  Palms missed_m{Eigen::Vector3f::Zero(), Eigen::Vector3f::Zero()};  // by predictions of now
  float missed_ahead_s = 0.0f;                                       // made so long before

  static Meeting of(const Figure& own, const PartnerMoment& partner);
  // Where the own palm of a pair is, once the partner and the own hips are elsewhere.
  Eigen::Vector3f palm_at(std::size_t pair, const Eigen::Vector3f& hips,
                          const PartnerMoment& partner) const;
};

class HandHolds {
 public:
  // Beyond, palms have nothing to do with each other.
  static constexpr float kReach_m = 0.5f;

  void clear() { *this = HandHolds(); }
  // A pose has come: how the two stand to each other now, `step_s` after the last one.
  void follow(const Meeting& met, double step_s);
  // Tells a meeting what was learnt so far.
  void describe(Meeting& met) const;
  // A prediction whose moment has come: what it said alone `ahead_s` before, where palms are, and
  // where the partner is. `step_s`: since the last one.
  void learn(const Meeting& met, const Figure& predicted, float ahead_s, const Palms& came,
             const PartnerMoment& partner, double step_s);
  // What to do to a prediction.
  std::array<PalmPull, 2> pulls(const Meeting& met, const Figure& predicted, float ahead_s,
                                const PartnerMoment& partner) const;
  // How far the partner's hands say anything of this dancer's at all, 0 to 1.
  float trust() const;

 private:
  struct Errors {
    double offset = 0.0, plain = 0.0;  // square metres, seconds
    void add(double offset_m2, double plain_m2, double step_s) {
      offset += step_s * offset_m2;
      plain += step_s * plain_m2;
    }
    void forget(double keep) {
      offset *= keep;
      plain *= keep;
    }
    float proved(double prior_m2s) const {
      return static_cast<float>((plain - offset) / (plain + offset + prior_m2s));
    }
  };
  std::array<Errors, kPalmPairs> errors_, errors_now_;
  std::array<Eigen::Vector3f, kPalmPairs> usual_offset_m_;
  bool is_followed_ = false;
  Palms missed_m_{Eigen::Vector3f::Zero(), Eigen::Vector3f::Zero()};
  double missed_ahead_s_ = 0.0;
  double right_ = 0.0, all_ = 0.0;  // of what the partner's hands said
};

}  // namespace dance
