// The options of `dance capture`.
//
// Units/frames: as each field says.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      none; what is wrong with a value is said where it is used.
#pragma once

#include <string>
#include <vector>

#include "core/base/guest_id.h"
#include "producers/camera/estimator/pose_estimator.h"
#include "producers/camera/v4l2/video_mode.h"

namespace dance {

struct CaptureOptions {
  std::string source;                         // camera, video, folder; "" = the first camera
  std::string right;                          // the right camera, where it is a device of its own
  std::vector<std::string> also;              // further cameras, anywhere around the dancer
  std::vector<std::string> also_calibration;  // of their lenses, in the same order
  std::vector<double> also_fov_deg;           // where these are not given
  std::vector<std::string> guests{"alice"};   // as many as dance before the camera
  std::string bus;
  double seconds = 0.0;  // 0 = until stopped

  // camera
  std::string size;  // "1280x720"
  double hz = 0.0;
  std::string encoding;
  bool loops = false;  // a video begins again

  // pose network
  PoseNetworkModel model = PoseNetworkModel::kFull;
  EngineKind engine = EngineKind::kFastest;
  std::string models_folder;
  std::string follow;  // "largest", or "x,y" as shares of the picture

  // solver
  std::string calibration;
  double fov_deg = 65.0;          // horizontal, where nothing is measured
  std::vector<double> heights_m;  // of the dancers; none, or 0, = not known
  double smooth = 1.0;
  bool is_mirrored = false;

  // hands and face
  enum class Hands { kWhereTheirNetworksAre, kOn, kOff };
  Hands hands = Hands::kWhereTheirNetworksAre;
  bool has_face = false;  // numbers of the expression leave the house

  // what comes out beside poses
  bool has_preview = false;
  std::string preview_file;
  std::string record_folder;
  bool wants_json = false;

  // other work
  bool only_lists = false;
  bool only_checks = false;  // how the dancer is seen: views to stdout
  bool wants_text = false;   // advice instead
  std::string calibrate_file;
  std::string board = "9x6";
  double square_mm = 25.0;
};

// The mode that --size, --hz and --format ask for.
Result<CameraWish> camera_wish(const CaptureOptions& options);
// The network that sees the dancers, and what runs it; who is followed is another matter.
inline EstimatorOptions networks_of(const CaptureOptions& options) {
  EstimatorOptions networks;
  networks.model = options.model;
  networks.engine = options.engine;
  networks.models_folder = options.models_folder;
  return networks;
}
// The person that --follow selects, in a picture of this size.
Result<FollowOptions> follow_options(const CaptureOptions& options, int width_px, int height_px);
// Who dance, and how tall each of them is (0: not told); an error where that does not fit together,
// or with the rest of the options.
struct WishedDancer {
  GuestId guest;
  double height_m = 0.0;
};
Result<std::vector<WishedDancer>> wished_dancers(const CaptureOptions& options);
// Two whole numbers with an x between them.
Result<std::pair<int, int>> parse_pair(const std::string& option, const std::string& text);

}  // namespace dance
