// dance view: the stage of this house, in a window or as pictures.

#include <optional>
#include <string>
#include <vector>

#include "core/program/program.h"
#include "core/program/talk.h"
#include "formats/recorded/recording_log.h"
#include "viewer/avatar/user_avatars.h"
#include "viewer/program/view_program.h"
#include "viewer/replay/export/replay_export.h"

namespace dance {
namespace {

constexpr const char* kExamples =
    R"(In the window: ? lists all keys. Drag turns the camera, the wheel comes nearer, right or
  shift drag moves it; F frames everybody, 1 to 9 and Tab choose a dancer, V goes through the
  views, R rotates slowly, Q closes.
Examples:
  dance view                                         the stage of this house
  dance view --focus alice --camera front
  dance view --view mirror --focus teacher           left is left, for those who learn
  dance view --teacher lesson.bvh --teacher-speed 0.5
                                                     a teacher to dance beside, and your steps
  dance view --view grid                             a class, each couple in a place of its own
  dance view --place bar                             or studio, terrace, plain; key Z
  dance view --headless --out pictures --at 2,5,8    three pictures, no display needed
  dance view --headless --out pictures --seconds 10 --every 0.5 --size 640x360
  dance view --headless --out pictures --seconds 2 --strip 6 --no-hud
  dance view --show capture                          only what this house's cameras see
  dance view --avatar me.vrm --avatar bob=bob.glb    bob so, all others so
  dance view logs/couple.lcm                         a recorded dance, with a timeline
  dance view take.bvh                                also of a .bvh, .glb, .mcap or .csv
  dance view logs/couple.lcm --export couple.mp4 --from 0.5 --to 2.5
  dance view --headless out/demo/demo.lcm --compare --beats 16,17,18,19 --strip 4
                                                     a recorded demo, on the beats of its music
)";

struct Wishes {
  ViewOptions view;
  std::string size = "1280x720";
  std::string focus;
  std::string place;
  double display_latency_ms = -1.0;
  bool compare = false;
  bool no_extrapolation = false;
  bool early = false;
  std::vector<std::string> avatars;
  std::string pupil, teacher_dancer;
  bool no_hud = false;
  bool no_tags = false;
};

void add_replay_options(CommandLine& line, Wishes& wishes) {
  ViewOptions& view = wishes.view;
  line.add("log,--log", view.log,
           "a recorded dance: .lcm, .bvh, .glb, .mcap, .csv; else this house, live");
  line.add("--export", view.export_to,
           "write this range of the log, without a window: FILE.bvh, FILE.glb, FOLDER/ of "
           "pictures, FILE.mp4, .webm or .mkv");
  line.add("--from", view.export_from_s, "where the export begins, in seconds from the start")
      .range(0.0, 864000.0);
  line.add("--to", view.export_until_s, "where it ends; the end of the log unless said")
      .range(0.001, 864000.0);
  line.add("--hz", view.export_hz,
           "its frames a second: 60 of motion and 30 of pictures unless said")
      .range(1.0, 480.0);
  line.add_flag("--silent", view.export_silent, "a video without music and voices");
}

std::vector<std::string> place_names() {
  std::vector<std::string> names;
  for (const PlaceName& it : kPlaceNames) names.emplace_back(it.option);
  return names;
}

void add_practice_options(CommandLine& line, Wishes& wishes) {
  TeacherOptions& teacher = wishes.view.teacher;
  line.add("--teacher", teacher.file,
           "a recording whose dancer stands beside you as a transparent figure, in this window "
           "alone: .lcm, .bvh, .glb, .mcap, .csv");
  line.add("--teacher-dancer", wishes.teacher_dancer, "which dancer of it; the first by name")
      .guest_name();
  line.add("--teacher-speed", teacher.choices.speed, "from half to full speed, as 0.75")
      .range(TeacherChoices::kSlowest, TeacherChoices::kFastest);
  line.add_flag("--teacher-mirrored", teacher.choices.is_mirrored, "left is right");
  line.add("--pupil", wishes.pupil,
           "the guest of this house beside whom the teacher stands and whose steps --panel "
           "practice counts; the first by name")
      .guest_name();
}

void add_options(CommandLine& line, Wishes& wishes) {
  ViewOptions& view = wishes.view;
  add_replay_options(line, wishes);
  add_practice_options(line, wishes);
  line.add("--bus", view.feed.bus_url, "LCM URL of the house's bus");
  line.add_choice<Shown>(
      "--show", view.feed.shown,
      {{"best", Shown::kBest},
       {"capture", Shown::kCapture},
       {"guest", Shown::kGuest},
       {"stage", Shown::kStage}},
      "of a live house: best (own guests from the capture, others and held hands from the stage), "
      "capture, guest or stage");
  line.add_flag("--stage-only", view.feed.stage_only, "own guests from the stage too");
  line.add_choice<CameraPreset>("--camera", view.camera,
                                {{"auto", CameraPreset::kAuto},
                                 {"front", CameraPreset::kFront},
                                 {"side", CameraPreset::kSide},
                                 {"top", CameraPreset::kTop},
                                 {"orbit", CameraPreset::kOrbit}},
                                "auto (across the line of dancers), front, side, top or orbit");
  line.add_choice<ViewMode>("--view", view.view,
                            {{"orbit", ViewMode::kOrbit},
                             {"follow", ViewMode::kFollow},
                             {"mirror", ViewMode::kMirror},
                             {"first-person", ViewMode::kFirstPerson},
                             {"compare", ViewMode::kCompare},
                             {"grid", ViewMode::kGrid}},
                            "orbit (the whole stage), follow or mirror a dancer, first-person, "
                            "compare (as it comes, as it is staged) or grid");
  line.add("--focus", wishes.focus, "the guest that the view is of").guest_name();
  line.add_choice<QualityWish>(
      "--quality", view.quality,
      {{"auto", QualityWish::kAuto}, {"low", QualityWish::kLow}, {"high", QualityWish::kHigh}},
      "auto, low (no antialiasing or mirror images, coarser figures) or high; auto is low in a "
      "window without a graphics card, else high: pictures in files always, unless low is said");
  line.add("--place", wishes.place,
           "studio, bar, terrace, or plain (a disc of light); default: studio in a window and in "
           "exports, plain in other pictures")
      .one_of(place_names());
  line.add("--size", wishes.size, "of window or pictures").shows_default();
  line.add_flag("--hud", view.hud, "a window with the measurements; H shows them too");
  line.add_flag("--no-hud", wishes.no_hud, "headless: without the measurements");
  line.add_flag("--no-tags", wishes.no_tags, "without names over heads");
  line.add_flag("--headless", view.headless, "no window: pictures in files, named on stdout");
  line.add_choice<std::string>("--panel", view.panel,
                               {{"dance", "dance"},
                                {"instruments", "instruments"},
                                {"style", "style"},
                                {"practice", "practice"},
                                {"keys", "keys"},
                                {"timeline", "timeline"}},
                               "open this panel: dance, instruments, style, practice or keys; "
                               "headless, with a log: timeline");
  line.add_choice<Language>(
      "--language", view.language,
      {{"en", Language::kEnglish}, {"es", Language::kSpanish}, {"de", Language::kGerman}},
      "of the dance panel's texts: en, es or de; else the system's");
  line.add("--session", view.session, "the session file of this house, for what panels save");
  line.add("--out", view.out, "directory of the pictures").shows_default();
  line.add("--seconds", wishes.view.moments.seconds,
           "headless: how long to listen, 3 unless said; of a log all, unless said")
      .range(0.05, 86400.0);
  line.add("--at", wishes.view.moments.at_s, "headless: pictures at these seconds, as 2,5,8")
      .split_at(',')
      .range(0.0, 86400.0);
  line.add("--every", wishes.view.moments.every_s, "headless: a picture every so many seconds")
      .range(0.02, 86400.0);
  line.add("--strip", wishes.view.moments.strip,
           "headless: so many moments side by side in stage-strip.png")
      .range(2, 24);
  line.add("--avatar", wishes.avatars,
           "a file (.vrm, .glb) that everybody is drawn as, or NAME=FILE for one guest; may be "
           "repeated");
  line.add("--beats", view.beats, "headless, of a log: pictures on these beats of the music")
      .split_at(',')
      .range(-1'000'000.0, 1'000'000.0);
  line.add_flag("--film", wishes.view.moments.film,
                "headless, of a log: every picture of a film, 25 a second, as 0001.png …");
  line.add_flag("--compare", wishes.compare, "the same as --view compare");
  line.add_choice<DisplayMode>(
      "--display", view.display,
      {{"tear-free", DisplayMode::kTearFree}, {"low-latency", DisplayMode::kLowLatency}},
      "tear-free, or low-latency (a late picture is shown at once, torn)");
  line.add("--display-latency-ms", wishes.display_latency_ms,
           "from the display's turn to the light of its middle; else half a period")
      .range(0.0, 100.0);
  line.add_flag("--no-extrapolation", wishes.no_extrapolation,
                "poses as they came, not brought to the moment of their light");
  line.add_flag("--early", wishes.early,
                "take poses when the last picture is shown, not as late as drawing allows");
  line.footer(kExamples);
}

// What one option cannot check by itself.
Result<void> finish(Wishes& wishes) {
  DANCE_TRY(wishes.view.size, parse_size(wishes.size));
  if (auto planned = plan_moments(wishes.view.moments); !planned)
    return tl::make_unexpected(planned.error());
  if (auto shown = check_shown(wishes.view); !shown) return shown;
  if (!wishes.pupil.empty()) wishes.view.pupil = GuestId::parse(wishes.pupil);
  if (!wishes.teacher_dancer.empty())
    wishes.view.teacher.dancer = GuestId::parse(wishes.teacher_dancer).value_or(GuestId());
  if (auto teacher = check_teacher(wishes.view); !teacher) return teacher;
  if (!wishes.view.export_to.empty()) {
    if (wishes.view.log.empty()) return fail("--export needs a log: dance view LOG --export FILE");
    if (auto kind = export_kind(wishes.view.export_to); !kind)
      return tl::make_unexpected(kind.error());
    if (wishes.view.export_until_s > 0.0 && wishes.view.export_until_s <= wishes.view.export_from_s)
      return fail("--to is not after --from; let the range end after it begins");
    wishes.view.headless = true;
  } else if (wishes.view.export_silent) {
    return fail("--silent needs a video: dance view LOG --export FILE.mp4 --silent");
  }
  if (wishes.view.panel == "timeline" && wishes.view.log.empty())
    return fail("--panel timeline needs a log: dance view LOG");
  const std::string& panel = wishes.view.panel;
  if ((panel == "dance" || panel == "practice") && !wishes.view.log.empty())
    return fail("--panel " + panel + " is of a live house; leave out the log");
  if (wishes.view.log.empty() && (wishes.view.moments.film || !wishes.view.beats.empty()))
    return fail("--film and --beats need a recorded house: dance view LOG");
  if (wishes.compare && wishes.view.view != ViewMode::kOrbit &&
      wishes.view.view != ViewMode::kCompare)
    return fail("--compare is --view compare; give one view");
  if (wishes.compare) wishes.view.view = ViewMode::kCompare;
  if (wishes.display_latency_ms >= 0.0)
    wishes.view.display_latency = Duration::seconds(1e-3 * wishes.display_latency_ms);
  wishes.view.extrapolates = !wishes.no_extrapolation;
  wishes.view.late_latching = !wishes.early;
  if (!wishes.place.empty()) wishes.view.place = parse_place(wishes.place);
  if (!wishes.focus.empty()) wishes.view.focus = GuestId::parse(wishes.focus);
  for (const std::string& text : wishes.avatars) {
    DANCE_TRY(AvatarOverride avatar, parse_avatar_override(text, data_folder() + "/avatars"));
    wishes.view.avatars.push_back(std::move(avatar));
  }
  if (wishes.view.headless) wishes.view.hud = !wishes.no_hud;
  wishes.view.tags = !wishes.no_tags;
  return {};
}

Result<void> run(ViewOptions& view) {
  std::optional<RecordingLog> log;
  if (!view.log.empty()) {
    DANCE_TRY(log, RecordingLog::open(view.log));
    for (const std::string& note : log->notes()) talk::info("{}: {}", view.log, note);
    if (!log->lost().empty() && view.export_to.empty())
      talk::warn("{}: damaged: {}; the rest is shown", view.log, log->lost());
    if (log->is_made()) view.made_log = log->path();
  }
  if (!view.export_to.empty()) {
    auto exported = run_export(view);
    if (!exported || !log || log->lost().empty()) return exported;
    return fail(view.log + ": damaged: " + log->lost() + "; " + view.export_to +
                " holds all the rest");
  }
  return view.headless ? run_headless(view) : run_window(view);
}

}  // namespace
}  // namespace dance

int main(int argc, char** argv) {
  dance::Wishes wishes;
  dance::CommandLine line("Shows the stage of this house, in a window or as pictures.",
                          "dance view");
  dance::add_options(line, wishes);
  line.finally([&] { return dance::finish(wishes); });
  return dance::run_program(line, argc, argv, [&] { return dance::run(wishes.view); });
}
