// dance capture several eval: what two webcams know that nobody placed, calibrated or synchronised.
#include <cstdio>

#include "core/program/command_line.h"
#include "core/program/program.h"
#include "research/capture/several_eval.h"

namespace dance {
namespace {

constexpr const char* kSeveralEvalExamples = R"(Examples:
  dance capture several eval *.bvh.xz
  dance capture several eval *.bvh.xz --case 0 --distance 4
  dance capture several eval *.bvh.xz --json
  hips       the middle of the hips along the first camera's view, mean and 95 of 100
  joints     shoulders, elbows, wrists, hips, knees, ankles, along the same view
  relative   joints in space, the middle of the hips removed
  absolute   joints in space before the first camera
  step       how much further than the truth the hips move from picture to picture, 99 of 100
  gain       the error of the hips' depth of one camera, and of one that is told the dancer's
             height, over this one
All from two seconds after the second camera was placed on.
)";

struct SeveralWishes {
  std::vector<std::string> files;
  int which = -1;
  double distance_m = 3.0;
  bool is_exact = false;
  bool keeps_bodies = false;
  bool is_json = false;
};

Result<void> run(const SeveralWishes& wishes) {
  DANCE_TRY(const std::vector<CodecTake> takes, load_codec_takes(wishes.files, 120.0));
  std::vector<SeveralScore> scores;
  std::vector<SeveralCase> cases = several_cases();
  for (std::size_t i = 0; i < cases.size(); ++i) {
    if (wishes.which >= 0 && static_cast<std::size_t>(wishes.which) != i) continue;
    cases[i].distance_m = wishes.distance_m;
    cases[i].is_exact = wishes.is_exact;
    cases[i].keeps_bodies = wishes.keeps_bodies;
    scores.push_back(evaluate_several(cases[i], takes));
  }
  const std::string text = wishes.is_json ? several_json(scores) : several_table(scores);
  std::fwrite(text.data(), 1, text.size(), stdout);
  return {};
}

}  // namespace
}  // namespace dance

int main(int argc, char** argv) {
  dance::SeveralWishes wishes;
  dance::CommandLine line(
      "Two webcams without a board, on recorded dances before simulated cameras, beside one.",
      "dance capture several eval");
  line.add("FILE", wishes.files, "recorded dances, BVH, also packed with xz").required();
  line.add("--case", wishes.which, "only this one, counted from 0; -1 = all")
      .range(-1, 100)
      .shows_default();
  line.add("--distance", wishes.distance_m, "metres from both cameras to the middle of the dance")
      .range(1.5, 8.0)
      .shows_default();
  line.add_flag("--exact", wishes.is_exact, "networks without errors");
  line.add_flag("--own-bodies", wishes.keeps_bodies,
                "of the takes' own bodies, instead of bodies that differ as adults do");
  line.add_flag("--json", wishes.is_json, "JSON on stdout");
  line.footer(dance::kSeveralEvalExamples);
  return dance::run_program(line, argc, argv, [&] { return dance::run(wishes); });
}
