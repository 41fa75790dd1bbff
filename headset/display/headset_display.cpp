#include "headset/display/headset_display.h"

#include <epoxy/gl.h>
#include <fmt/format.h>

#include <bit>
#include <cmath>

#include "core/net/mono_clock.h"

namespace dance {
namespace {

Eigen::Isometry3f isometry_of(const XrPlace& place) {
  Eigen::Isometry3f X = Eigen::Isometry3f::Identity();
  X.translation() = place.p_m;
  X.linear() = place.R.toRotationMatrix();
  return X;
}

std::size_t at(XrHand hand) { return static_cast<std::size_t>(hand); }

}  // namespace

Result<std::unique_ptr<HeadsetDisplay>> HeadsetDisplay::create(
    XrDancerSession& session, XrInput& input, HeadsetCapture& capture, HeadsetScene& scene,
    HeadsetWindow& window, StereoPainter& painter, const HeadsetDisplayOptions& options,
    SendVoiceCommand send_voice_command) {
  std::unique_ptr<HeadsetDisplay> display(new HeadsetDisplay(
      session, input, capture, scene, window, painter, options, std::move(send_voice_command)));
  DANCE_TRY(display->frames_, XrFrames::create(session, options.scale));
  scene.begin_session();
  return display;
}

HeadsetDisplay::HeadsetDisplay(XrDancerSession& session, XrInput& input, HeadsetCapture& capture,
                               HeadsetScene& scene, HeadsetWindow& window, StereoPainter& painter,
                               const HeadsetDisplayOptions& options,
                               SendVoiceCommand send_voice_command)
    : session_(session),
      input_(input),
      capture_(capture),
      scene_(scene),
      window_(window),
      painter_(painter),
      options_(options),
      send_voice_command_(std::move(send_voice_command)),
      sensors_(session, input) {}

void HeadsetDisplay::hear() {
  const HeadsetTold* told = capture_.told();
  if (told == nullptr) return;
  if (told->jumps != told_.jumps) fade_.jump(mono_now());
  told_ = *told;
  scene_.set_body(told_.body);
}

Result<void> HeadsetDisplay::turn() {
  const XrFrames::Turn turn = frames_->begin([] { return mono_now(); });
  if (!turn.is_begun) {
    window_.poll_events();
    return frames_->health();
  }
  hear();
  bool is_drawn = false;
  Result<void> drawn{};
  if (turn.is_to_draw && told_.is_placed && frames_->locate(turn, eyes_))
    drawn = draw(turn, is_drawn);
  frames_->end(turn, is_drawn ? &eyes_ : nullptr);
  // What others see comes after what the dancer sees: a desk's monitor may hold it up.
  window_.poll_events();
  if (is_drawn) {
    show_in_window();
    scene_.report(turn.seen_at);
  }
  return drawn ? frames_->health() : drawn;
}

StageEye HeadsetDisplay::stage_eye(const XrEye& eye) const {
  const XrPlace place = told_.placement.in_house(eye.in_base);
  const EyeTangents tangents{std::tan(eye.fov.angleLeft), std::tan(eye.fov.angleRight),
                             std::tan(eye.fov.angleUp), std::tan(eye.fov.angleDown)};
  return eye_at(place.p_m, place.R.toRotationMatrix(), tangents, frames_->height_px());
}

Result<void> HeadsetDisplay::draw(const XrFrames::Turn& turn, bool& is_drawn) {
  const MonoTime taken = mono_now();
  sensors_.look(turn.display_time, turn.seen_at, told_.placement, sight_);
  SceneState& scene =
      scene_.take(taken, turn.seen_at, sight_.points.presence != 0 ? &sight_ : nullptr);
  use_panel(turn, scene, taken);
  StereoWishes wishes;
  wishes.own = options_.own;
  wishes.comfort = options_.comfort;
  // While the space is another one than the capture has heard of, nothing is in its place.
  const bool is_elsewhere = session_.recentres() != told_.recentres;
  wishes.darkness = is_elsewhere ? 1.0f : fade_.darkness(taken);
  wishes.tags = options_.tags;
  wishes.place = options_.place;
  const std::array<StageEye, 2> eyes{stage_eye(eyes_[0]), stage_eye(eyes_[1])};
  if (auto prepared = painter_.prepare(scene, eyes, frames_->width_px(), frames_->height_px(),
                                       panel_, words_of(scene), wishes);
      !prepared)
    return prepared;
  is_drawn = true;
  // The left eye last, as the window shows what was drawn last.
  for (const std::size_t eye : {std::size_t{1}, std::size_t{0}}) {
    const unsigned image = frames_->acquire(eye);
    if (image == 0) {
      is_drawn = false;
      continue;
    }
    painter_.paint(eye);
    painter_.copy_to(image);
    frames_->release(eye);
  }
  glFlush();
  drawing_.add(mono_now() - taken);
  return {};
}

void HeadsetDisplay::show_in_window() {
  const MonoTime now = mono_now();
  if (!window_.is_shown() || now - shown_ < shown_every_) return;
  shown_ = now;
  const auto size = window_.window().framebuffer_size();
  painter_.show_in_window(size.width_px, size.height_px);
  window_.swap();
}

PanelWords HeadsetDisplay::words_of(const SceneState& scene) const {
  PanelWords words;
  words.title = options_.own.view();
  words.tracked = std::popcount(told_.tracked);
  using Advice = PanelWords::Advice;
  if (told_.awaits_t_pose)
    words.advice = Advice::kStandInTPose;
  else if (told_.body.state != CalibrationState::kFromTPose && !told_.sees_body)
    words.advice = Advice::kTPoseIsBetter;
  words.progress = told_.t_pose_progress;
  for (const SceneVoice& voice : scene.voices)
    if (voice.guest == options_.own) words.has_voice = true, words.is_muted = voice.is_muted;
  return words;
}

WristPanel::Input HeadsetDisplay::panel_input(const XrFrames::Turn& turn) const {
  WristPanel::Input input;
  const XrPlacement& placement = told_.placement;
  input.eyes_W_m =
      placement.in_house(Eigen::Vector3f(0.5f * (eyes_[0].in_base.p_m + eyes_[1].in_base.p_m)));
  input.looks_W = placement.in_house(eyes_[0].in_base).R * -Eigen::Vector3f::UnitZ();
  if (sight_.points.has(TrackedPoint::kLeftHand))
    input.left_grip_W = isometry_of({sight_.points.position(TrackedPoint::kLeftHand),
                                     sight_.points.rotation(TrackedPoint::kLeftHand)});
  const std::size_t right = at(XrHand::kRight);
  if (sight_.is_bare[right]) {
    input.fingertip_W_m = sight_.fingertips_W_m[right];
    input.right_aim_W = isometry_of(sight_.bare_aims_W[right]);
    input.is_pressed = sight_.is_pinching[right];
  } else {
    if (const auto aim = input_.aim(XrHand::kRight, turn.display_time))
      input.right_aim_W = isometry_of(placement.in_house(*aim));
    input.is_pressed = told_.is_pressed[right];
  }
  input.menu_pressed = told_.is_menu_pressed[at(XrHand::kLeft)] || told_.is_menu_pressed[right];
  return input;
}

void HeadsetDisplay::use_panel(const XrFrames::Turn& turn, const SceneState& scene, MonoTime now) {
  const WristPanel::Input input = panel_input(turn);
  const auto action = panel_.update(input, now);
  if (!action) return;
  // A press is felt.
  input_.vibrate(XrHand::kRight, 0.4f, Duration::ms(25), 0.0f);
  const PanelWords words = words_of(scene);
  switch (*action) {
    case PanelAction::kMute:
      if (words.has_voice) send_voice_command_(!words.is_muted);
      break;
    case PanelAction::kRecentre:
      capture_.request_recentre();
      break;
    case PanelAction::kCalibrate:
      capture_.request_t_pose();
      break;
    case PanelAction::kLeave:
      has_left_ = true;
      break;
  }
}

std::string HeadsetDisplay::summary() const {
  return fmt::format(
      "{} pictures of {}x{} px an eye; {:.1f} ms at the median from poses to the picture, {:.1f} "
      "ms at p99; {} times that could not be true",
      frames_->pictures(), frames_->width_px(), frames_->height_px(),
      drawing_.percentile(0.5).as_ms(), drawing_.percentile(0.99).as_ms(), frames_->bad_times());
}

}  // namespace dance
