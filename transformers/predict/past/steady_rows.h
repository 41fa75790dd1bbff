// SteadyRows: poses as they come, of whatever rate and with uneven times, as rows at a steady 60 a
// second; and how much the sensor trembles.
//
// Units/frames: capture times; rows as transformers/predict/model/body_row.h. The rows' times
//               follow a source of about 60 Hz, so that its poses are taken as they are; others are
//               interpolated. A bone that turns impossibly fast is held where it was, for 70 ms at
//               most; of a sensor of 15 Hz and less hardly any.
// Ownership:    plain value; never allocates.
// Threads:      none inside; one owner.
// Failure:      a pose that is not newer is refused; after a gap of a second, a jump back or
//               another clock it starts anew.
#pragma once

#include <array>
#include <cstdint>

#include "core/base/time.h"
#include "transformers/predict/model/body_net.h"
#include "transformers/predict/model/body_row.h"

namespace dance {

class SteadyRows {
 public:
  enum class Heard { kRefused, kRestarted, kTaken };
  static constexpr Duration kLongestGap = Duration::s(1);

  explicit SteadyRows(const BodySpace& space) : space_(space) {}

  Heard observe(const Pose& pose);
  // The rows that have become due, oldest first; false when there are no more.
  bool next(BodyRow& row);

  // Of the row that next() gave last, and of the newest pose.
  MonoTime row_time() const { return row_time_; }
  MonoTime seen_time() const { return seen_time_; }
  const BodyRow& seen() const { return seen_; }
  // How often a bone was held.
  std::uint64_t held() const { return held_; }
  // How many rows a pose of that moment would bring.
  double rows_until(MonoTime capture) const;
  // The next pose is the first.
  void forget() { is_empty_ = true; }
  // Standard deviation of a bone's angle about each axis, rad: what is not movement.
  float tremble_rad() const { return tremble_rad_; }

 private:
  void follow_source(MonoTime capture);
  void note_tremble(const BodyRow& row);
  void hold_lost_bones(Duration step, Pose& pose);

  static constexpr std::size_t kLooked = 4;

  const BodySpace& space_;
  bool is_empty_ = true;
  std::uint64_t clock_id_ = 0;
  BodyRow before_, seen_;
  BoneRotations accepted_;
  std::array<Duration, kBoneCount> lost_{};  // for how long, or how much doubt is left
  std::uint64_t held_ = 0;
  MonoTime before_time_, seen_time_;
  MonoTime row_time_, due_time_;
  std::array<BodyRow, kLooked> looked_;  // the rows before, newest first
  std::size_t looked_count_ = 0;
  std::array<float, kBoneNumbers> third_differences_{};  // mean squares
  std::uint32_t rows_ = 0;
  float tremble_rad_ = 0.0f;
};

}  // namespace dance
