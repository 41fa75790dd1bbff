#include "research/capture/hands_eval.h"

#include <cmath>
#include <numbers>

#include "core/codec/face_codec.h"
#include "producers/camera/hands/palm_wrist.h"

namespace dance {
namespace {

constexpr double kHandDegrees = 180.0 / std::numbers::pi;

// Palms of hands that are half hidden are no measure.
constexpr float kClear = 0.9f;

double degrees_between(const Eigen::Quaternionf& a, const Eigen::Quaternionf& b) {
  return kHandDegrees * static_cast<double>(a.angularDistance(b));
}
double tremble_deg(const Eigen::Quaternionf& before, const Eigen::Quaternionf& is,
                   const Eigen::Quaternionf& after) {
  return degrees_between(is, before.slerp(0.5f, after));
}

}  // namespace

HandsEval::HandsEval(Extras& extras, int width_px, int height_px)
    : solver_({}, assumed_pinhole(width_px, height_px)), seen_(extras, {}) {}

void HandsEval::see(const Frame& frame, const BodyLandmarks& body,
                    const BodyLandmarks& unfiltered) {
  Pose pose;
  if (!solver_.solve(unfiltered, std::nullopt, pose)) return;
  ++sums_.pictures;
  const Pose solved = pose;
  seen_.steady_wrists(pose);
  pose_ = pose;
  const Eigen::Matrix3f R_WC = solver_.camera_stand().R_WC.cast<float>();
  seen_.look({frame, body, pose, R_WC, guest_, *this});
  for (const HandSide side : {HandSide::kLeft, HandSide::kRight}) {
    if (!seen_.hands()) break;
    const HandLandmarks& hand = seen_.hands()->hand(side);
    const Bone bone = side == HandSide::kLeft ? Bone::kLeftHand : Bone::kRightHand;
    const auto s = static_cast<std::size_t>(side);
    const auto palm = hand.found && hand.trust() >= kClear ? palm_of(hand, side) : std::nullopt;
    Moment moment;
    moment.is_seen = palm.has_value();
    moment.solver = rotation_in_W(solved, bone);
    moment.palm = rotation_in_W(pose, bone);
    for (std::size_t i = 0; i < moment.fingers.size(); ++i)
      moment.fingers[i] = hands_.R_PB[moment.fingers.size() * s + i];
    if (palm) {
      const Eigen::Quaternionf R_WPalm = Eigen::Quaternionf(R_WC) * *palm;
      ++sums_.hands;
      sums_.solver_off_deg += degrees_between(moment.solver, R_WPalm);
      sums_.palm_off_deg += degrees_between(moment.palm, R_WPalm);
    }
    add(s, moment);
  }
}

void HandsEval::capture_face(const GuestId&, const Face& face) {
  if (face.presence == 0 || !seen_.knows_rest()) return;
  constexpr float kClearlyShown = 0.1f;
  std::array<std::uint8_t, kMaxFacePayload> payload;
  ++sums_.faces;
  sums_.face_bytes += static_cast<double>(encode_face(face, payload));
  for (std::size_t i = 0; i < kExpressionCount; ++i) {
    sums_.shown += face.weight[i] > kClearlyShown ? 1.0 : 0.0;
    sums_.face_change += static_cast<double>(std::abs(face.weight[i] - last_face_.weight[i])) /
                         static_cast<double>(kExpressionCount);
  }
  sums_.head_off_deg += degrees_between(face.R_PB, pose_.R_PB[index_of(Bone::kHead)]);
  last_face_ = face;
}

void HandsEval::add(std::size_t side, const Moment& after) {
  std::array<Moment, 2>& last = last_[side];
  const Moment &is = last[0], &before = last[1];
  if (after.is_seen && is.is_seen && before.is_seen) {
    ++sums_.trembles;
    sums_.solver_tremble_deg += tremble_deg(before.solver, is.solver, after.solver);
    sums_.palm_tremble_deg += tremble_deg(before.palm, is.palm, after.palm);
    for (std::size_t i = 0; i < is.fingers.size(); ++i)
      sums_.finger_tremble_deg += tremble_deg(before.fingers[i], is.fingers[i], after.fingers[i]) /
                                  static_cast<double>(is.fingers.size());
  }
  last[1] = last[0];
  last[0] = after;
}

HandFigures HandsEval::figures() const {
  HandFigures means = sums_;
  const auto mean = [](double& sum, std::size_t count) {
    sum = count == 0 ? 0.0 : sum / static_cast<double>(count);
  };
  for (double* sum :
       {&means.solver_tremble_deg, &means.palm_tremble_deg, &means.finger_tremble_deg})
    mean(*sum, means.trembles);
  for (double* sum : {&means.solver_off_deg, &means.palm_off_deg}) mean(*sum, means.hands);
  for (double* sum : {&means.face_bytes, &means.shown, &means.face_change, &means.head_off_deg})
    mean(*sum, means.faces);
  return means;
}

}  // namespace dance
