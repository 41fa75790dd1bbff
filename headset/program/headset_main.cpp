// dance headset: dances with a headset, its controllers and trackers, and shows the stage in it.

#include <cstdlib>

#include "core/program/program.h"
#include "haptics/haptic_table.h"
#include "headset/program/headset_run.h"

namespace dance {
namespace {

constexpr const char* kExamples =
    R"(The left hand wears a panel: look at the back of the left wrist, as at a watch, and point
at it with the right hand: mute, recentre, calibrate, leave.
Examples:
  dance headset --guest alice                        alice dances, and sees this house's stage
  dance headset --guest alice --at 0,1.2,180         1.2 m before the middle, facing it
  dance headset --guest alice --tracking-only        the headset's runtime shows nothing
  dance headset --guest alice --personal-space 0     others may come as near as they like
  dance headset --guest alice --feel touch --feel lead
                                                     without the beat in the hands
)";

struct Wishes {
  HeadsetOptions headset;
  std::string guest = "guest";
  std::string at = "0,0,0";
  std::vector<std::string> felt;
  bool no_haptics = false, no_mirror = false, no_tags = false;
  double scale = 1.0, personal_space_m = 0.25, floor_m = 8.0;
};

Result<void> finish(Wishes& wishes) {
  HeadsetOptions& headset = wishes.headset;
  const auto guest = GuestId::parse(wishes.guest);
  if (!guest) return fail("--guest '" + wishes.guest + "': " + kGuestIdRule);
  headset.capture.guest = *guest;
  const auto spot = parse_spot(wishes.at);
  if (!spot) return fail("--at " + spot.error().what);
  headset.capture.spot = *spot;
  headset.capture.haptics = !wishes.no_haptics;
  if (!wishes.felt.empty()) {
    DANCE_TRY(headset.capture.felt, parse_felt(wishes.felt));
  }
  headset.is_mirrored = !wishes.no_mirror;
  headset.tags = !wishes.no_tags;
  headset.scale = static_cast<float>(wishes.scale);
  headset.personal_space_m = static_cast<float>(wishes.personal_space_m);
  headset.floor_m = static_cast<float>(wishes.floor_m);
  return {};
}

void add_options(CommandLine& line, Wishes& wishes) {
  HeadsetOptions& headset = wishes.headset;
  line.add("--guest", wishes.guest, "the dancer's name in this house").guest_name().shows_default();
  line.add("--at", wishes.at,
           "where the dancer begins, X,Z or X,Z,HEADING in metres and degrees; before whom stands "
           "there already, face to face")
      .shows_default();
  line.add_flag("--tracking-only", headset.tracking_only,
                "only the dancer's movement: a session without pictures (XR_MND_headless)");
  line.add_choice<TrackerGuide>("--body", headset.capture.body.guide,
                                {{"auto", TrackerGuide::kAutomatic},
                                 {"rules", TrackerGuide::kGeometric},
                                 {"learned", TrackerGuide::kLearned}},
                                "how the untracked rest of the body is found: auto, rules or "
                                "learned");
  line.add("--rate", headset.capture.rate_hz, "poses a second").range(20.0, 500.0).shows_default();
  line.add("--scale", wishes.scale, "size of the pictures, times what the headset recommends")
      .range(0.25, 2.0)
      .shows_default();
  line.add("--personal-space", wishes.personal_space_m,
           "others who come nearer than this to the eyes fade away, in metres; 0 = nobody fades")
      .range(0.0, 3.0)
      .shows_default();
  line.add("--floor", wishes.floor_m,
           "where the floor has faded out, in metres from the dancer: less is calmer")
      .range(1.5, 50.0)
      .shows_default();
  line.add_flag("--no-tags", wishes.no_tags, "without names over heads");
  line.add("--place", headset.place,
           "studio, bar or terrace; or plain: a floor that fades out at --floor, which is calmer")
      .one_of({"plain", "studio", "bar", "terrace"})
      .shows_default();
  using Quality = HeadsetOptions::Quality;
  line.add_choice<Quality>(
      "--quality", headset.quality,
      {{"auto", Quality::kAuto}, {"low", Quality::kLow}, {"high", Quality::kHigh}},
      "auto, low (no antialiasing or mirror images, coarser figures) or high; auto is low without "
      "a "
      "graphics card");
  line.add_flag("--no-mirror", wishes.no_mirror, "without the window that shows the left eye");
  line.add("--avatar", headset.avatars,
           "a file (.vrm, .glb) that everybody is drawn as, or NAME=FILE for one guest; may be "
           "repeated");
  line.add_flag("--no-haptics", wishes.no_haptics, "the controllers let nothing be felt");
  line.add("--feel", wishes.felt, "what is felt: touch, lead, one, beats; may be repeated")
      .one_each_time();
  line.add("--language", headset.language, "of the panel: en, es or de; else the system's")
      .one_of({"en", "es", "de"});
  line.add("--seconds", headset.seconds, "how long; 0 = until told to stop").range(0.0, 1e7);
  line.add("--bus", headset.capture.bus_url, "LCM URL of the house's bus");
  line.footer(kExamples);
}

Result<void> run_headset(const HeadsetOptions& options) {
  // What the loader says of each try is said in one line here.
  setenv("XR_LOADER_DEBUG", "none", 0);  // NOLINT(concurrency-mt-unsafe): the first thread
  DANCE_TRY(const auto show,
            options.tracking_only ? make_tracking_show() : make_stereo_show(options));
  HeadsetRun run(options, *show);
  return run.run();
}

}  // namespace
}  // namespace dance

int main(int argc, char** argv) {
  dance::Wishes wishes;
  dance::CommandLine line("Dances with a headset, and shows the stage in it.", "dance headset");
  dance::add_options(line, wishes);
  line.finally([&] { return dance::finish(wishes); });
  return dance::run_program(line, argc, argv, [&] { return dance::run_headset(wishes.headset); });
}
