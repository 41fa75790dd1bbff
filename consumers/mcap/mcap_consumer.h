// McapConsumer: a night as it is heard, as MCAP for Foxglove: transforms, bodies, hands and beats.
// docs/files.md has the channels.
//
// Units/frames: messages have the wall clock's time at which they were heard.
// Ownership:    keeps its output; else as formats/mcap/dance_mcap_writer.h.
// Threads:      none inside; one owner. 24 µs a pose without hands (dance bench parts).
// Failure:      finish() tells what could not be written. A second that was heard can be read even
//               when this program is killed.
#pragma once

#include <memory>

#include "consumers/output_file.h"
#include "consumers/pose_consumer.h"
#include "consumers/rate_limit.h"
#include "formats/mcap/dance_mcap_writer.h"

namespace dance {

class McapConsumer : public PoseConsumer {
 public:
  // At most hz poses a second for each guest; 0 = all. wall_ahead: of this process's clock.
  McapConsumer(std::shared_ptr<OutputFile> output, double hz, Duration wall_ahead);

  void on_pose(const GuestId& guest, const Pose& pose, MonoTime now) override;
  void on_skeleton(const GuestId& guest, const Skeleton& skeleton, MonoTime now) override;
  void on_hands(const GuestId& guest, const Hands& hands, MonoTime now) override;
  void on_beat(const Beat& beat, MonoTime now) override;
  void on_second(MonoTime now) override;
  Result<void> flush() override { return output_->flush(); }
  Result<void> finish() override;
  std::string summary() const override;

 private:
  std::int64_t wall_us(MonoTime now) const { return (now + wall_ahead_).since_zero_us(); }

  std::shared_ptr<OutputFile> output_;
  DanceMcapWriter writer_;
  RateLimit pose_limit_;
  RateLimit hands_limit_;
  Duration wall_ahead_;
  bool is_finished_ = false;
};

}  // namespace dance
