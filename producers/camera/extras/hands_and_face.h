// HandsAndFace: what a camera sees of one dancer beside the pose: fingers, wrists that follow the
// palm, and, where the dancer wants that, the face. It works after the pose is published, so that
// the pose is not later for it; what it sees turns the wrists of the next pose.
//
// Units/frames: Hands and Pose as in core/pose/pose.h; R_WC turns the camera's axes into W.
// Ownership:    owns the dancer's state; refers to networks that all dancers share and that must
//               outlive it. Allocates nothing after it is made.
// Threads:      none inside; one owner.
// Failure:      without networks it does nothing.
#pragma once

#include "core/base/guest_id.h"
#include "producers/camera/extras/load_steps.h"
#include "producers/camera/face/face_solver.h"
#include "producers/camera/face/face_tracker.h"
#include "producers/camera/hands/finger_solver.h"
#include "producers/camera/hands/hand_tracker.h"
#include "producers/camera/hands/palm_wrist.h"
#include "producers/capture_sink.h"

namespace dance {

// Of one process: networks, which one thread runs one after the other, and how much they may do.
struct Extras {
  std::optional<HandNetworks> hands;
  std::optional<FaceNetworks> face;
  LoadSteps load;
};

struct ExtraOptions {
  double smooth = 1.0;  // as SolverOptions has it
  bool is_mirrored = false;
};

class HandsAndFace {
 public:
  // What was seen in a picture, and where it is published.
  struct Picture {
    const Frame& frame;
    const BodyLandmarks& body;
    const Pose& pose;  // as published
    const Eigen::Matrix3f& R_WC;
    const GuestId& guest;
    CaptureSink& sink;
  };

  HandsAndFace(Extras& extras, const ExtraOptions& options);

  // Turns the hands of a pose that the solver has just made.
  void steady_wrists(Pose& pose);
  // Looks at what is due in this picture, and publishes it.
  void look(const Picture& picture);
  // The dancer is not there any more: once, after something was published, that hands and face are
  // at rest. `last` is the last pose.
  void rest(MonoTime now, const Pose& last, const GuestId& guest, CaptureSink& sink);
  // Another dancer, or another camera.
  void reset();

  // Whether the face at rest is known, against which expressions are told.
  bool knows_rest() const { return expressions_.knows_rest(); }
  const HandTracker* hands() const { return hands_ ? &*hands_ : nullptr; }

 private:
  struct Due {
    bool left = false, right = false, face = false;
  };
  static Due due(LoadStep step, std::uint64_t turn);
  void look_at_hand(const Picture& picture, HandSide side);
  void publish_hands(const Picture& picture);
  void publish_face(const Picture& picture);

  const Extras* extras_;
  ExtraOptions options_;
  std::optional<HandTracker> hands_;
  FingerSolver fingers_;
  PalmWrist wrists_;
  BoneRotations solved_ = identity_rotations();  // in W, the hands of the solver's last pose
  std::uint64_t pictures_ = 0;
  bool has_said_relaxed_ = true;
  std::optional<FaceTracker> face_;
  FaceSolver expressions_;
  bool has_said_rest_ = true;
};

}  // namespace dance
