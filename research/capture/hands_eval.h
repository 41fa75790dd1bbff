// What hands and face make of a dancer in a video: how much the hand bones tremble, and how far
// they are from the palms that are seen, with and without palms; what a face costs on its way.
//
// Units/frames: degrees; a tremble is the angle between a rotation and the middle of those of the
//               pictures before and after it.
// Ownership:    owns a solver and what is seen of the hands.
// Threads:      none inside.
// Failure:      pictures without a pose count for nothing.
#pragma once

#include "producers/camera/extras/hands_and_face.h"
#include "producers/camera/solver/body_solver.h"

namespace dance {

struct HandFigures {
  std::size_t pictures = 0;  // with a pose
  std::size_t hands = 0;     // that were clearly seen in them
  std::size_t trembles = 0;  // hands in three pictures in a row
  double solver_tremble_deg = 0.0, palm_tremble_deg = 0.0, finger_tremble_deg = 0.0;
  double solver_off_deg = 0.0, palm_off_deg = 0.0;  // from the palm that is seen
  std::size_t faces = 0;                            // once the face at rest is known
  double face_bytes = 0.0;                          // of a face in the tunnel
  double shown = 0.0;                               // expressions of a face that are above a tenth
  double face_change = 0.0;                         // of a weight from picture to picture
  double head_off_deg = 0.0;                        // of the face's head from the body's
};

class HandsEval : private CaptureSink {
 public:
  HandsEval(Extras& extras, int width_px, int height_px);
  void see(const Frame& frame, const BodyLandmarks& body, const BodyLandmarks& unfiltered);
  const HandsAndFace& seen() const { return seen_; }
  // Means.
  HandFigures figures() const;

 private:
  struct Moment {
    bool is_seen = false;
    Eigen::Quaternionf solver, palm;
    std::array<Eigen::Quaternionf, kFingerBoneCount / 2> fingers;
  };
  void capture(const GuestId&, Pose&, MonoTime) override {}
  void capture(const GuestId&, const Hands& hands) override { hands_ = hands; }
  void capture(const GuestId&, const TimedSkeleton&) override {}
  void capture_face(const GuestId&, const Face& face) override;
  void add(std::size_t side, const Moment& moment);

  BodySolver solver_;
  HandsAndFace seen_;
  GuestId guest_;
  Hands hands_;
  Face last_face_;
  Pose pose_;
  std::array<std::array<Moment, 2>, 2> last_;  // of each side, the newest first
  HandFigures sums_;
};

}  // namespace dance
