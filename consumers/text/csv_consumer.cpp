#include "consumers/text/csv_consumer.h"

#include "core/pose/kinematics.h"
#include "formats/csv/dance_table.h"

namespace dance {

CsvConsumer::CsvConsumer(std::shared_ptr<OutputFile> output, double hz)
    : output_(std::move(output)), limit_(hz) {
  for (const std::string& name : table_column_names()) {
    if (!line_.view().empty()) line_.text(",");
    line_.text(name);
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
  add_places(guest, pose);
  line_.text("\n");
  output_->write(line_.view());
  ++written_;
}

void CsvConsumer::on_skeleton(const GuestId& guest, const Skeleton& skeleton, MonoTime) {
  for (Body& body : bodies_) {
    if (!(body.guest == guest)) continue;
    body.skeleton = skeleton;
    return;
  }
  // As RateLimit: more guests than a house can have stay average.
  static_cast<void>(bodies_.try_push({guest, skeleton}));
}

const Skeleton& CsvConsumer::skeleton_of(const GuestId& guest) const {
  for (const Body& body : bodies_)
    if (body.guest == guest) return body.skeleton;
  return average_;
}

void CsvConsumer::add_places(const GuestId& guest, const Pose& pose) {
  const Skeleton& skeleton = skeleton_of(guest);
  BodyFrames frames;
  forward_kinematics(skeleton, pose, frames);
  const auto add = [this](const Eigen::Vector3f& p_m) {
    for (int axis = 0; axis < 3; ++axis) {
      line_.text(",");
      line_.number(p_m[axis]);
    }
  };
  for (std::size_t b = 1; b < kBoneCount; ++b) add(frames.p_WB_m[b]);
  for (const Eigen::Vector3f& tip_m : frames.p_WT_m) add(tip_m);
  line_.text(",");
  line_.number(skeleton.hips_height_m());
}

std::string CsvConsumer::summary() const {
  return std::to_string(written_) + " rows of " + std::to_string(heard_) + " poses to " +
         output_->name();
}

}  // namespace dance
