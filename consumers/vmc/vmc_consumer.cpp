#include "consumers/vmc/vmc_consumer.h"

namespace dance {

Result<std::unique_ptr<PoseConsumer>> VmcConsumer::open(const ConsumerOptions& options) {
  DANCE_TRY(OscOutput output, OscOutput::open(options.address, kUsualAddress));
  return std::unique_ptr<PoseConsumer>(new VmcConsumer(options, std::move(output)));
}

VmcConsumer::VmcConsumer(const ConsumerOptions& options, OscOutput output)
    : guest_(options.guest),
      rate_(options.hz),
      output_(std::move(output)),
      writer_(output_, options.dialect == "vrm1" ? VmcDialect::kVrm1 : VmcDialect::kVrm0) {}

// Poses of another clock (the dancer comes over another way), or of a clock that was set back, go
// on where the last ones ended.
float VmcConsumer::time_of(const Pose& pose, MonoTime now) {
  const bool is_first = !heard_.is_set();
  const bool is_set_back = captured_ - pose.capture_time > kSilence;
  if (is_first || pose.clock_id != clock_id_ || is_set_back) {
    const Duration elapsed =
        is_first ? Duration() : Duration::seconds(static_cast<double>(time_s_)) + (now - heard_);
    zero_ = pose.capture_time - elapsed;
    clock_id_ = pose.clock_id;
  }
  captured_ = pose.capture_time;
  return static_cast<float>((pose.capture_time - zero_).as_seconds());
}

void VmcConsumer::on_pose(const GuestId& guest, const Pose& pose, MonoTime now) {
  if (!guest_.takes_pose_of(guest)) return;
  const bool is_first = !heard_.is_set();
  time_s_ = time_of(pose, now);
  heard_ = now;
  if (!rate_.lets_through(guest, pose.capture_time)) {
    ++above_rate_;
    return;
  }
  if (is_first) writer_.write_model(guest.c_str());
  is_silent_ = false;
  if (now - hands_heard_ > kHandsKept) has_hands_ = false;
  // Receivers keep an expression until another comes: one at rest is the last.
  const bool is_last_face = has_face_ && now - face_heard_ > kFaceKept;
  if (is_last_face) face_ = Face();
  writer_.write_pose(pose, has_hands_ ? &hands_ : nullptr, time_s_, has_face_ ? &face_ : nullptr);
  if (is_last_face) has_face_ = false;
  ++frames_;
}

void VmcConsumer::on_skeleton(const GuestId& guest, const Skeleton& skeleton, MonoTime) {
  if (!guest_.takes(guest) || skeleton == skeleton_) return;
  skeleton_ = skeleton;
  writer_.set_skeleton(skeleton);
}

void VmcConsumer::on_hands(const GuestId& guest, const Hands& hands, MonoTime now) {
  if (!guest_.takes(guest)) return;
  hands_ = hands;
  has_hands_ = hands.presence != 0;
  hands_heard_ = now;
}

void VmcConsumer::on_face(const GuestId& guest, const Face& face, MonoTime now) {
  if (!guest_.takes(guest)) return;
  face_ = face;
  has_face_ = true;
  face_heard_ = now;
}

void VmcConsumer::on_second(MonoTime now) {
  output_.report("vmc");
  const bool has_dancer = heard_.is_set();
  if (has_dancer && now - heard_ < kSilence) {
    writer_.write_model(guest_.guest().c_str());
    return;
  }
  if (!is_silent_) ++silences_;
  is_silent_ = true;
  const float since_s = has_dancer ? static_cast<float>((now - heard_).as_seconds()) : 0.0f;
  writer_.write_silence(has_dancer, time_s_ + since_s);
}

Result<void> VmcConsumer::finish() {
  writer_.write_silence(heard_.is_set(), time_s_);
  return {};
}

std::string VmcConsumer::summary() const {
  std::string line = "vmc: " + std::to_string(frames_) + " frames of " +
                     (guest_.guest().is_set() ? std::string(guest_.guest().view()) : "nobody") +
                     " " + output_.summary();
  if (above_rate_ > 0)
    line += "; " + std::to_string(above_rate_) + " poses above the rate left out";
  if (guest_.others() > 0)
    line += "; " + std::to_string(guest_.others()) +
            " poses of other guests left out: one address shows one dancer";
  if (silences_ > 0) line += "; silent " + std::to_string(silences_) + " times";
  return line;
}

}  // namespace dance
