#include "bench/view/bench_view.h"

#include <epoxy/gl.h>
#include <time.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

#include "bench/parts/salsa_poses.h"
#include "bench/view/bench_avatar.h"
#include "core/net/mono_clock.h"
#include "formats/avatar/mannequin_model.h"
#include "formats/body/guest_look.h"
#include "viewer/gl/offscreen.h"
#include "viewer/gl/picture.h"
#include "viewer/stage/stage_renderer.h"

namespace dance {
namespace {

using Eigen::Vector3f;

constexpr float kApart_m = 1.2f;
constexpr int kWarmUp = 5;  // pictures that upload models and link shaders
constexpr std::int64_t kPosesPerSecond = 60;

double cpu_ms() {
  timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return 1e3 * static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_nsec);
}
// Of this thread alone, which on a software renderer still shades the vertices.
double thread_ms() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return 1e3 * static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_nsec);
}
double ms_since(MonoTime begun) { return 1e3 * (mono_now() - begun).as_seconds(); }

// A square of couples who all dance the same minute, each a little later than the one before.
class Crowd {
 public:
  explicit Crowd(int guests)
      : lead_(salsa_poses(SalsaRole::kLead)), follow_(salsa_poses(SalsaRole::kFollow)) {
    const int columns = static_cast<int>(std::ceil(std::sqrt(1.6 * guests)));
    for (int i = 0; i < guests; ++i) {
      SceneGuest guest;
      guest.id = *GuestId::parse("guest-" + std::to_string(i + 1));
      scene_.guests.push_back(guest);
      places_m_.emplace_back(kApart_m * static_cast<float>(i % columns - columns / 2), 0.0f,
                             kApart_m * static_cast<float>(i / columns - guests / columns / 2));
    }
    scene_.music = SceneMusic{0.0, 3.0, 4};
  }

  void wear_mannequins() {
    for (SceneGuest& guest : scene_.guests)
      guest.avatar = std::make_shared<const AvatarModel>(
          mannequin_model(guest.skeleton, look_of(guest.id), false));
  }
  void wear(const std::shared_ptr<const AvatarModel>& avatar) {
    for (SceneGuest& guest : scene_.guests) guest.avatar = avatar;
  }
  void leave() { scene_.guests.clear(); }

  const SceneState& at(double s) {
    const auto frame = static_cast<std::size_t>(std::llround(s * double{kPosesPerSecond}));
    for (std::size_t i = 0; i < scene_.guests.size(); ++i) {
      const auto& poses = i % 2 == 0 ? lead_ : follow_;
      SceneGuest& guest = scene_.guests[i];
      guest.pose = poses[(frame + 11 * i) % poses.size()];
      guest.pose.p_WH_m += places_m_[i];
    }
    scene_.time = MonoTime::from_us(1'000'000) + Duration::seconds(s);
    scene_.music->beats = 3.0 * s;
    return scene_;
  }

  OrbitCamera camera(float aspect) {
    std::vector<Vector3f> points;
    for (const SceneGuest& guest : at(0.0).guests) append_outline(guest, points);
    OrbitCamera camera;
    camera.pitch_rad = 0.3f;
    return frame_points(camera, points, aspect, 0.92f);
  }

 private:
  std::vector<Pose> lead_, follow_;
  std::vector<Vector3f> places_m_;
  SceneState scene_;
};

struct Lane {
  Lane(const char* name, const Crowd& dancers) : crowd(dancers) { row.name = name; }
  BenchViewRow row;
  Crowd crowd;
  bool is_stereo = false;
  Venue place = Venue::kPlain;
};

// Where the camera is, side by side, as wide open as headsets are.
std::array<StageEye, 2> both_eyes(const OrbitCamera& camera, int height_px) {
  constexpr float kApart = 0.032f;
  constexpr EyeTangents kLeft{-1.2f, 0.9f, 1.0f, -1.1f}, kRight{-0.9f, 1.2f, 1.0f, -1.1f};
  const Vector3f right = camera.axes_W().col(0);
  return {eye_at(camera.eye_W_m() - kApart * right, camera.axes_W(), kLeft, height_px),
          eye_at(camera.eye_W_m() + kApart * right, camera.axes_W(), kRight, height_px)};
}

Result<void> draw(Lane& lane, StageRenderer& renderer, const OrbitCamera& camera,
                  const BenchViewOptions& options, double s, bool counts) {
  const SceneState& scene = lane.crowd.at(s);
  glFinish();
  const double cpu_begun = cpu_ms();
  const double thread_begun = thread_ms();
  const MonoTime begun = mono_now();
  if (auto prepared = renderer.prepare(scene, camera, options.width_px, options.height_px);
      !prepared)
    return prepared;
  const double prepared_ms = ms_since(begun);
  if (lane.is_stereo) {
    renderer.paint_shadows();
    for (const StageEye& eye : both_eyes(camera, options.height_px)) renderer.paint_eye(eye);
  } else {
    renderer.paint();
  }
  const double submitted_ms = thread_ms() - thread_begun;
  glFinish();
  if (!counts) return {};
  lane.row.frame_ms.push_back(ms_since(begun));
  lane.row.cpu_ms.push_back(cpu_ms() - cpu_begun);
  lane.row.retarget_upload_ms.push_back(prepared_ms);
  lane.row.submit_ms.push_back(submitted_ms);
  lane.row.triangles = renderer.drawn().triangles;
  lane.row.draw_calls = renderer.drawn().calls;
  return {};
}

Result<std::vector<Lane>> lanes_of(const BenchViewOptions& options) {
  std::vector<Lane> lanes;
  Crowd crowd(options.guests);
  if (options.places) {
    crowd.wear_mannequins();
    for (const PlaceName& it : kPlaceNames) {
      lanes.emplace_back(it.option.data(), crowd);
      lanes.back().place = it.place;
    }
    return lanes;
  }
  lanes.emplace_back("empty_stage", crowd);
  lanes.back().crowd.leave();
  lanes.emplace_back("mannequins", crowd);
  lanes.back().crowd.wear_mannequins();
  if (!options.avatar.empty()) {
    DANCE_TRY(const auto avatar, read_bench_avatar(options.avatar));
    lanes.emplace_back("avatars", crowd);
    lanes.back().crowd.wear(avatar);
  }
  const std::size_t rows = options.stereo ? lanes.size() : 0;
  for (std::size_t i = 0; i < rows; ++i) {
    lanes.push_back(lanes[i]);
    lanes.back().row.name += "_stereo";
    lanes.back().is_stereo = true;
  }
  return lanes;
}

}  // namespace

Result<BenchViewResult> run_bench_view(const BenchViewOptions& options) {
  DANCE_TRY(std::vector<Lane> lanes, lanes_of(options));
  DANCE_TRY(const auto context, OffscreenContext::create());
  // A renderer makes a place when it shows it, so each place has a renderer of its own.
  std::vector<std::unique_ptr<StageRenderer>> renderers(options.places ? lanes.size() : 1);
  for (auto& renderer : renderers) {
    DANCE_TRY(renderer, StageRenderer::create(options.quality));
  }
  const OrbitCamera camera = lanes[1].crowd.camera(static_cast<float>(options.width_px) /
                                                   static_cast<float>(options.height_px));
  MonoTime begun;
  for (int picture = 0;; ++picture) {
    const bool counts = picture >= kWarmUp;
    if (picture == kWarmUp) begun = mono_now();
    const double s = counts ? (mono_now() - begun).as_seconds() : 0.0;
    if (s > options.seconds) break;
    for (std::size_t l = 0; l < lanes.size(); ++l) {
      StageLook look;
      look.stage = static_cast<int>(l);
      look.place = lanes[l].place;
      StageRenderer& renderer = *renderers[l % renderers.size()];
      renderer.set_look(look);
      if (auto drawn = draw(lanes[l], renderer, camera, options, s, counts); !drawn)
        return tl::make_unexpected(drawn.error());
    }
  }
  if (!options.picture.empty()) {
    glBindFramebuffer(GL_READ_FRAMEBUFFER, renderers.back()->target().finished().name());
    const Picture picture = read_bound_framebuffer(options.width_px, options.height_px);
    if (auto written = write_png(options.picture, picture); !written)
      return tl::make_unexpected(written.error());
  }
  BenchViewResult result;
  result.renderer = renderer_name();
  for (Lane& lane : lanes) {
    for (auto* samples :
         {&lane.row.frame_ms, &lane.row.cpu_ms, &lane.row.retarget_upload_ms, &lane.row.submit_ms})
      std::sort(samples->begin(), samples->end());
    result.rows.push_back(std::move(lane.row));
  }
  return result;
}

}  // namespace dance
