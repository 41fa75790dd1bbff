#include "producers/camera/extras/hands_and_face.h"

namespace dance {
namespace {

constexpr HandSide other(HandSide side) {
  return side == HandSide::kLeft ? HandSide::kRight : HandSide::kLeft;
}
constexpr Bone hand_bone(HandSide side) {
  return side == HandSide::kLeft ? Bone::kLeftHand : Bone::kRightHand;
}

}  // namespace

HandsAndFace::HandsAndFace(Extras& extras, const ExtraOptions& options)
    : extras_(&extras), options_(options), fingers_(options.smooth) {
  if (extras.hands) hands_.emplace(*extras.hands);
}

void HandsAndFace::reset() {
  if (hands_) hands_->reset();
  fingers_.reset();
  wrists_.reset();
}

void HandsAndFace::steady_wrists(Pose& pose) {
  if (!hands_) return;
  for (const Bone hand : {Bone::kLeftHand, Bone::kRightHand})
    solved_[index_of(hand)] = rotation_in_W(pose, hand);
  wrists_.apply(pose.capture_time, pose);
}

void HandsAndFace::look_at_hand(const Picture& picture, HandSide side) {
  const HandLandmarks& hand = hands_->look(picture.frame, picture.body, side);
  const MonoTime now = picture.frame.capture_time;
  fingers_.see(hand, side, now);
  if (!hand.found) return;
  const auto palm = palm_of(hand, side);
  if (!palm) return;
  Eigen::Quaternionf R_WPalm = Eigen::Quaternionf(picture.R_WC) * *palm;
  HandSide shown = side;
  if (options_.is_mirrored) {
    R_WPalm = Eigen::Quaternionf(R_WPalm.w(), R_WPalm.x(), -R_WPalm.y(), -R_WPalm.z());
    shown = other(side);
  }
  wrists_.see(shown, R_WPalm, solved_[index_of(hand_bone(shown))], hand.trust(), now);
}

void HandsAndFace::publish_hands(const Picture& picture) {
  Hands hands;
  const bool is_any = fingers_.write(picture.frame.capture_time, hands);
  // Once more when they are relaxed; then there is nothing to say until one is seen.
  if (!is_any && has_said_relaxed_) return;
  has_said_relaxed_ = !is_any;
  if (options_.is_mirrored) mirror(hands);
  hands.sequence = picture.pose.sequence;
  hands.clock_id = picture.pose.clock_id;
  hands.capture_time = picture.pose.capture_time;
  picture.sink.capture(picture.guest, hands);
}

void HandsAndFace::look(const Picture& picture) {
  const std::uint64_t turn = pictures_++;
  const auto is_due = [&](HandSide side) {
    const auto own = static_cast<std::uint64_t>(side);
    switch (extras_->load.step()) {
      case LoadStep::kAll:
        return true;
      case LoadStep::kAlternating:
        return turn % 2 == own;
      case LoadStep::kOneInTurn:
        return turn % 6 == 2 * own;
      case LoadStep::kBodyOnly:
        break;
    }
    return false;
  };
  if (!hands_) return;
  for (const HandSide side : {HandSide::kLeft, HandSide::kRight})
    if (is_due(side)) look_at_hand(picture, side);
  publish_hands(picture);
}

}  // namespace dance
