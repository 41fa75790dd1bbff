#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <sstream>

#include "apps/demo/demo_options.h"
#include "apps/demo/demo_song.h"
#include "core/base/raw_twin.h"
#include "core/net/udp_socket.h"
#include "core/program/program.h"
#include "core/program/whole_file.h"
#include "formats/bvh/clip_file.h"
#include "house/session.h"
#include "producers/music/beats_file.h"

namespace dance {
namespace {

namespace fs = std::filesystem;

constexpr std::array<const char*, 8> kNames{"alice", "bob",   "carol", "dave",
                                            "erin",  "frank", "grace", "heidi"};
constexpr double kCoupleSpacing_m = 2.6;

struct Place {
  double x_m = 0.0;
  double z_m = 0.0;
  double heading_deg = 0.0;
};

GuestId name_of(int dancer) {
  const auto index = static_cast<std::size_t>(dancer);
  const std::string name =
      index < kNames.size() ? kNames[index] : "guest-" + std::to_string(dancer + 1);
  return *GuestId::parse(name);
}

// Couples stand in rows around the middle of the stage.
Place place_of_couple(int couple, int couples) {
  const int columns = static_cast<int>(std::ceil(std::sqrt(static_cast<double>(couples))));
  const int rows = (couples + columns - 1) / columns;
  return {(couple % columns - 0.5 * (columns - 1)) * kCoupleSpacing_m,
          (couple / columns - 0.5 * (rows - 1)) * kCoupleSpacing_m, 0.0};
}

std::string text_of(const Place& place) {
  std::ostringstream text;
  text << place.x_m << "," << place.z_m << "," << place.heading_deg;
  return text.str();
}

// Where a take's dancer stands and looks in its first second, on the floor plane.
struct TakeStance {
  Eigen::Vector2d p_m = Eigen::Vector2d::Zero();  // x, z
  double heading_rad = 0.0;                       // 0 = facing +Z, positive to the left
};

TakeStance take_stance(const MotionClip& clip) {
  TakeStance stance;
  Eigen::Vector2d facing = Eigen::Vector2d::Zero();
  const std::size_t count = std::min(clip.frames.size(), static_cast<std::size_t>(clip.frame_hz));
  for (std::size_t i = 0; i < count; ++i) {
    const Pose& pose = clip.frames[i];
    stance.p_m += Eigen::Vector2d(pose.p_WH_m.x(), pose.p_WH_m.z()) / static_cast<double>(count);
    const Eigen::Vector3f forward = pose.R_PB[0] * Eigen::Vector3f::UnitZ();
    facing += Eigen::Vector2d(forward.x(), forward.z());
  }
  stance.heading_rad = std::atan2(facing.x(), facing.y());
  return stance;
}

// The middle of where a take's dancer goes, on the floor plane.
Eigen::Vector2d middle_of(const MotionClip& clip) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (const Pose& pose : clip.frames) sum += Eigen::Vector2d(pose.p_WH_m.x(), pose.p_WH_m.z());
  return sum / static_cast<double>(clip.frames.size());
}

// Two takes of one couple share their space and their time: as many frames, and bodies within reach
// of each other.
bool are_a_couple(const MotionClip& a, const MotionClip& b) {
  if (a.frames.size() != b.frames.size() || a.frame_hz != b.frame_hz) return false;
  double distance = 0.0;
  for (std::size_t i = 0; i < a.frames.size(); ++i)
    distance += static_cast<double>((a.frames[i].p_WH_m - b.frames[i].p_WH_m).norm());
  distance /= static_cast<double>(a.frames.size());
  return distance > 0.2 && distance < 3.0;
}

// dance-replay's --place turns about the file's origin and then shifts. This one brings a dancer
// who stands at `stance` to `target`, looking along heading_rad.
Place place_at(const TakeStance& stance, const Eigen::Vector2d& target, double heading_rad) {
  const double turn = heading_rad - stance.heading_rad;
  // A turn about +Y by θ takes (x, z) to (x cos θ + z sin θ, z cos θ − x sin θ).
  const Eigen::Vector2d turned(stance.p_m.x() * std::cos(turn) + stance.p_m.y() * std::sin(turn),
                               stance.p_m.y() * std::cos(turn) - stance.p_m.x() * std::sin(turn));
  const Eigen::Vector2d shift = target - turned;
  return {shift.x(), shift.y(), turn * 180.0 / M_PI};
}

// The two places of takes a and b as the couple number `couple`.
std::array<Place, 2> places_of(const MotionClip& a, const MotionClip& b, const Place& couple) {
  const Eigen::Vector2d target(couple.x_m, couple.z_m);
  if (are_a_couple(a, b)) {
    const Eigen::Vector2d shift = target - 0.5 * (middle_of(a) + middle_of(b));
    return {Place{shift.x(), shift.y(), 0.0}, Place{shift.x(), shift.y(), 0.0}};
  }
  constexpr double kHalfDistance_m = 0.6;
  const Eigen::Vector2d half(0.0, kHalfDistance_m);
  return {place_at(take_stance(a), target - half, 0.0),
          place_at(take_stance(b), target + half, M_PI)};
}

Result<void> deal_out_motion(const DemoOptions& options, DemoPlan& plan) {
  std::vector<MotionClip> clips;
  for (const std::string& file : options.motion) {
    DANCE_TRY(LoadedClip loaded, load_clip(file));
    clips.push_back(std::move(loaded.clip));
  }
  const int couples = (options.guests + 1) / 2;
  for (int i = 0; i < options.guests; ++i) {
    const std::size_t files = options.motion.size();
    const std::size_t lead = static_cast<std::size_t>(i / 2 * 2) % files;
    const std::size_t follow = static_cast<std::size_t>(i / 2 * 2 + 1) % files;
    const auto places = places_of(clips[lead], clips[follow], place_of_couple(i / 2, couples));
    DemoDancer& dancer = plan.dancers[static_cast<std::size_t>(i)];
    dancer.program = "dance-replay";
    dancer.arguments = {options.motion[i % 2 == 0 ? lead : follow],
                        "--place=" + text_of(places[i % 2])};
  }
  return {};
}

void deal_out_salsa(const DemoOptions& options, DemoPlan& plan) {
  const int couples = (options.guests + 1) / 2;
  for (int i = 0; i < options.guests; ++i) {
    Place place = place_of_couple(i / 2, couples);
    place.heading_deg = 90.0 + 37.0 * (i / 2);  // seen from the side, and no two couples alike
    DemoDancer& dancer = plan.dancers[static_cast<std::size_t>(i)];
    dancer.program = "dance-salsa";
    dancer.arguments = {"--role",
                        i % 2 == 0 ? "follow" : "lead",
                        "--tempo",
                        std::to_string(options.tempo_bpm),
                        "--seed",
                        std::to_string(options.seed + i / 2),
                        "--place=" + text_of(place)};
  }
}

std::string quoted(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "\"" : ", \"") + word + '"';
  return text;
}

std::string text_of(const RouteEnd& end) {
  return "POSE/" + std::string(where_name(end.where)) + "/" +
         (end.guest.is_set() ? std::string(end.guest.view()) : "*");
}

std::string text_of(const Route& route) {
  std::ostringstream text;
  text << "\n[[route]]\nfrom = \"" << text_of(route.from) << "\"\n";
  if (!route.through.empty()) text << "through = [" << quoted(route.through) << "]\n";
  if (route.rate_hz > 0.0) text << "rate = " << route.rate_hz << "\n";
  text << "to = \"" << text_of(route.to) << "\"\n";
  return text.str();
}

// As any house has them, unless --through says otherwise; and for a comparison the remote dancers
// once more, as their poses come.
std::vector<Route> routes_of(const DemoPlan& plan, const DemoOptions& options, int house) {
  std::vector<Route> routes = default_routes();
  for (Route& route : routes)
    if (route.from.where == Where::kGuest && !options.through.empty())
      route.through = options.through;
  for (const DemoDancer& dancer : plan.dancers)
    if (options.compare && dancer.house != house)
      routes.push_back(
          {{Where::kGuest, dancer.guest}, {Where::kStage, *raw_twin_of(dancer.guest)}, {}, 0.0});
  return routes;
}

std::string session_text(const DemoPlan& plan, const DemoOptions& options, int house, int port) {
  std::vector<std::string> guests;
  for (const DemoDancer& dancer : plan.dancers)
    if (dancer.house == house) guests.emplace_back(dancer.guest.view());
  std::ostringstream text;
  text << "# House " << (house == 0 ? "A" : "B") << " of a demo; made by dance demo.\n[house]\n"
       << "guests = [" << quoted(guests) << "]\nroom = \"demo\"\nserver = \"127.0.0.1:" << port
       << "\"\nbus = \"" << plan.bus_url[house] << "\"\nview = false\n";
  for (const Route& route : routes_of(plan, options, house)) text << text_of(route);
  return text.str();
}

// Read before anything starts, so that a song without beats is said at once.
Result<std::string> song_of(const DemoOptions& options) {
  if (options.music == "none") return std::string();
  const bool can_play = fs::exists(program_folder() + "/dance-music");
  if (!options.music.empty()) {
    if (!can_play)
      return fail("--music: built without dance music; install libsndfile1-dev and build again");
    std::error_code error;
    if (!fs::is_regular_file(options.music, error))
      return fail("--music " + options.music + ": cannot be read; is the name right?");
    if (auto beats = read_beats_file(beats_path_beside(options.music)); !beats)
      return tl::make_unexpected(beats.error());
    return options.music;
  }
  if (!can_play) return std::string();
  const std::string wav = programs_folder(options) + "/percussion.wav";
  if (auto written = write_demo_song(wav, options.tempo_bpm); !written)
    return tl::make_unexpected(written.error());
  return wav;
}

}  // namespace

Result<DemoPlan> plan_demo(const DemoOptions& options) {
  DemoPlan plan;
  std::error_code error;
  fs::create_directories(programs_folder(options), error);
  if (error) return fail(programs_folder(options) + ": cannot be made: " + error.message());

  for (int i = 0; i < options.guests; ++i) plan.dancers.push_back({name_of(i), i % 2, "", {}});
  if (options.motion.empty()) {
    deal_out_salsa(options, plan);
  } else if (auto dealt = deal_out_motion(options, plan); !dealt) {
    return tl::make_unexpected(dealt.error());
  }

  plan.bus_url[0] = "udpm://239.255.76.67:7667?ttl=0";
  plan.bus_url[1] = "udpm://239.255.76.67:7668?ttl=0";
  plan.server_port = options.port;
  if (plan.server_port == 0) {
    DANCE_TRY(plan.server_port, free_loopback_port());
  }
  if (!options.line.is_perfect_line()) {
    if (auto line = load_line(options.line); !line) return tl::make_unexpected(line.error());
    DANCE_TRY(plan.line_port, free_loopback_port());
  }
  for (int house = 0; house < 2; ++house) {
    // The emulated line lies between the server and house B, so that each pose crosses it once.
    const int port = house == 1 && plan.line_port != 0 ? plan.line_port : plan.server_port;
    plan.session_file[house] =
        programs_folder(options) + (house == 0 ? "/house-a.toml" : "/house-b.toml");
    if (auto written =
            write_whole_file(plan.session_file[house], session_text(plan, options, house, port));
        !written)
      return tl::make_unexpected(written.error());
  }
  DANCE_TRY(plan.song, song_of(options));
  plan.log_file = options.out + "/demo.lcm";
  fs::remove(plan.log_file, error);  // of the last demo
  return plan;
}

}  // namespace dance
