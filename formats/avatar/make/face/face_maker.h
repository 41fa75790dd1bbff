// The features of an avatar's face, with what expressions do to them: eyes with lids and lashes,
// brows, a mouth with lips and teeth.
//
// Units/frames: as FaceSurface.
// Ownership:    refers to the surface.
// Threads:      none inside.
// Failure:      none.
#pragma once

#include <array>

#include "formats/avatar/make/face/face_surface.h"
#include "formats/avatar/make/sheet.h"

namespace dance {

class FaceMaker {
 public:
  FaceMaker(const FaceSurface& surface, const AvatarDesign& design);

  // Middle of an eyeball; 0 = left.
  const Eigen::Vector3f& eye_m(std::size_t eye) const { return eyes_m_[eye]; }

  Sheet eyeballs(const std::array<int, 2>& joints) const;
  // The ring of both eyeballs between two angles from the direction of sight.
  Sheet eye_rings(const std::array<int, 2>& joints, float outer_deg, float inner_deg,
                  int rings) const;
  // The highlight of an eye; it stays in place while the eye turns.
  Sheet eye_lights() const;
  Sheet lids() const;
  Sheet lashes() const;
  Sheet brows() const;
  Sheet lips() const;
  Sheet teeth() const;
  Sheet mouth_inside() const;
  // What the jaw does to the skin of the head.
  void add_jaw(Sheet& head) const;

 private:
  // Degrees above the middle of the eye at which lids end in its middle, and how much higher the
  // outer corner of the upper one is than the inner.
  struct LidShape {
    float upper_deg;
    float lower_deg;
    float slant_deg = 0.0f;
  };
  struct BrowShape {
    float inner_m = 0.0f;  // how much higher than at rest
    float outer_m = 0.0f;
  };
  struct MouthShape {
    float half_width_m;
    float up_m = 0.0f;      // how far the upper lip is lifted
    float down_m = 0.0f;    // how far the lower lip is lowered
    float corner_m = 0.0f;  // how far the corners are lifted
  };
  LidShape lids_at_rest() const;
  MouthShape mouth_at_rest() const;
  LidShape lids_of(const std::string& morph, std::size_t eye) const;
  MouthShape mouth_of(const std::string& morph) const;

  Eigen::Vector3f on_eye(std::size_t eye, float yaw_deg, float pitch_deg, float radii) const;
  float rim_deg(const LidShape& shape, bool upper, float yaw_deg, std::size_t eye) const;
  std::vector<Eigen::Vector3f> lid_places(std::size_t eye, const LidShape& shape, bool upper) const;
  std::vector<Eigen::Vector3f> lash_places(std::size_t eye, const LidShape& shape) const;
  std::vector<Eigen::Vector3f> brow_places(std::size_t side, const BrowShape& shape) const;
  enum class Lip : std::uint8_t { kUpper, kLower };
  std::vector<Eigen::Vector3f> lip_places(const MouthShape& shape, Lip lip) const;
  std::vector<Eigen::Vector3f> inside_places(const MouthShape& shape, float lift_m,
                                             float share) const;
  // y of the edge between a lip and the inside at t = −1 … 1 from corner to corner.
  float lip_edge_m(const MouthShape& shape, Lip lip, float t) const;

  const FaceSurface& surface_;
  const bool is_strong_;
  std::array<Eigen::Vector3f, 2> eyes_m_;
};

}  // namespace dance
