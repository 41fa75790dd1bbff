// dance replay: recorded dances of any kind (BVH, GLB, LCM log, MCAP, table) as dancers on the bus.

#include <array>
#include <cmath>
#include <cstdio>

#include "core/program/program.h"
#include "core/program/talk.h"
#include "formats/clip/dancers_file.h"
#include "formats/log/unpacked_log.h"
#include "formats/recorded/recording_log.h"
#include "producers/producer_program.h"
#include "producers/replay/clip_dancer.h"
#include "producers/replay/log_player.h"

namespace dance {
namespace {

constexpr const char* kExamples = R"(Examples:
  dance replay take.bvh                              as alice, over and over
  dance replay lead.bvh.xz follow.bvh.xz             a couple: alice and bob
  dance replay take.bvh --guest carol --speed 0.5 --once
  dance replay couple.glb                            all who dance in a glTF file, by their names
  dance replay logs/evening.lcm                      a recorded session, packed or not
  dance replay logs/evening.lcm --only capture       only what the cameras saw
  dance replay evening.mcap                          what dance listen recorded, also as .csv
  dance replay lead.bvh follow.bvh --copies 15       30 dancers
  dance replay child.bvh --unit cm --up z            where the printed estimates are wrong
)";

struct ReplayOptions {
  ProducerOptions producer;
  std::vector<std::string> files;
  std::vector<std::string> guests;
  std::vector<std::string> only;
  std::string place;
  double speed = 1.0;
  bool once = false;
  int copies = 1;
  // What a BVH file does not say, where the estimate is wrong.
  RetargetOptions retarget;
  double frame_hz = 0.0;  // 0 = the file's
};

void add_file_options(CommandLine& line, ReplayOptions& options) {
  line.add_choice<double>(
      "--unit", options.retarget.metres_per_unit,
      {{"m", 1.0}, {"dm", 0.1}, {"cm", 0.01}, {"mm", 0.001}, {"ft", 0.3048}, {"in", 0.0254}},
      "of the BVH file, where its figure is not the size it should be: m, dm, cm, mm, ft, in");
  line.add_choice<UpAxis>(
      "--up", options.retarget.up, {{"y", UpAxis::kY}, {"z", UpAxis::kZ}},
      "axis of the BVH file that points up: y or z; without it, how the figure stands tells");
  line.add("--frame-hz", options.frame_hz,
           "of the BVH file, where it says it wrongly; 0 = as it says")
      .range(0.0, 1000.0);
}

// As --guest says; else as the file does where that is a guest's name; else alice, bob, then
// guest-3 …; copies are numbered.
Result<GuestId> name_of(const ReplayOptions& options, const std::string& in_file,
                        std::size_t dancer, int copy) {
  static constexpr std::array<const char*, 2> kNames{"alice", "bob"};
  std::string name = dancer < options.guests.size() ? options.guests[dancer]
                     : GuestId::parse(in_file)      ? in_file
                     : dancer < kNames.size()       ? kNames[dancer]
                                                    : "guest-" + std::to_string(dancer + 1);
  if (copy > 0) name += "-" + std::to_string(copy + 1);
  const auto guest = GuestId::parse(name);
  if (!guest) return fail("--guest '" + name + "': " + kGuestIdRule);
  return *guest;
}

// Copies stand in rows, 2.6 m apart.
ProducerPlace place_of_copy(const ProducerPlace& place, int copy, int copies) {
  constexpr double kSpacing_m = 2.6;
  const int columns = static_cast<int>(std::ceil(std::sqrt(static_cast<double>(copies))));
  return {place.x_m + (copy % columns) * kSpacing_m, place.z_m + (copy / columns) * kSpacing_m,
          place.heading_deg};
}

// `dancers` counts those of all files.
Result<void> add_dancer(const ReplayOptions& options, NamedClip loaded, std::size_t& dancers,
                        ProducerProgram& program) {
  ProducerPlace place;
  if (!options.place.empty()) {
    DANCE_TRY(place, parse_place(options.place));
  }
  const std::size_t dancer = dancers++;
  const auto clip = std::make_shared<const MotionClip>(std::move(loaded.clip));
  for (int copy = 0; copy < options.copies; ++copy) {
    DANCE_TRY(const GuestId guest, name_of(options, loaded.name, dancer, copy));
    const ProducerPlace at = place_of_copy(place, copy, options.copies);
    ClipDancerOptions how;
    how.end = options.once ? ClipEnd::kHold : ClipEnd::kLoop;
    how.speed = options.speed;
    how.placement = {at.x_m, at.z_m, at.heading_deg};
    program.add(std::make_unique<ClipDancer>(clip, how), guest);
  }
  return {};
}

Result<void> add_file(const ReplayOptions& options, const std::string& file, std::size_t& dancers,
                      ProducerProgram& program) {
  RetargetOptions retarget = options.retarget;
  if (options.frame_hz > 0.0) retarget.frame_hz = options.frame_hz;
  DANCE_TRY(std::vector<NamedClip> loaded, load_dancers(file, retarget));
  for (NamedClip& each : loaded) {
    for (const std::string& note : each.notes) talk::info("{}: {}", file, note);
    if (!each.lost.empty()) talk::warn("{}: {}; the rest is played", file, each.lost);
    if (auto added = add_dancer(options, std::move(each), dancers, program); !added) return added;
  }
  return {};
}

// Opens an LCM log; an MCAP file or a table is converted to one first.
Result<UnpackedLog> open_log(const std::string& file) {
  DANCE_TRY(const RecordingLog log, RecordingLog::open(file));
  for (const std::string& note : log.notes()) talk::info("{}: {}", file, note);
  if (!log.lost().empty()) talk::warn("{}: damaged: {}; the rest is played", file, log.lost());
  return UnpackedLog::open(log.path());
}

std::string nothing_to_play(const LogPlayer& player, bool has_only) {
  const LogUnpacker::Counters& unpacking = player.unpacking();
  if (unpacking.newer > 0) return ": was packed by a newer version of dance: update this one";
  if (unpacking.lost() > 0) return ": all of its packed messages are damaged";
  return std::string(": holds no poses of ours") +
         (has_only ? " on the channels that --only names" : "");
}

Result<void> run_replay(const ReplayOptions& options) {
  LogPlayerOptions log_options;
  log_options.speed = options.speed;
  log_options.loop = !options.once;
  for (const std::string& where : options.only) log_options.only.push_back(*find_where(where));

  DANCE_TRY(auto program, ProducerProgram::open(options.producer));
  std::vector<std::unique_ptr<LogPlayer>> players;
  std::size_t dancers = 0;
  for (std::size_t i = 0; i < options.files.size(); ++i) {
    DANCE_TRY(const FileKind kind, input_kind(options.files[i]));
    if (kind != FileKind::kBvh && kind != FileKind::kGlb) {
      DANCE_TRY(UnpackedLog log, open_log(options.files[i]));
      players.push_back(std::make_unique<LogPlayer>(std::move(log), log_options, program->port(),
                                                    program->poller(), program->start()));
      if (auto ended = players.back()->ended(); !ended) return ended;
      if (players.back()->is_over())
        return fail(options.files[i] + nothing_to_play(*players.back(), !options.only.empty()));
    } else if (auto added = add_file(options, options.files[i], dancers, *program); !added) {
      return added;
    }
  }
  talk::info("playing; Ctrl-C ends it");
  program->run([&] {
    for (const auto& player : players)
      if (!player->is_over()) return false;
    return true;
  });
  for (const auto& player : players) {
    const auto& counters = player->counters();
    talk::info("{} messages played, {} left out, {} undecodable, {} damaged bytes skipped",
               counters.played, counters.left_out, counters.undecodable, player->skipped_bytes());
    if (const std::uint64_t lost = player->unpacking().lost(); lost > 0)
      talk::warn("{} packed messages lost to damage; `dance unpack` tells more", lost);
  }
  if (program->sent() > 0) talk::info("{} poses", program->sent());
  for (const auto& player : players)
    if (auto ended = player->ended(); !ended) return ended;
  return {};
}

}  // namespace
}  // namespace dance

int main(int argc, char** argv) {
  dance::ReplayOptions options;
  dance::CommandLine line(
      "Plays recorded dances as dancers on the bus: .bvh, .bvh.xz, .glb, .lcm, .mcap, .csv.",
      "dance replay");
  line.add("FILE", options.files,
           "BVH files, one dancer each, GLBs, LCM logs, MCAP files or tables")
      .required();
  line.add("--guest", options.guests, "who the dancers of the files are, in turn").guest_name();
  line.add("--speed", options.speed, "1 = as recorded").range(0.05, 20.0).shows_default();
  line.add_flag("--once", options.once, "stop at the end instead of beginning again");
  line.add("--place", options.place,
           "turns a BVH dancer about the file's origin and moves it: x,z,heading");
  line.add("--copies", options.copies, "so many of each BVH dancer, in rows").range(1, 64);
  line.add("--only", options.only, "of a log, only capture, guest or stage")
      .one_of({"capture", "guest", "stage"});
  dance::add_file_options(line, options);
  dance::add_producer_options(line, options.producer);
  line.footer(dance::kExamples);
  return dance::run_program(line, argc, argv, [&] { return dance::run_replay(options); });
}
