#include "consumers/text/csv_consumer.h"

namespace dance {

CsvConsumer::CsvConsumer(std::shared_ptr<OutputFile> output, double hz)
    : output_(std::move(output)), limit_(hz) {
  line_.text(
      "heard_us,capture_us,clock_id,guest,sequence,presence,confidence,music_beats,hips_x_m,"
      "hips_y_m,hips_z_m");
  for (const BoneInfo& bone : kBones) {
    for (const char* axis : {"_x", "_y", "_z", "_w"}) {
      line_.text(",");
      line_.text(bone.name);
      line_.text(axis);
    }
  }
  line_.text("\n");
  output_->write(line_.view());
}

void CsvConsumer::on_pose(const GuestId& guest, const Pose& pose, MonoTime now) {
  ++heard_;
  if (!limit_.lets_through(guest, pose.capture_time)) return;
  line_.clear();
  line_.integer(now.since_zero_us());
  line_.text(",");
  line_.integer(pose.capture_time.since_zero_us());
  line_.text(",");
  line_.integer(pose.clock_id);
  line_.text(",");
  line_.text(guest.view());
  line_.text(",");
  line_.integer(pose.sequence);
  line_.text(",");
  line_.integer(pose.presence);
  line_.text(",");
  line_.number(pose.confidence);
  line_.text(",");
  line_.number(pose.music_beats);
  const auto next = [this](float value) {
    line_.text(",");
    line_.number(value);
  };
  for (int axis = 0; axis < 3; ++axis) next(pose.p_WH_m[axis]);
  for (const auto& rotation : pose.R_PB)
    for (const float value : {rotation.x(), rotation.y(), rotation.z(), rotation.w()}) next(value);
  line_.text("\n");
  output_->write(line_.view());
  ++written_;
}

std::string CsvConsumer::summary() const {
  return std::to_string(written_) + " rows of " + std::to_string(heard_) + " poses to " +
         output_->name();
}

}  // namespace dance
