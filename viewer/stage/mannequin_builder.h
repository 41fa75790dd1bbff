// MannequinBuilder: what the builders of torso, head, limbs and hands share: the guest's frames,
// colours and scale, and places given in a bone's own axes.
//
// Units/frames: local places are metres of a body 1.72 m tall, in the axes of the bone (in T-pose
//               those of W); what comes out is in W.
// Ownership:    borrows everything; lives for one body.
// Threads:      none inside.
// Failure:      none.
#pragma once

#include "core/pose/kinematics.h"
#include "viewer/stage/mannequin.h"

namespace dance {

enum class Side : std::uint8_t { kLeft, kRight };
constexpr float sign_of(Side side) { return side == Side::kLeft ? 1.0f : -1.0f; }

class MannequinBuilder {
 public:
  MannequinBuilder(const SceneGuest& guest, const BodyFrames& frames, const GuestLook& look,
                   BodyDetail detail, BodyParts& parts);

  void add_torso();
  void add_head();
  void add_arm(Side side);
  void add_hand(Side side);
  void add_leg(Side side);
  void add_skirt();
  void add_contact_spots();

 private:
  struct Colour {
    Eigen::Vector3f rgb;
    float gloss;
  };

  Eigen::Vector3f at(Bone bone, const Eigen::Vector3f& local_m) const {
    return frames_.position(bone) + scale_ * (frames_.R_WB[index_of(bone)] * local_m);
  }
  Eigen::Vector3f axis(Bone bone, const Eigen::Vector3f& local) const {
    return frames_.R_WB[index_of(bone)] * local;
  }
  // Radii in metres of the reference body.
  BodyPart cone(const Eigen::Vector3f& a_W_m, float radius_a_m, const Eigen::Vector3f& b_W_m,
                float radius_b_m, const Eigen::Vector3f& side_W, const Colour& colour) const;
  void large(const BodyPart& part) { parts_.large.push_back(part); }
  void small(const BodyPart& part) { parts_.small.push_back(part); }

  void add_face();
  void add_hair();
  void add_lower_leg(Side side);
  void add_shoe(Side side);
  void add_palm(Side side);
  void add_mitten(Side side);
  void add_fingers(Side side);
  void add_finger(Side side, std::size_t first_bone, const Eigen::Vector3f& root_local_m,
                  const Eigen::Vector3f& direction_local, float length_m, float radius_m);

  const SceneGuest& guest_;
  const BodyFrames& frames_;
  const GuestLook& look_;
  BodyDetail detail_;
  float scale_;
  BodyParts& parts_;

  Colour skin_;
  Colour top_;
  Colour legs_;
  Colour shoes_;
  Colour hair_;
};

}  // namespace dance
