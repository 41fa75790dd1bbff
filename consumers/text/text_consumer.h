// TextConsumer: a line for each pose, for people and for grep.
//
// Units/frames: seconds since the first pose heard, hips in metres, age in milliseconds.
// Ownership:    keeps its output.
// Threads:      none inside; one owner.
// Failure:      finish() tells what could not be written.
#pragma once

#include "consumers/output_file.h"
#include "consumers/pose_consumer.h"
#include "consumers/rate_limit.h"
#include "consumers/text/line_builder.h"

namespace dance {

class TextConsumer : public PoseConsumer {
 public:
  // At most hz lines a second for each guest; 0 = all. Ages only of poses with this clock.
  TextConsumer(std::shared_ptr<OutputFile> output, double hz, std::uint64_t own_clock_id)
      : output_(std::move(output)), limit_(hz), own_clock_id_(own_clock_id) {}

  void on_pose(const GuestId& guest, const Pose& pose, MonoTime now) override;
  Result<void> flush() override { return output_->flush(); }
  Result<void> finish() override { return output_->flush(); }
  std::string summary() const override;

 private:
  std::shared_ptr<OutputFile> output_;
  RateLimit limit_;
  std::uint64_t own_clock_id_;
  LineBuilder line_;
  MonoTime first_;
  std::uint64_t heard_ = 0;
  std::uint64_t written_ = 0;
};

}  // namespace dance
