#include "apps/demo/demo_pictures.h"

#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "apps/demo/sway_plot.h"
#include "core/program/child_process.h"
#include "core/program/program.h"
#include "core/program/talk.h"

namespace dance {
namespace {

namespace fs = std::filesystem;

constexpr double kPlot_beats = 16.0;
constexpr Duration kFilmTimeout =
    Duration::s(3600);  // a film takes some seconds for each of the dance

Result<void> run_viewer(const DemoOptions& options, const DemoPlan& plan, const std::string& name,
                        const std::vector<std::string>& more) {
  ChildProcess::Options how;
  how.program = program_folder() + "/dance-view";
  how.arguments = {"--headless", "--log", plan.log_file, "--compare"};
  how.arguments.insert(how.arguments.end(), more.begin(), more.end());
  how.output_file = programs_folder(options) + "/" + name + ".json";
  how.talk_file = programs_folder(options) + "/" + name + ".txt";
  DANCE_TRY(ChildProcess viewer, ChildProcess::start(how));
  if (viewer.wait(kFilmTimeout) && viewer.ended_well()) return {};
  std::ostringstream talk;
  talk << std::ifstream(how.talk_file).rdbuf();
  return fail("the " + name + " was not drawn: " + talk.str());
}

Result<std::string> draw_strip(const DemoOptions& options, const DemoPlan& plan,
                               const DemoTrace& trace) {
  std::string beats;
  for (const double beat : beats_to_show(trace))
    beats += fmt::format("{}{:.0f}", beats.empty() ? "" : ",", beat);
  if (beats.empty()) return std::string();
  if (auto drawn = run_viewer(
          options, plan, "strip",
          {"--beats=" + beats, "--strip", "6", "--size", "1440x400", "--out", options.out});
      !drawn)
    return tl::make_unexpected(drawn.error());
  return options.out + "/stage-strip.png";
}

Result<std::string> draw_film(const DemoOptions& options, const DemoPlan& plan) {
  const std::string folder = options.out + "/film";
  std::error_code error;
  fs::remove_all(folder, error);  // of the last demo
  talk::info("draws the film");
  if (auto drawn = run_viewer(options, plan, "film",
                              {"--film", "--seconds", fmt::format("{}", options.seconds), "--size",
                               "1280x720", "--out", folder});
      !drawn)
    return tl::make_unexpected(drawn.error());
  talk::info("a video of it: ffmpeg -framerate 25 -i {0}/%04d.png -pix_fmt yuv420p {0}.mp4",
             folder);
  return folder;
}

}  // namespace

Result<DemoPictures> draw_comparison(const DemoOptions& options, const DemoPlan& plan,
                                     const DemoTrace& trace, const DemoRhythm& rhythm) {
  DemoPictures pictures;
  DANCE_TRY(pictures.strip, draw_strip(options, plan, trace));
  if (auto lines = sway_lines(trace, kPlot_beats)) {
    const std::string file = options.out + "/sway.png";
    const SwayPlot plot{std::move(*lines), rhythm, std::string(trace.here().view()),
                        std::string(trace.remote().view())};
    if (auto drawn = write_sway_plot(file, plot); !drawn) return tl::make_unexpected(drawn.error());
    pictures.sway = file;
  }
  if (options.film) {
    DANCE_TRY(pictures.film, draw_film(options, plan));
  }
  return pictures;
}

}  // namespace dance
