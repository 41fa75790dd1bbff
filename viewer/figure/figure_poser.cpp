#include "viewer/figure/figure_poser.h"

#include <algorithm>

#include "viewer/figure/driver_pose.h"
#include "viewer/figure/face/living_face.h"
#include "viewer/figure/foot_fit.h"
#include "viewer/figure/spring_chain.h"

namespace dance {

using Eigen::Matrix3f;
using Eigen::Vector3f;

namespace {

constexpr Duration kLongestPicture = Duration::ms(250);  // beyond it a picture stands alone

void append_tips(const AvatarRig& rig, BodyFrames& frames) {
  for (std::size_t t = 0; t < kTipCount; ++t) {
    const std::size_t b = index_of(kTipBones[t]);
    frames.p_WT_m[t] = frames.p_WB_m[b] + frames.R_WB[b] * rig.body.tip_m[t];
  }
}

// A longer arm is longer along its bones only.
Matrix3f stretched(const AvatarShape& shape, Bone bone, Bone next, float stretch) {
  const Vector3f along = (shape.at(next) - shape.at(bone)).normalized();
  return Matrix3f::Identity() + (stretch - 1.0f) * along * along.transpose();
}

}  // namespace

// What one guest's avatar keeps from picture to picture.
struct FigurePoser::Rig {
  Rig(const SceneGuest& guest, std::shared_ptr<const AvatarShape> shape)
      : id(guest.id),
        model(guest.avatar),
        skeleton(guest.skeleton),
        size(guest.figure_size),
        height_scale(guest.height_scale),
        rig(std::move(shape), guest.skeleton, guest.figure_size, guest.height_scale),
        drivers(rig.shape->drivers_M_m.size()),
        linears(drivers.size()) {
    springs.start(rig);
  }

  bool fits(const SceneGuest& guest) const {
    return model == guest.avatar && size == guest.figure_size &&
           height_scale == guest.height_scale && skeleton == guest.skeleton;
  }

  // Moves on to the picture of `now`. The kept state counts only if it is recent. Another picture
  // of the same moment starts from the same state: otherwise rounding errors would add up.
  void go_on(MonoTime now) {
    if (time.is_set() && now == time) {
      twists = twists_before;
      contacts = contacts_before;
      face = face_before;
      return;
    }
    const Duration passed = now - time;
    goes_on = time.is_set() && passed >= Duration() && passed <= kLongestPicture;
    if (!goes_on) twists.is_known = false;
    contacts.is_known = face.is_known = goes_on;
    contacts.passed_s = face.passed_s = static_cast<float>(passed.as_seconds());
    time = now;
    twists_before = twists;
    contacts_before = contacts;
    face_before = face;
  }

  GuestId id;
  std::shared_ptr<const AvatarModel> model;
  Skeleton skeleton;
  FigureSize size;
  float height_scale;
  AvatarRig rig;
  std::vector<DriverPose> drivers;
  std::vector<Matrix3f> linears;
  ForearmTwists twists, twists_before;  // before the picture of `time`
  ContactPast contacts, contacts_before;
  FacePast face, face_before;
  SpringChains springs;
  MonoTime time;
  bool goes_on = false;
};

// A model is measured once for all who wear it.
struct FigurePoser::Shape {
  std::weak_ptr<const AvatarModel> model;
  std::shared_ptr<const AvatarShape> shape;
};

FigurePoser::FigurePoser(FigureOptions options) : options_(options) {}
FigurePoser::~FigurePoser() = default;

std::shared_ptr<const AvatarShape> FigurePoser::shape_of_model(
    const std::shared_ptr<const AvatarModel>& model) {
  std::erase_if(shapes_, [](const Shape& it) { return it.model.expired(); });
  for (const Shape& it : shapes_)
    if (it.model.lock() == model) return it.shape;
  shapes_.push_back({model, std::make_shared<const AvatarShape>(shape_of(*model))});
  return shapes_.back().shape;
}

// The rig of the guest that is at `place` among those shown. Guests keep their order, but for those
// who come and go; the same guest may be shown twice, before and after its transformers.
FigurePoser::Rig& FigurePoser::rig_of(const SceneGuest& guest, std::size_t place) {
  for (std::size_t i = place; i < rigs_.size(); ++i)
    if (rigs_[i]->id == guest.id) {
      std::rotate(rigs_.begin() + static_cast<std::ptrdiff_t>(place),
                  rigs_.begin() + static_cast<std::ptrdiff_t>(i),
                  rigs_.begin() + static_cast<std::ptrdiff_t>(i + 1));
      if (!rigs_[place]->fits(guest)) *rigs_[place] = Rig(guest, shape_of_model(guest.avatar));
      return *rigs_[place];
    }
  rigs_.insert(rigs_.begin() + static_cast<std::ptrdiff_t>(place),
               std::make_unique<Rig>(guest, shape_of_model(guest.avatar)));
  return *rigs_[place];
}

std::span<const PosedFigure> FigurePoser::pose(const SceneState& scene) {
  fits_.clear();
  std::size_t count = 0;
  const auto is_shown = [](const SceneGuest& guest) {
    return guest.avatar != nullptr && guest.opacity > 0.0f;
  };
  for (const SceneGuest& guest : scene.guests) count += is_shown(guest);
  fits_.reserve(count);
  contacts_.reserve(count);
  views_.clear();
  views_.reserve(count);
  if (figures_.size() < count) figures_.resize(count);
  for (const SceneGuest& guest : scene.guests) {
    if (!is_shown(guest)) continue;
    Rig& rig = rig_of(guest, fits_.size());
    rig.go_on(scene.time);
    FigureFit& fit = fits_.emplace_back();
    fit.rig = &rig.rig;
    fit.past = &rig.contacts;
    place_on_bones(guest.skeleton, guest.pose, fit);
    if (options_.shares_twist) limit_hand_twist(fit, rig.twists);
    if (options_.fits_feet) fit_feet(fit);
  }
  rigs_.resize(count);  // who is absent is forgotten
  for (FigureFit& fit : fits_) append_tips(*fit.rig, fit.frames);
  if (options_.fits_hands) contacts_.fit(fits_);
  spring_work_left_ = options_.most_spring_work;
  for (const SceneGuest& guest : scene.guests)
    if (is_shown(guest)) views_.push_back(view_of(guest, fits_[views_.size()]));
  std::size_t place = 0;
  for (const SceneGuest& guest : scene.guests)
    if (is_shown(guest)) show(guest, scene, place++);
  return {figures_.data(), count};
}

void FigurePoser::show(const SceneGuest& guest, const SceneState& scene, std::size_t place) {
  Rig& rig = *rigs_[place];
  FigureFit& fit = fits_[place];
  PosedFigure& figure = figures_[place];
  const AvatarShape& shape = *rig.rig.shape;
  drive_bones(fit, rig.twists, options_.shares_twist, rig.drivers);
  drive_fingers(rig.rig, guest.hands ? &*guest.hands : nullptr, fit.frames, rig.drivers);
  drive_twists(rig.rig, rig.drivers);
  drive_eyes(rig.rig, show_face(guest, scene, place), rig.drivers);
  if (rig.springs.work() <= spring_work_left_) {
    spring_work_left_ -= rig.springs.work();
    rig.springs.swing(rig.rig, scene.time, rig.drivers);
  } else {
    rig.springs.stay(rig.rig, scene.time, rig.drivers);
  }
  append_tips(rig.rig, fit.frames);

  for (std::size_t d = 0; d < rig.drivers.size(); ++d)
    rig.linears[d] = rig.rig.scale * rig.drivers[d].D.toRotationMatrix();
  for (std::size_t side = 0; side < 2; ++side) {
    if (fit.arm_stretch[side] == 1.0f) continue;
    const Limb& arm = kArmLimbs[side];
    rig.linears[index_of(arm.upper)] *=
        stretched(shape, arm.upper, arm.lower, fit.arm_stretch[side]);
    rig.linears[index_of(arm.lower)] *= stretched(shape, arm.lower, arm.end, fit.arm_stretch[side]);
  }
  figure.id = guest.id;
  figure.model = guest.avatar;
  figure.opacity = guest.opacity;
  figure.frames = fit.frames;
  figure.arm_stretch = fit.arm_stretch;
  figure.W_from_joint.resize(shape.followers.size());
  for (std::size_t j = 0; j < shape.followers.size(); ++j) {
    const AvatarShape::Follower& follower = shape.followers[j];
    const Matrix3f& linear = rig.linears[follower.driver];
    figure.W_from_joint[j].leftCols<3>().noalias() = linear * follower.linear;
    figure.W_from_joint[j].col(3) =
        rig.drivers[follower.driver].place_W_m + linear * follower.place_m;
  }
}

std::array<float, 2> FigurePoser::show_face(const SceneGuest& guest, const SceneState& scene,
                                            std::size_t place) {
  Rig& rig = *rigs_[place];
  std::vector<float>& weights = figures_[place].morph_weights;
  weights.assign(rig.model->morphs.size(), 0.0f);
  const AvatarShape& shape = *rig.rig.shape;
  if (!shape.has_face()) return {};
  const Face face = face_of(guest, views_, place, scene.time, rig.face);
  shape.face.add(face, weights);
  return face.gaze_rad;
}

}  // namespace dance
