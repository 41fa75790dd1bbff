// How likely it is that a foot stands, by what is predicted of it just before and just after the
// moment. Predicted feet land late and hardly ever stand: no threshold on their speed at the moment
// itself tells as much.
//
// Units/frames: metres in W, +Y up. Odds are natural logarithms: 0 is even.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      not finite where a place is not: then nothing is known.
// Source:       logistic regression over predictions 50 to 230 ms ahead of salsa of CMU subjects
//               60 and 61 together, each predicted by a model that was trained on the other; a foot
//               stands that is slower than 0.15 m/s and lower than 5 cm. Fitted to one dancer alone
//               such weights order the feet of the other with an area under the curve of 0.89 to
//               0.78; the speed at the moment alone does with 0.81 to 0.74.
#pragma once

#include <Eigen/Core>
#include <algorithm>

#include "core/base/time.h"

namespace dance {

// Between the moment and the places before and after it.
constexpr Duration kStandingOddsStep = Duration::ms(65);

inline float standing_log_odds(const Eigen::Vector3f& before, const Eigen::Vector3f& there,
                               const Eigen::Vector3f& after, float floor_m) {
  constexpr float kPer_s = 1e3f / 65.0f, kSlow_m_s = 0.3f;
  const float came_m_s = kPer_s * (there - before).norm();
  const float goes_m_s = kPer_s * (after - there).norm();
  const float above_m = std::clamp(there.y() - floor_m, -0.05f, 0.2f);
  const float will_be_above_m = std::clamp(after.y() - floor_m, -0.05f, 0.2f);
  return 2.79f - 4.15f * came_m_s / (came_m_s + kSlow_m_s) -
         1.82f * goes_m_s / (goes_m_s + kSlow_m_s) - 53.8f * above_m + 18.2f * will_be_above_m;
}

}  // namespace dance
