// dance trackers eval: whole bodies from few tracked points, on recorded dances.
#include <cstdio>

#include "core/program/command_line.h"
#include "core/program/program.h"
#include "research/trackers/standing_take.h"
#include "research/trackers/tracker_model_file.h"
#include "research/trackers/trackers_eval.h"
#include "research/trackers/trackers_show.h"

namespace dance {
namespace {

constexpr const char* kTrackersEvalExamples = R"(Examples:
  dance trackers eval *.bvh.xz
  dance trackers eval other/*.bvh.xz --model body.model
  dance trackers eval --standing 4
  dance trackers eval salsa.bvh --show tracked.lcm
  dance view --log tracked.lcm --camera front

Devices are simulated: each is worn a little elsewhere, and measured with noise; the solver finds
out by a T-pose as people stand in one. The built-in model knows the takes of the project: one of
dance trackers train without some takes is to be judged on those.
)";

struct TrackersEvalWishes {
  std::vector<std::string> files;
  std::string model, show;
  int standing = 0;
  TrackerEvalOptions options;
};

Result<void> run_trackers_eval(TrackersEvalWishes& wishes) {
  wishes.options.model = built_in_tracker_model();
  if (!wishes.model.empty()) {
    DANCE_TRY(wishes.options.model, read_tracker_model_file(wishes.model));
  }
  std::vector<PredictTake> takes;
  for (const std::string& file : wishes.files) {
    DANCE_TRY(PredictTake take, load_predict_take(file, 60.0));
    takes.push_back(std::move(take));
  }
  // Others than training makes.
  Random random(wishes.options.seed + 1000);
  for (int i = 0; i < wishes.standing; ++i)
    takes.push_back(
        standing_take(static_cast<float>(random.uniform(1.62, 1.86)), 60.0, 40.0, random));
  if (takes.empty()) return fail("name a FILE, or judge made takes with --standing 2");
  if (!wishes.show.empty()) return show_trackers(takes.front(), wishes.options, wishes.show);
  std::vector<TrackerTrial> trials;
  for (const int points : {3, 4, 6, 10})
    for (const TrackerGuide guide : {TrackerGuide::kGeometric, TrackerGuide::kLearned})
      trials.push_back({points, guide, TrackerStart::kTPose});
  for (const int points : {3, 6})
    trials.push_back({points, TrackerGuide::kLearned, TrackerStart::kDancing});
  const auto scores = evaluate_trackers(takes, trials, wishes.options);
  std::fputs(trackers_eval_table(trials, scores).c_str(), stdout);
  return {};
}

}  // namespace
}  // namespace dance

int main(int argc, char** argv) {
  dance::TrackersEvalWishes wishes;
  dance::CommandLine line("whole bodies from few tracked points, on recorded dances",
                          "dance trackers eval");
  line.add("FILE", wishes.files, "BVH files, also packed with xz");
  line.add("--standing", wishes.standing,
           "made takes, of 40 s, of somebody who stands about and walks a few steps")
      .range(0, 64)
      .shows_default();
  line.add("--hz", wishes.options.hz, "frames a second of the devices")
      .range(20.0, 500.0)
      .shows_default();
  line.add("--model", wishes.model, "a model of dance trackers train instead of the built-in one");
  line.add("--show", wishes.show,
           "no table, but a log of the first file: danced, by rules, and learned, side by side");
  line.add("--seed", wishes.options.seed, "another number draws other bodies and devices")
      .shows_default();
  line.footer(dance::kTrackersEvalExamples);
  return dance::run_program(line, argc, argv, [&] { return dance::run_trackers_eval(wishes); });
}
