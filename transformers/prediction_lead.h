// PredictionLead: what of a prediction is shown where the dance is to be in time. The prediction
// with the least mean error shrinks towards the newest pose, and the further ahead, the more: its
// waves are late. The way to half the moment is surer than the way to the moment, so twice the
// half tells the wave better; and as far as what came was ahead of what was shown, the way is
// lengthened.
//
// Units/frames: `ahead` from the newest pose to the moment that is predicted.
// Ownership:    plain value, no heap.
// Threads:      none inside; one owner.
// Failure:      none; where no lead is set a prediction is shown as it is.
#pragma once

#include <array>
#include <cstddef>

#include "core/base/time.h"
#include "core/pose/pose.h"

namespace dance {

class PredictionLead {
 public:
  static constexpr std::array<Duration, 6> kHorizons{Duration::ms(60),  Duration::ms(120),
                                                     Duration::ms(180), Duration::ms(240),
                                                     Duration::ms(320), Duration::ms(400)};
  // Of the way from the newest pose: how much of twice the half, and how much of the whole.
  struct Shares {
    float of_half = 0.0f, of_whole = 1.0f;
  };

  // 0: predictions as they are … 1: all of it.
  void set_strength(float strength) { strength_ = strength; }
  bool is_none() const { return strength_ <= 0.0f; }
  // How much longer than predicted ways of that horizon turned out to be.
  void set_gain(std::size_t horizon, float gain) { gains_[horizon] = gain; }
  float gain(std::size_t horizon) const { return gains_[horizon]; }
  static float usual_gain(std::size_t horizon) { return kUsualGains[horizon]; }
  Shares at(Duration ahead) const;

 private:
  // Of dancers whom no model has seen.
  static constexpr std::array<float, 6> kUsualGains{1.02f, 1.10f, 1.2f, 1.3f, 1.3f, 1.2f};

  float strength_ = 0.0f;
  std::array<float, kHorizons.size()> gains_ = kUsualGains;
};

// `whole` is led: the ways from `from` to `half` and to `whole` in these shares, bone by bone and
// of the hips' place, saturating where that is far from what was predicted.
void add_lead(const Pose& from, const Pose& half, const PredictionLead::Shares& shares,
              Pose& whole);

}  // namespace dance
