// dance capture stereo eval: what two eyes know of a dancer's distance, on drawn dancers whose
// distance is known.
#include <cstdio>

#include "core/program/command_line.h"
#include "core/program/program.h"
#include "research/capture/stereo_eval.h"

namespace dance {
namespace {

constexpr const char* kStereoEvalExamples = R"(Examples:
  dance capture stereo eval
  dance capture stereo eval --frames 300 --json
  dance capture stereo eval salsa.bvh other.bvh.xz
  dance capture stereo eval --distance 6 --contrast 12
)";

struct StereoEvalWishes {
  std::vector<std::string> files;
  StereoEvalOptions options;
  double distance_m = 0.0;
  double contrast = 25.0;
  double image_px = 1.75;
  bool json = false;
};

Result<void> run(const StereoEvalWishes& wishes) {
  std::vector<StereoEvalCase> cases = stereo_eval_cases();
  if (wishes.distance_m > 0.0)
    cases = {{"asked", wishes.distance_m, wishes.contrast, wishes.image_px}};
  std::vector<CodecTake> takes;
  if (!wishes.files.empty()) {
    DANCE_TRY(takes, load_codec_takes(wishes.files, 60.0));
  }
  std::vector<StereoEval> evals;
  for (const StereoEvalCase& one : cases)
    evals.push_back(evaluate_stereo(one, wishes.options, takes));
  const std::string text = wishes.json ? stereo_eval_json(evals) : stereo_eval_table(evals);
  std::fwrite(text.data(), 1, text.size(), stdout);
  return {};
}

}  // namespace
}  // namespace dance

int main(int argc, char** argv) {
  dance::StereoEvalWishes wishes;
  dance::CommandLine line("Depth from two eyes, on drawn dancers whose distance is known.",
                          "dance capture stereo eval");
  line.add("FILE", wishes.files, "recorded dances, BVH (also .xz); without them the salsa dancer");
  line.add("--frames", wishes.options.frames, "of each case").range(1, 100000).shows_default();
  line.add("--dancers", wishes.options.dancers, "that share the frames")
      .range(1, 1000)
      .shows_default();
  line.add("--seed", wishes.options.seed, "other dancers, other noise").shows_default();
  line.add("--distance", wishes.distance_m, "one case, at so many metres").range(0.8, 15.0);
  line.add("--contrast", wishes.contrast, "of the clothes in that case, grey levels")
      .range(0.0, 60.0)
      .shows_default();
  line.add("--landmarks", wishes.image_px, "error of the network in that case, pixels")
      .range(0.0, 20.0)
      .shows_default();
  line.add_flag("--exact", wishes.options.is_calibration_exact, "a calibration without errors");
  line.add_flag("--json", wishes.json, "one JSON object on stdout");
  line.footer(dance::kStereoEvalExamples);
  return dance::run_program(line, argc, argv, [&] { return dance::run(wishes); });
}
