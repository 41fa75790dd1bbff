// HeadsetDisplay: one session with the headset's pictures: each is drawn for the moment at which it
// will be seen, from where the eyes will be then. It hears the wrist panel, and does what it says.
//
// Units/frames: times of this house's clock.
// Ownership:    owns frames, sensors and panel; borrows session, input, capture, scene and window,
//               which must outlive it.
// Threads:      the main thread.
// Failure:      create() and turn() name what runtime or driver refuse. A picture that cannot be
//               drawn for want of eyes is left out.
#pragma once

#include <functional>

#include "core/base/histogram.h"
#include "headset/capture/headset_capture.h"
#include "headset/display/headset_scene.h"
#include "headset/display/headset_window.h"
#include "headset/stereo/stereo_painter.h"
#include "headset/stereo/xr_frames.h"

namespace dance {

struct HeadsetDisplayOptions {
  GuestId own;
  ComfortSettings comfort;
  float scale = 1.0f;
  bool tags = true;
  Venue place = Venue::kPlain;
};

class HeadsetDisplay {
 public:
  using SendVoiceCommand = std::function<void(bool mutes)>;

  static Result<std::unique_ptr<HeadsetDisplay>> create(XrDancerSession& session, XrInput& input,
                                                        HeadsetCapture& capture,
                                                        HeadsetScene& scene, HeadsetWindow& window,
                                                        StereoPainter& painter,
                                                        const HeadsetDisplayOptions& options,
                                                        SendVoiceCommand send_voice_command);

  // One picture; waits for its turn.
  Result<void> turn();
  // The dancer pressed Leave.
  bool has_left() const { return has_left_; }
  const HeadsetTold& told() const { return told_; }
  std::string summary() const;

 private:
  HeadsetDisplay(XrDancerSession& session, XrInput& input, HeadsetCapture& capture,
                 HeadsetScene& scene, HeadsetWindow& window, StereoPainter& painter,
                 const HeadsetDisplayOptions& options, SendVoiceCommand send_voice_command);
  Result<void> draw(const XrFrames::Turn& turn, bool& is_drawn);
  void hear();
  void use_panel(const XrFrames::Turn& turn, const SceneState& scene, MonoTime now);
  WristPanel::Input panel_input(const XrFrames::Turn& turn) const;
  PanelWords words_of(const SceneState& scene) const;
  StageEye stage_eye(const XrEye& eye) const;
  void show_in_window();

  XrDancerSession& session_;
  XrInput& input_;
  HeadsetCapture& capture_;
  HeadsetScene& scene_;
  HeadsetWindow& window_;
  StereoPainter& painter_;
  HeadsetDisplayOptions options_;
  SendVoiceCommand send_voice_command_;
  std::unique_ptr<XrFrames> frames_;
  XrSensors sensors_;
  XrSight sight_;
  HeadsetTold told_;
  WristPanel panel_;
  JumpFade fade_;
  std::array<XrEye, kXrEyes> eyes_{};
  Duration shown_every_ = Duration::ms(33);  // in the window on the desk
  MonoTime shown_;
  bool has_left_ = false;
  Histogram drawing_;  // from the poses taken to the picture handed over
};

}  // namespace dance
