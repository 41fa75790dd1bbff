#include "producers/camera/program/other_cameras.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "producers/camera/files/open_frame_source.h"
#include "producers/camera/stereo/calibration_file.h"

namespace dance {
namespace {

constexpr Duration kPictureTimeout = Duration::ms(50);
// Nearer than this a place is neither left nor right, before nor behind.
constexpr double kBeside_m = 0.15;

SentBody sent(const BodyLandmarks& body) {
  SentBody out;
  out.time_ns = body.capture_time.since_zero_ns();
  out.side_px = body.region.side_px;
  out.is_new = body.is_new;
  for (std::size_t i = 0; i < kLandmarkCount; ++i) {
    for (std::size_t k = 0; k < 2; ++k)
      out.image_px[2 * i + k] = body.image_px[i][static_cast<Eigen::Index>(k)];
    for (std::size_t k = 0; k < 3; ++k)
      out.world_m[3 * i + k] = body.world_m[i][static_cast<Eigen::Index>(k)];
    out.visibility[i] = body.visibility[i];
  }
  return out;
}

BodyLandmarks received(const SentBody& body) {
  BodyLandmarks out;
  out.found = true;
  out.presence = 1.0f;
  out.is_new = body.is_new;
  out.capture_time = MonoTime::from_ns(body.time_ns);
  out.region.side_px = body.side_px;
  for (std::size_t i = 0; i < kLandmarkCount; ++i) {
    out.image_px[i] = {body.image_px[2 * i], body.image_px[2 * i + 1], 0.0f};
    out.world_m[i] = {body.world_m[3 * i], body.world_m[3 * i + 1], body.world_m[3 * i + 2]};
    out.visibility[i] = body.visibility[i];
  }
  return out;
}

}  // namespace

Result<std::unique_ptr<OtherCameras>> OtherCameras::open(const CaptureOptions& options,
                                                         const Pinhole& first) {
  if (options.also.size() > kMostOtherViews)
    return fail(fmt::format("--also: {} cameras beside the first are the most", kMostOtherViews));
  if (options.also_calibration.size() > options.also.size() ||
      options.also_fov_deg.size() > options.also.size())
    return fail("--also-calibration and --also-fov: one for each --also, in their order");
  std::unique_ptr<OtherCameras> others(new OtherCameras(first));
  if (!options.heights_m.empty() && options.heights_m.front() > 0.0)
    others->told_height_m_ = options.heights_m.front();
  SourceOptions wished;
  DANCE_TRY(wished.camera, camera_wish(options));
  wished.play = {true, options.loops, options.hz};
  const EstimatorOptions seeing = networks_of(options);
  for (std::size_t i = 0; i < options.also.size(); ++i) {
    auto camera = std::make_unique<Camera>();
    DANCE_TRY(camera->source, open_frame_source(options.also[i], wished));
    const FrameFormat& format = camera->source->format();
    camera->name = camera->source->name();
    Pinhole lens = assumed_pinhole(
        format.width_px, format.height_px,
        i < options.also_fov_deg.size() ? options.also_fov_deg[i] : options.fov_deg);
    if (i < options.also_calibration.size()) {
      DANCE_TRY(const Calibration calibration,
                load_calibration(options.also_calibration[i], format.width_px, format.height_px));
      lens = calibration.camera;
    }
    DANCE_TRY(camera->estimator, PoseEstimator::open(seeing));
    others->views_.add_camera(lens);
    others->cameras_.push_back(std::move(camera));
  }
  return others;
}

OtherCameras::~OtherCameras() {
  for (const auto& camera : cameras_) camera->stop = true;
  for (const auto& camera : cameras_)
    if (camera->thread.joinable()) camera->thread.join();
}

void OtherCameras::start() {
  for (const auto& camera : cameras_) camera->thread = std::thread([c = camera.get()] { run(*c); });
}

void OtherCameras::run(Camera& camera) {
  Frame frame;
  while (!camera.stop) {
    const FrameState state = camera.source->next(kPictureTimeout, frame);
    if (state == FrameState::kOver) {
      camera.is_over = true;
      return;
    }
    if (state == FrameState::kGone) camera.is_gone = true;
    if (state == FrameState::kBack) {
      camera.is_gone = false;
      camera.estimator->reset();
    }
    if (state != FrameState::kFrame) continue;
    const FrameFormat& format = camera.source->format();
    camera.has_other_size =
        frame.image.cols != format.width_px || frame.image.rows != format.height_px;
    if (camera.has_other_size) continue;
    camera.pictures.fetch_add(1, std::memory_order_relaxed);
    camera.estimator->estimate(frame);
    const BodyLandmarks& body = camera.estimator->unfiltered();
    if (!body.found) continue;
    camera.seen.fetch_add(1, std::memory_order_relaxed);
    camera.bodies.push(sent(body));
  }
}

OtherViews OtherCameras::see_first(const BodyLandmarks& body, BodySolver& solver) {
  for (std::size_t i = 0; i < cameras_.size(); ++i)
    while (const auto seen = cameras_[i]->bodies.pop()) views_.see_other(i, received(*seen));
  const OtherViews views = views_.see_first(body, {told_height_m_, solver.height_m()});
  if (const auto lengths = views_.take_lengths()) solver.take_lengths(*lengths);
  return views;
}

std::string OtherCameras::news() {
  for (std::size_t i = 0; i < cameras_.size(); ++i) {
    Camera& camera = *cameras_[i];
    const CameraPair& pair = views_.pair(i);
    const auto once = [](bool& told, bool is_so) {
      return is_so ? !std::exchange(told, true) : false;
    };
    if (!camera.is_gone) camera.has_told_gone = false;
    if (once(camera.has_told_gone, camera.is_gone))
      return camera.name + " is gone; plug it in again, it is looked for";
    if (once(camera.has_told_over, camera.is_over))
      return camera.name + " is over; the dancer is seen by the other cameras";
    if (once(camera.has_told_size, camera.has_other_size))
      return camera.name + " gives pictures of another size; start dance capture again";
    if (pair.moves() != camera.told_moves) {
      camera.told_moves = pair.moves();
      camera.was_placed = false;
      return camera.name + " or the first camera was moved; it is placed again: move about";
    }
    if (pair.is_settled() && !std::exchange(camera.was_placed, true))
      return camera.name + " is placed: " + text_of(*pair.placement());
    if (!pair.is_settled() && once(camera.has_told_search, pair.moments() > 0))
      return camera.name + " is being placed: move about";
  }
  return {};
}

std::vector<OtherCameraReport> OtherCameras::reports() const {
  std::vector<OtherCameraReport> reports;
  for (std::size_t i = 0; i < cameras_.size(); ++i) {
    const Camera& camera = *cameras_[i];
    const CameraPair& pair = views_.pair(i);
    reports.push_back({camera.name, camera.pictures, camera.seen, pair.placement(), pair.moves()});
  }
  return reports;
}

std::string text_of(const PairPlacement& placement) {
  const RelativePose& pose = placement.pose;
  const Eigen::Vector3d p_AB_m = placement.p_AB_m();
  const double turned_rad = std::acos(std::clamp(pose.R_BA(2, 2), -1.0, 1.0));
  std::string text;
  const auto add = [&text](double way_m, const char* less, const char* more) {
    if (std::abs(way_m) < kBeside_m) return;
    text += fmt::format("{:.1f} m {}, ", std::abs(way_m), way_m < 0.0 ? less : more);
  };
  add(p_AB_m.x(), "to the left", "to the right");
  add(p_AB_m.y(), "higher", "lower");
  add(p_AB_m.z(), "further back", "further to the front");
  return text + fmt::format("turned {:.0f} degrees, its pictures {:.0f} ms {}",
                            turned_rad * 180.0 / std::numbers::pi, std::abs(1e3 * pose.later_s),
                            pose.later_s < 0.0 ? "early" : "late");
}

}  // namespace dance
