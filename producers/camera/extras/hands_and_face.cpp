#include "producers/camera/extras/hands_and_face.h"

#include "core/pose/mirror.h"
#include "producers/camera/face/gaze.h"

namespace dance {
namespace {

constexpr HandSide other(HandSide side) {
  return side == HandSide::kLeft ? HandSide::kRight : HandSide::kLeft;
}
constexpr Bone hand_bone(HandSide side) {
  return side == HandSide::kLeft ? Bone::kLeftHand : Bone::kRightHand;
}

// As what belongs to this pose.
void stamp(auto& message, const Pose& pose, MonoTime time) {
  message.sequence = pose.sequence;
  message.clock_id = pose.clock_id;
  message.capture_time = time;
}

}  // namespace

HandsAndFace::HandsAndFace(Extras& extras, const ExtraOptions& options)
    : extras_(&extras), options_(options), fingers_(options.smooth), expressions_(options.smooth) {
  if (extras.hands) hands_.emplace(*extras.hands);
  if (extras.face) face_.emplace(*extras.face);
}

void HandsAndFace::reset() {
  if (hands_) hands_->reset();
  fingers_.reset();
  wrists_.reset();
  if (face_) face_->reset();
  expressions_.reset();
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
    R_WPalm = mirrored(R_WPalm);
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
  stamp(hands, picture.pose, picture.pose.capture_time);
  picture.sink.capture(picture.guest, hands);
}

void HandsAndFace::publish_face(const Picture& picture) {
  Face face;
  const bool is_any = expressions_.write(picture.frame.capture_time, face);
  if (!is_any && has_said_rest_) return;
  has_said_rest_ = !is_any;
  const bool is_seen = (face.presence & kFaceSeen) != 0;
  if (is_seen) face.R_PB = Eigen::Quaternionf(picture.R_WC) * expressions_.R_CHead();
  if (options_.is_mirrored) mirror(face);
  face.R_PB = is_seen
                  ? (rotation_in_W(picture.pose, Bone::kNeck).conjugate() * face.R_PB).normalized()
                  : picture.pose.R_PB[index_of(Bone::kHead)];
  stamp(face, picture.pose, picture.pose.capture_time);
  picture.sink.capture_face(picture.guest, face);
}

void HandsAndFace::rest(MonoTime now, const Pose& last, const GuestId& guest, CaptureSink& sink) {
  if (!has_said_relaxed_) {
    Hands hands;
    stamp(hands, last, now);
    sink.capture(guest, hands);
    has_said_relaxed_ = true;
  }
  if (!has_said_rest_) {
    Face face;
    face.R_PB = last.R_PB[index_of(Bone::kHead)];
    stamp(face, last, now);
    sink.capture_face(guest, face);
    has_said_rest_ = true;
  }
}

HandsAndFace::Due HandsAndFace::due(LoadStep step, std::uint64_t turn) {
  switch (step) {
    case LoadStep::kAll:
      return {true, true, true};
    case LoadStep::kAlternating:
      return {turn % 2 == 0, turn % 2 == 1, turn % 2 == 0};
    case LoadStep::kOneInTurn:
      return {turn % 6 == 0, turn % 6 == 2, turn % 6 == 4};
    case LoadStep::kBodyOnly:
    case LoadStep::kDancersByTurns:
      break;
  }
  return {};
}

void HandsAndFace::look(const Picture& picture) {
  const Due is_due = due(extras_->load.step(), pictures_++);
  if (hands_) {
    if (is_due.left) look_at_hand(picture, HandSide::kLeft);
    if (is_due.right) look_at_hand(picture, HandSide::kRight);
    publish_hands(picture);
  }
  if (face_) {
    if (is_due.face) {
      const FaceLandmarks& face = face_->look(picture.frame, picture.body);
      expressions_.see(face, picture.frame.capture_time);
      expressions_.see_gaze(gaze_of(picture.frame.image, face));
    }
    publish_face(picture);
  }
}

}  // namespace dance
