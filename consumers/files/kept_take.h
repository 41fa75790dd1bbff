// KeptTake: a consumer whose file can only be written at its end (BVH, GLB), with an LCM log of the
// same poses beside it, OUTPUT.lcm, which is written as they arrive. So a take is on the disk while
// it is danced. The log is removed when the file holds all of it; it stays where guests or frames
// were left out.
//
// Ownership:    owns the consumer and the log.
// Failure:      make() refuses a log that is there already: it is a take that was never finished.
//               flush() reports the first write of the log that failed; the consumer goes on.
//               finish() names the log where the file could not be written.
#pragma once

#include <memory>
#include <string>

#include "consumers/pose_consumer.h"
#include "core/net/clock/recording_clock.h"
#include "formats/recording/log_sink.h"

namespace dance {

class KeptTake : public PoseConsumer {
 public:
  // The consumer of `output` is the one that is passed; `guest` as it has it.
  static Result<std::unique_ptr<PoseConsumer>> make(std::unique_ptr<PoseConsumer> consumer,
                                                    const std::string& output,
                                                    const GuestId& guest);
  // An Error where an earlier take lies there.
  static Result<void> check(const std::string& output);

  void on_pose(const GuestId& guest, const Pose& pose, MonoTime now) override;
  void on_skeleton(const GuestId& guest, const Skeleton& skeleton, MonoTime now) override;
  void on_hands(const GuestId& guest, const Hands& hands, MonoTime now) override;
  void on_second(MonoTime now) override;
  Result<void> flush() override;
  Result<void> finish() override;
  std::uint64_t left_out() const override { return consumer_->left_out(); }
  std::string summary() const override;

 private:
  KeptTake(std::unique_ptr<PoseConsumer> consumer, LogWriter writer, std::string log_path,
           const GuestId& guest);
  bool is_wanted(const GuestId& guest) const { return !only_.is_set() || guest == only_; }

  std::unique_ptr<PoseConsumer> consumer_;
  LogSink log_;
  std::string log_path_;
  GuestId only_;
  RecordingClock clock_;
  Result<void> flushed_;
  bool has_pose_ = false;
  bool is_finished_ = false;
  bool keeps_log_ = false;
};

}  // namespace dance
