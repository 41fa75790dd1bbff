// dance view: the stage of this house, in a window or as pictures.

#include <map>
#include <string>
#include <vector>

#include "core/program/program.h"
#include "viewer/view_program.h"

namespace dance {
namespace {

constexpr const char* kExamples =
    R"(In the window: drag turns the camera, the wheel comes nearer, right or shift drag moves it;
  F frames everybody, 1 to 9 one guest, space starts and stops the slow turn, H shows or hides the
  figures, Q quits.
Examples:
  dance view                                         who dances in this house
  dance view --focus alice --camera front
  dance view --headless --out pictures --at 2,5,8    three pictures, no display needed
  dance view --headless --out pictures --seconds 10 --every 0.5 --size 640x360
  dance view --headless --out pictures --seconds 2 --strip 6 --no-hud
  dance view --show capture                          only what this house's cameras see
)";

struct CommandLine {
  ViewOptions view;
  MomentWish moments;
  std::string size = "1280x720";
  std::string focus;
  bool no_hud = false;
  bool no_tags = false;
};

template <class T>
void add_choice(CLI::App& app, const char* name, T& value, std::map<std::string, T> choices,
                const char* what) {
  std::vector<std::string> words;
  for (const auto& choice : choices) words.push_back(choice.first);
  app.add_option_function<std::string>(
         name, [&value, choices](const std::string& word) { value = choices.at(word); }, what)
      ->check(CLI::IsMember(words));
}

void add_options(CLI::App& app, CommandLine& line) {
  ViewOptions& view = line.view;
  app.add_option("--bus", view.feed.bus_url, "LCM URL of the house's bus");
  add_choice<Shown>(app, "--show", view.feed.shown,
                    {{"best", Shown::kBest},
                     {"capture", Shown::kCapture},
                     {"guest", Shown::kGuest},
                     {"stage", Shown::kStage}},
                    "best (own guests straight from the capture, the others from the stage), "
                    "capture, guest or stage");
  app.add_flag("--stage-only", view.feed.stage_only, "own guests from the stage too");
  add_choice<CameraPreset>(app, "--camera", view.camera,
                           {{"auto", CameraPreset::kAuto},
                            {"front", CameraPreset::kFront},
                            {"side", CameraPreset::kSide},
                            {"top", CameraPreset::kTop},
                            {"orbit", CameraPreset::kOrbit}},
                           "auto (across the line of dancers), front, side, top or orbit");
  app.add_option("--focus", line.focus, "frame this guest");
  add_choice<QualityWish>(
      app, "--quality", view.quality,
      {{"auto", QualityWish::kAuto}, {"low", QualityWish::kLow}, {"high", QualityWish::kHigh}},
      "auto, low (no antialiasing, mirror image or fingers) or high");
  app.add_option("--size", line.size, "of window or pictures")->capture_default_str();
  app.add_flag("--no-hud", line.no_hud, "without the figures");
  app.add_flag("--no-tags", line.no_tags, "without names over heads");
  app.add_flag("--headless", view.headless, "no window: pictures in files, named on stdout");
  app.add_option("--out", view.out, "directory of the pictures")->capture_default_str();
  app.add_option("--seconds", line.moments.seconds, "headless: how long to listen; 3 unless said")
      ->check(CLI::Range(0.05, 86400.0));
  app.add_option("--at", line.moments.at_s, "headless: pictures at these seconds, as 2,5,8")
      ->delimiter(',')
      ->check(CLI::Range(0.0, 86400.0));
  app.add_option("--every", line.moments.every_s, "headless: a picture every so many seconds")
      ->check(CLI::Range(0.02, 86400.0));
  app.add_option("--strip", line.moments.strip,
                 "headless: so many moments side by side in stage-strip.png")
      ->check(CLI::Range(2, 24));
  app.footer(kExamples);
}

// What CLI11 cannot check by itself; wrong use, so said the way CLI11 says it.
void finish(CommandLine& line) {
  const auto refuse = [](const std::string& what) { throw CLI::ValidationError(what, 2); };
  const auto size = parse_size(line.size);
  if (!size) refuse(size.error().what);
  line.view.size = *size;
  const auto moments = plan_moments(line.moments);
  if (!moments) refuse(moments.error().what);
  line.view.moments_s = *moments;
  line.view.strip = line.moments.strip > 0;
  if (!line.focus.empty()) {
    line.view.focus = GuestId::parse(line.focus);
    if (!line.view.focus) refuse("--focus " + line.focus + ": " + kGuestIdRule);
  }
  line.view.hud = !line.no_hud;
  line.view.tags = !line.no_tags;
}

}  // namespace
}  // namespace dance

int main(int argc, char** argv) {
  dance::CommandLine line;
  CLI::App app{"Shows the stage of this house, in a window or as pictures.", "dance view"};
  dance::add_options(app, line);
  app.callback([&] { dance::finish(line); });
  return dance::run_program(app, argc, argv, [&] {
    return line.view.headless ? dance::run_headless(line.view) : dance::run_window(line.view);
  });
}
