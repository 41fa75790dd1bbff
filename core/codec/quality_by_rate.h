// Rate control: from the payloads of the last second chooses the error bound of the encoder.
// Coarser as soon as a second exceeds the rate; finer only after some seconds with room for the
// finer step, and if that does not fit, the next try waits twice as long. Changes are at least a
// second apart.
//
// Units/frames: errors in metres as PoseEncoder::set_quality() takes them; bytes are those of
//               payloads; time is the caller's clock, which does not go back.
// Ownership:    plain value.
// Threads:      none inside; one owner.
// Failure:      none. At the coarsest step, 5 mm, payloads may exceed the rate.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "core/base/time.h"

namespace dance {

class QualityByRate {
 public:
  static constexpr std::array<double, 4> kSteps_m{0.0005, 0.001, 0.002, 0.005};

  // Begins at finest_m and is never finer; bytes_per_second 0: stays there.
  explicit QualityByRate(double finest_m = 0.001, double bytes_per_second = 0.0)
      : finest_m_(finest_m), budget_(bytes_per_second) {}

  double quality_m() const {
    return step_ == 0 ? finest_m_ : kSteps_m[first_coarser() + step_ - 1];
  }

  // A payload of this size was sent; true if quality_m() changed.
  bool add(std::size_t bytes, MonoTime now) {
    if (budget_ <= 0.0) return false;
    if (!newest_.is_set() || now - newest_ > kPause) begin_anew(now);
    newest_ = now;
    turn_to(now);
    parts_[part_] += static_cast<double>(bytes);
    sum_ += static_cast<double>(bytes);
    if (now - judged_from_ < kWindow) return false;  // payloads of the old step
    if (sum_ > budget_) {
      fits_since_ = now;
      return coarser(now);
    }
    if (sum_ > kFits * budget_ || step_ == 0) {
      fits_since_ = now;
      return false;
    }
    return now - fits_since_ >= refine_delay_ && finer(now);
  }

 private:
  static constexpr Duration kWindow = Duration::s(1);
  static constexpr std::size_t kParts = 20;
  static constexpr Duration kPart = Duration::ms(50);
  // After a pause earlier measurements are void.
  static constexpr Duration kPause = Duration::ms(500);
  // A step costs 1.2 to 1.6 times the next coarser one.
  static constexpr double kFits = 0.6;
  static constexpr Duration kRefineDelay = Duration::s(3);
  static constexpr Duration kLongestRefineDelay = Duration::s(60);

  std::size_t first_coarser() const {
    std::size_t i = 0;
    while (i < kSteps_m.size() && kSteps_m[i] <= finest_m_) ++i;
    return i;
  }

  void begin_anew(MonoTime now) {
    parts_ = {};
    sum_ = 0.0;
    part_ = 0;
    part_begin_ = now;
    judged_from_ = fits_since_ = now;
  }

  void turn_to(MonoTime now) {
    while (now - part_begin_ >= kPart) {
      part_ = (part_ + 1) % kParts;
      part_begin_ = part_begin_ + kPart;
      sum_ -= parts_[part_];
      parts_[part_] = 0.0;
    }
  }

  bool coarser(MonoTime now) {
    if (step_ + first_coarser() >= kSteps_m.size()) return false;
    // The finer step does not fit.
    if (refined_at_.is_set())
      refine_delay_ = now - refined_at_ < refine_delay_ * 2
                          ? std::min(refine_delay_ * 2, kLongestRefineDelay)
                          : kRefineDelay;
    ++step_;
    refined_at_ = MonoTime();
    judged_from_ = fits_since_ = now;
    return true;
  }

  bool finer(MonoTime now) {
    --step_;
    refined_at_ = judged_from_ = fits_since_ = now;
    return true;
  }

  double finest_m_;
  double budget_;
  std::size_t step_ = 0;  // 0: finest_m_; then the coarser ones of kSteps_m
  std::array<double, kParts> parts_{};
  double sum_ = 0.0;  // whole numbers, so the sum is exact
  std::size_t part_ = 0;
  MonoTime part_begin_;
  MonoTime newest_;
  MonoTime judged_from_;  // from when on all was sent at this step
  MonoTime fits_since_;
  MonoTime refined_at_;
  Duration refine_delay_ = kRefineDelay;
};

}  // namespace dance
