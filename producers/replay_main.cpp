// dance replay: BVH files and LCM logs as dancers on the bus.

#include <spdlog/spdlog.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>

#include "core/program/program.h"
#include "producers/clip_dancer.h"
#include "producers/clip_file.h"
#include "producers/log_player.h"
#include "producers/producer_program.h"

namespace dance {
namespace {

constexpr const char* kExamples = R"(Examples:
  dance replay take.bvh                              as alice, over and over
  dance replay lead.bvh.xz follow.bvh.xz             a couple: alice and bob
  dance replay take.bvh --guest carol --speed 0.5 --once
  dance replay logs/evening.lcm                      a recorded session, as if it were live
  dance replay logs/evening.lcm --only capture       only what the cameras saw
  dance replay lead.bvh follow.bvh --copies 15       30 dancers
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
};

bool is_lcm_log(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::array<char, 4> head{};
  return file.read(head.data(), 4) && head == std::array<char, 4>{'\xED', '\xA1', '\xDA', '\x01'};
}

// alice, bob, then guest-3 …, unless --guest says otherwise; copies are numbered.
Result<GuestId> name_of(const ReplayOptions& options, std::size_t file, int copy) {
  static constexpr std::array<const char*, 2> kNames{"alice", "bob"};
  std::string name = file < options.guests.size() ? options.guests[file]
                     : file < kNames.size()       ? kNames[file]
                                                  : "guest-" + std::to_string(file + 1);
  if (copy > 0) name += "-" + std::to_string(copy + 1);
  const auto guest = GuestId::parse(name);
  if (!guest) return fail("--guest '" + name + "': " + kGuestIdRule);
  return *guest;
}

// Copies stand in rows, 2.6 m apart.
StagePlace place_of_copy(const StagePlace& place, int copy, int copies) {
  constexpr double kSpacing_m = 2.6;
  const int columns = static_cast<int>(std::ceil(std::sqrt(static_cast<double>(copies))));
  return {place.x_m + (copy % columns) * kSpacing_m, place.z_m + (copy / columns) * kSpacing_m,
          place.heading_deg};
}

Result<void> add_clip(const ReplayOptions& options, std::size_t file, ProducerProgram& program) {
  StagePlace place;
  if (!options.place.empty()) {
    DANCE_TRY(place, parse_place(options.place));
  }
  DANCE_TRY(LoadedClip loaded, load_clip(options.files[file]));
  for (const std::string& note : loaded.notes) spdlog::info("{}: {}", options.files[file], note);
  const auto clip = std::make_shared<const MotionClip>(std::move(loaded.clip));
  for (int copy = 0; copy < options.copies; ++copy) {
    DANCE_TRY(const GuestId guest, name_of(options, file, copy));
    const StagePlace at = place_of_copy(place, copy, options.copies);
    ClipDancerOptions how;
    how.end = options.once ? ClipEnd::kHold : ClipEnd::kLoop;
    how.speed = options.speed;
    how.placement = {at.x_m, at.z_m, at.heading_deg};
    program.add(std::make_unique<ClipDancer>(clip, how), guest);
  }
  return {};
}

Result<void> run_replay(const ReplayOptions& options) {
  LogPlayerOptions log_options;
  log_options.speed = options.speed;
  log_options.loop = !options.once;
  for (const std::string& where : options.only) log_options.only.push_back(*find_where(where));

  DANCE_TRY(auto program, ProducerProgram::open(options.producer));
  std::vector<std::unique_ptr<LogPlayer>> players;
  for (std::size_t i = 0; i < options.files.size(); ++i) {
    if (is_lcm_log(options.files[i])) {
      DANCE_TRY(LogReader log, LogReader::open(options.files[i]));
      players.push_back(std::make_unique<LogPlayer>(std::move(log), log_options, program->bus(),
                                                    program->poller(), program->start()));
      if (players.back()->is_over())
        return fail(options.files[i] + ": holds no poses of ours" +
                    (options.only.empty() ? "" : " on the channels that --only names"));
    } else if (auto added = add_clip(options, i, *program); !added) {
      return added;
    }
  }
  spdlog::info("playing; Ctrl-C ends it");
  program->run([&] {
    for (const auto& player : players)
      if (!player->is_over()) return false;
    return true;
  });
  for (const auto& player : players) {
    const auto& counters = player->counters();
    spdlog::info("{} messages played, {} left out, {} undecodable, {} damaged bytes skipped",
                 counters.played, counters.left_out, counters.undecodable, player->skipped_bytes());
  }
  if (program->sent() > 0) spdlog::info("{} poses", program->sent());
  return {};
}

}  // namespace
}  // namespace dance

int main(int argc, char** argv) {
  dance::ReplayOptions options;
  CLI::App app{"Plays BVH files (.bvh, .bvh.xz) and LCM logs as dancers on the bus.",
               "dance replay"};
  app.add_option("FILE", options.files, "BVH files, one dancer each, or LCM logs")->required();
  app.add_option("--guest", options.guests, "who the dancers of the BVH files are, in turn");
  app.add_option("--speed", options.speed, "1 = as recorded")
      ->check(CLI::Range(0.05, 20.0))
      ->capture_default_str();
  app.add_flag("--once", options.once, "stop at the end instead of beginning again");
  app.add_option("--place", options.place,
                 "turns a BVH dancer about the file's origin and moves it: x,z,heading");
  app.add_option("--copies", options.copies, "so many of each BVH dancer, in rows")
      ->check(CLI::Range(1, 64));
  app.add_option("--only", options.only, "of a log, only capture, guest or stage")
      ->check(CLI::IsMember({"capture", "guest", "stage"}));
  dance::add_producer_options(app, options.producer);
  app.footer(dance::kExamples);
  return dance::run_program(app, argc, argv, [&] { return dance::run_replay(options); });
}
