// dance capture eval: the points of the body that the pose network sees in pictures and videos.
#include <cstdio>

#include "core/program/command_line.h"
#include "core/program/program.h"
#include "research/capture/capture_eval.h"

namespace dance {
namespace {

constexpr const char* kExamples = R"(Examples:
  dance capture eval dance.mp4
  dance capture eval *.jpg --model heavy --json
  dance capture eval dance.mp4 --compare-engines
  dance capture eval crowd.mp4 --follow 640,360
  dance capture eval dance.mp4 --lose 100
  dance capture eval dance.mp4 --hands
  dance capture eval couple.mp4 --people 2 --json
)";

struct Wishes {
  std::vector<std::string> files;
  CaptureEvalOptions eval;
  std::string follow = "surest";
  bool json = false;
  std::uint64_t lost_frame = 0;
};

Result<void> set_follow(const std::string& text, FollowOptions& follow) {
  if (text == "surest") {
    // As the original does: nobody is remembered, and no jump is refused.
    follow.reacquire_time = Duration{};
    follow.refuses_jumps = follow.watches_others = false;
    return {};
  }
  if (text == "largest") {
    follow.choice = FollowOptions::Choice::kLargest;
    return {};
  }
  float x = 0.0f, y = 0.0f;
  char rest = 0;
  if (std::sscanf(text.c_str(), "%f,%f%c", &x, &y, &rest) != 2)  // NOLINT(cert-err34-c)
    return fail("--follow takes surest, largest, or a place in pixels: 640,360");
  follow.choice = FollowOptions::Choice::kNearest;
  follow.place_px = {x, y};
  return {};
}

Result<void> compare_losses(Wishes wishes) {
  for (const std::string& file : wishes.files) {
    wishes.eval.lost_frame.reset();
    DANCE_TRY(const CaptureRun whole, evaluate_capture({file}, wishes.eval));
    wishes.eval.lost_frame = wishes.lost_frame;
    DANCE_TRY(const CaptureRun lost, evaluate_capture({file}, wishes.eval));
    const LossComparison after =
        compare_after_loss(lost, whole, wishes.lost_frame / wishes.eval.every);
    if (after.frames == 0)
      return fail(file + ": nobody is seen in the 20 frames after frame " +
                  std::to_string(wishes.lost_frame) + "; choose another --lose");
    std::printf(
        "%s: metres in %d frames after black frame %llu: %.1f mm from a smoother that "
        "goes on, %.1f mm from one that begins anew, %.1f mm from an uninterrupted run\n",
        file.c_str(), after.frames, static_cast<unsigned long long>(wishes.lost_frame),
        after.from_continued_mm, after.from_begun_anew_mm, after.from_uninterrupted_mm);
  }
  return {};
}

// Of several dancers each is told apart from the others: nobody is chosen, and what compares with
// the original, which sees one, has nothing to compare with.
Result<void> several_fit(const Wishes& wishes) {
  const char* of_one = wishes.follow != "surest"      ? "--follow"
                       : wishes.lost_frame > 0        ? "--lose"
                       : wishes.eval.compares_engines ? "--compare-engines"
                                                      : nullptr;
  if (of_one == nullptr) return {};
  return fail(std::string(of_one) + " is for one dancer: leave it out, or --people");
}

Result<void> run(Wishes wishes) {
  // Every frame is searched, however long nobody was there: nothing here is in real time.
  wishes.eval.estimator.search_interval = Duration{};
  if (wishes.lost_frame % wishes.eval.every != 0)
    return fail("--lose " + std::to_string(wishes.lost_frame) + ": not seen with --every " +
                std::to_string(wishes.eval.every) + "; choose a multiple of that");
  if (wishes.eval.people > 1)
    if (auto fits = several_fit(wishes); !fits) return fits;
  if (wishes.lost_frame > 0) return compare_losses(wishes);
  wishes.eval.judges_hands = !wishes.json;
  DANCE_TRY(const CaptureRun run, evaluate_capture(wishes.files, wishes.eval));
  const std::string text =
      wishes.json ? capture_eval_json(run) : capture_eval_table(run, wishes.eval);
  std::fwrite(text.data(), 1, text.size(), stdout);
  return {};
}

}  // namespace
}  // namespace dance

int main(int argc, char** argv) {
  using dance::EngineKind;
  using dance::PoseNetworkModel;
  dance::Wishes wishes;
  dance::EstimatorOptions& estimator = wishes.eval.estimator;
  dance::CommandLine line(
      "The points of the body that the pose network sees in pictures and videos.",
      "dance capture eval");
  line.add("IMAGE_OR_VIDEO", wishes.files,
           "pictures, each for itself, and videos, whose frames follow each other")
      .required();
  line.add_choice<PoseNetworkModel>("--model", estimator.model,
                                    {{"lite", PoseNetworkModel::kLite},
                                     {"full", PoseNetworkModel::kFull},
                                     {"heavy", PoseNetworkModel::kHeavy}},
                                    "the network (default full)");
  line.add_choice<EngineKind>("--engine", estimator.engine,
                              {{"xnnpack", EngineKind::kXnnpack}, {"opencv", EngineKind::kOpenCv}},
                              "what it runs on (default: xnnpack where it is built in)");
  line.add("--models", estimator.models_folder,
           "the folder of the networks (default: as dance capture)");
  line.add("--follow", wishes.follow,
           "of several people: surest (as the original does), largest, or the one nearest to a "
           "place in pixels, 640,360")
      .shows_default();
  line.add("--people", wishes.eval.people,
           "how many dancers, numbered from the left in the first picture; of two and more the "
           "points are not smoothed")
      .range(1, dance::kMostDancers)
      .shows_default();
  line.add("--every", wishes.eval.every, "n-th frame of videos").range(1, 100000).shows_default();
  line.add_choice<bool>("--smooth", estimator.smooths, {{"on", true}, {"off", false}},
                        "frames of a video, as the original does (default on)");
  line.add_flag("--hands", wishes.eval.sees_hands, "the points of the hands, too");
  line.add_flag("--face", wishes.eval.sees_face, "the points of the face, too");
  line.add("--sequence", wishes.eval.sequence_hz,
           "pictures are the frames of one video of so many a second; 0: each for itself")
      .range(0.0, 1000.0)
      .shows_default();
  line.add_flag("--compare-engines", wishes.eval.compares_engines,
                "runs the other engine on the same regions, too");
  line.add("--lose", wishes.lost_frame,
           "makes this frame of videos black, and says what the smoother of metres does in the 20 "
           "after it")
      .range(1, 1000000);
  line.add_flag("--json", wishes.json, "one JSON object on stdout");
  line.footer(dance::kExamples);
  line.finally([&] { return dance::set_follow(wishes.follow, estimator.follow); });
  return dance::run_program(line, argc, argv, [&] { return dance::run(wishes); });
}
