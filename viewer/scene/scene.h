// SceneState: everything that a picture of the stage shows, as plain values. It depends on no bus
// and no window, so that the viewer, tests and pictures for the documents draw the same way.
//
// Units/frames: poses in W, metres; rates in Hz, ages in ms; music in beats as core/base/beat.h
//               counts them.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      none.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/base/guest_id.h"
#include "core/base/time.h"
#include "core/pose/face.h"
#include "core/pose/kinematics.h"
#include "core/pose/pose.h"
#include "core/pose/skeleton.h"
#include "formats/avatar/avatar_model.h"
#include "viewer/scene/avatar_wish.h"
#include "viewer/scene/beat_meter.h"
#include "viewer/words/shown_name.h"

namespace dance {

// The HUD's figures of one guest; unknown ones are not shown.
struct GuestFigures {
  float arrival_hz = 0.0f;
  std::optional<float> age_ms;
  std::optional<float> loss_percent = {};
  std::optional<BeatFigures> beat = {};
};

// The music of this house at the moment of the picture.
struct SceneMusic {
  double beats = 0.0;
  double beats_per_second = 2.0;
  int beats_per_bar = 0;  // 0: not known
};

// How large an avatar is drawn. By default its legs are as long as the dancer's, so that steps fit,
// feet do not slide and couples stay at arm's length; its own size keeps the height of its file.
enum class FigureSize : std::uint8_t { kDancers, kOwn };
constexpr float kLeastHeightScale = 0.25f;
constexpr float kMostHeightScale = 4.0f;

// How a guest of this house speaks at present, where a dance voice runs for it.
struct SceneVoice {
  GuestId guest;
  bool is_muted = false;
  bool is_deafened = false;
  bool is_push_to_talk = false;
  bool is_heard = true;  // what is said now goes to the others
  bool has_microphone = true;
  bool has_loudspeaker = true;
  // No sound server answers, or there is no sound device.
  bool has_no_sound() const { return !has_microphone && !has_loudspeaker; }
};
// The one of them that is drawn beside the name.
enum class VoiceMark : std::uint8_t {
  kNone,          // heard all the time, or no dance voice
  kDeafened,      // neither hears nor is heard
  kMuted,         // not heard
  kNoMicrophone,  // cannot be heard
  kWaiting,       // push to talk: heard while the key is held
  kTalking,       // push to talk: the key is held; of a guest of another house: talks now
};
VoiceMark mark_of(const SceneVoice& voice);

// A sign that a guest shows above its head for a moment.
enum class DanceSign : std::uint8_t { kNone, kApplause, kHeart };
constexpr double kSignHolds_s = 2.0;

struct SceneGuest {
  GuestId id;
  Skeleton skeleton = average_skeleton();
  Pose pose;
  std::optional<Hands> hands;
  std::optional<Face> face = {};
  AvatarWish wish;
  std::shared_ptr<const AvatarModel> avatar;  // null: none is ready yet
  FigureSize figure_size = FigureSize::kDancers;
  float height_scale = 1.0f;  // times that size; kept within the two bounds above
  float opacity = 1.0f;       // 0 = faded out
  GuestFigures figures;
  float voice = 0.0f;  // loudness, 0 = silent to 1
  VoiceMark voice_mark = VoiceMark::kNone;
  bool is_recording = false;  // this guest is of another house, and that house records
  DanceSign sign = DanceSign::kNone;
  float sign_age_s = 0.0f;
  // For the picture from this guest's own eyes: the head would hide everything.
  bool hides_head = false;
  // What a view that compares shows on its left and right: the pose as it came into this house, and
  // as its routes put it on the stage. Not set: nothing was heard there.
  std::optional<Pose> arriving = {};
  std::optional<BeatFigures> arriving_beat = {};
  std::optional<Pose> staged = {};
  // Of a Comparison: that the figures of this dancer stand under both halves, and that this half
  // shows a prediction of the dance.
  bool is_compared = false;
  bool is_predicted = false;
};

// One line of the room's chat.
struct SceneLine {
  GuestId guest;
  std::string text;
  MonoTime written;
};

struct SceneState {
  MonoTime time;  // of the picture, in the house's clock
  // One picture may show several stages: halves of a comparison, cells of a grid. What is kept of a
  // guest from picture to picture (hair, feet) is kept for each stage by itself.
  int stage = 0;
  bool shows_trails = false;  // of hands, over the last moments
  std::vector<SceneGuest> guests;
  std::optional<SceneMusic> music;
  std::vector<SceneVoice> voices;  // of this house's guests, by name; of those who do not dance too
  std::vector<SceneLine> lines;    // the newest, in the order of time
  ShownNames names;                // of guests who are not drawn, too
  std::vector<GuestId> recorders;  // guests of other houses that record
  // The room's only host, if it is of another house. Not set: no such host, or several.
  GuestId host;
  // Free lines at the bottom left: the viewer's own rate, a hint when no dancer is here.
  std::vector<std::string> notes;
};

// The points of a guest that must be in the picture: all joints and ends, and room for the name
// tag.
void append_outline(const SceneGuest& guest, std::vector<Eigen::Vector3f>& points_W_m);

// Where the tag hangs: above the head.
Eigen::Vector3f tag_anchor_W_m(const SceneGuest& guest);
Eigen::Vector3f tag_anchor_W_m(const BodyFrames& figure);

// About the point between the figure's eyes.
Eigen::Vector3f face_W_m(const SceneGuest& guest);

// The direction in which the guest's hips look, on the floor.
Eigen::Vector3f facing_W(const SceneGuest& guest);

}  // namespace dance
