// ViewOptions: the options of `dance view`.
//
// Units/frames: moments in seconds from the start.
// Ownership:    plain value.
// Threads:      none inside.
// Failure:      plan_moments(), check_shown(), check_teacher() and parse_size() refuse invalid
//               values, in one line.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "viewer/avatar/avatar_library.h"
#include "viewer/feed/stage_feed.h"
#include "viewer/practice/teacher_place.h"
#include "viewer/scene/place.h"
#include "viewer/view/camera_rig.h"
#include "viewer/view/view_mode.h"
#include "viewer/window/window_state.h"
#include "viewer/words/language.h"

namespace dance {

constexpr double kFilm_hz = 25.0;

enum class QualityWish { kAuto, kLow, kHigh };

struct ViewPictureSize {
  int width_px = 1280;
  int height_px = 720;
};

struct MomentWish {
  std::vector<double> at_s;
  double every_s = 0.0;
  double seconds = 0.0;  // 0 = not given
  int strip = 0;
  bool film = false;  // kFilm_hz pictures a second up to the end
};

struct ViewOptions {
  FeedOptions feed;
  CameraPreset camera = CameraPreset::kAuto;
  ViewMode view = ViewMode::kOrbit;
  std::optional<GuestId> focus;
  QualityWish quality = QualityWish::kAuto;
  std::optional<Venue> place;  // not set: as place_to_draw() chooses
  ViewPictureSize size;
  bool hud = false;  // measurements, for engineers
  bool tags = true;

  DisplayMode display = DisplayMode::kTearFree;
  std::optional<Duration> display_latency;  // from a turn of the display to its light
  bool extrapolates = true;
  bool late_latching = true;

  bool headless = false;
  std::string session;      // the file that panels save into; "" = none
  bool hosts_room = false;  // this program runs the room's server: closing the window ends the room
  std::string panel;  // open at the start: dance, instruments, style, practice, keys; "" = none
  std::optional<GuestId> pupil;  // whose steps are counted; not set: this house's first by id
  TeacherOptions teacher;
  Language language = language_of_user();  // of the texts for dancers
  std::string out = ".";
  MomentWish moments;
  std::vector<AvatarOverride> avatars;  // --avatar
  std::string log;                      // a recorded house; "" = a live one
  std::string made_log;                 // the LCM log made of `log`, where that is of another kind
  std::string export_to;                // a file or folder; "" = none
  double export_from_s = 0.0;
  double export_until_s = 0.0;  // 0 = the end
  double export_hz = 0.0;       // 0 = as usual for its kind
  bool export_silent = false;   // a video without sound
  std::vector<double> beats;    // of its music: they stand for the moments

  const std::string& log_to_read() const { return made_log.empty() ? log : made_log; }
};

// The moments of --at, or every so often up to `seconds`, or `strip` moments spread over them, or
// one at the end. Of a recorded house, recorded_s long, all of it unless `seconds` says otherwise;
// where one picture is to do, not later than of a live one. 0 = a live house.
Result<std::vector<double>> plan_moments(const MomentWish& wish, double recorded_s = 0.0);

// A log is shown as its house showed it: --show is for a live one.
Result<void> check_shown(const ViewOptions& options);

// A teacher needs a recording, a live house and a window.
Result<void> check_teacher(const ViewOptions& options);

// The chosen place; by default the studio in windows and exports, and the plain stage in pictures
// of --headless, which are compared with each other.
Venue place_to_draw(const ViewOptions& options);

// "1280x720", each side 64 to 8192.
Result<ViewPictureSize> parse_size(const std::string& text);

}  // namespace dance
