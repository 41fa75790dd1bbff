#include "consumers/files/kept_take.h"

#include <filesystem>

namespace dance {
namespace {

std::string log_beside(const std::string& output) { return output + ".lcm"; }

}  // namespace

KeptTake::KeptTake(std::unique_ptr<PoseConsumer> consumer, LogWriter writer, std::string log_path,
                   const GuestId& guest)
    : consumer_(std::move(consumer)),
      log_(std::move(writer), Where::kStage),
      log_path_(std::move(log_path)),
      only_(guest) {}

Result<void> KeptTake::check(const std::string& output) {
  const std::string log = log_beside(output);
  std::error_code error;
  if (!std::filesystem::exists(log, error)) return {};
  return fail(log + ": is there already, from a take that was not finished; dance convert " + log +
              " makes a file of it, then remove it; or give another name");
}

Result<std::unique_ptr<PoseConsumer>> KeptTake::make(std::unique_ptr<PoseConsumer> consumer,
                                                     const std::string& output,
                                                     const GuestId& guest) {
  DANCE_TRY(LogWriter writer, LogWriter::create(log_beside(output)));
  return std::unique_ptr<PoseConsumer>(
      new KeptTake(std::move(consumer), std::move(writer), log_beside(output), guest));
}

void KeptTake::on_pose(const GuestId& guest, const Pose& pose, MonoTime now) {
  if (is_wanted(guest)) {
    log_.on_pose(guest, pose, clock_.wall_us(now));
    has_pose_ = true;
  }
  consumer_->on_pose(guest, pose, now);
}

void KeptTake::on_skeleton(const GuestId& guest, const Skeleton& skeleton, MonoTime now) {
  if (is_wanted(guest)) log_.on_skeleton(guest, skeleton, clock_.wall_us(now));
  consumer_->on_skeleton(guest, skeleton, now);
}

void KeptTake::on_hands(const GuestId& guest, const Hands& hands, MonoTime now) {
  if (is_wanted(guest)) log_.on_hands(guest, hands, clock_.wall_us(now));
  consumer_->on_hands(guest, hands, now);
}

void KeptTake::on_second(MonoTime now) {
  consumer_->on_second(now);
  if (flushed_) flushed_ = log_.finish();
}

Result<void> KeptTake::flush() {
  if (auto flushed = consumer_->flush(); !flushed) return flushed;
  return flushed_;
}

Result<void> KeptTake::finish() {
  if (is_finished_) return consumer_->finish();
  is_finished_ = true;
  flushed_ = log_.finish();
  auto finished = consumer_->finish();
  keeps_log_ = has_pose_ && finished && consumer_->left_out() > 0;
  if (keeps_log_) return finished;
  if (finished || !has_pose_) {
    std::error_code ignored;
    std::filesystem::remove(log_path_, ignored);
    return finished;
  }
  return fail(finished.error().what + "; the take is in " + log_path_ + (flushed_ ? "" : ", cut") +
              ": dance convert makes a file of it");
}

std::string KeptTake::summary() const {
  return consumer_->summary() + (keeps_log_ ? "; all of it is in " + log_path_ : "");
}

}  // namespace dance
