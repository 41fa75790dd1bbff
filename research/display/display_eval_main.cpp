// dance display eval: extrapolation to the photon on recorded dances.
#include <cstdio>

#include "core/program/command_line.h"
#include "core/program/program.h"
#include "research/display/display_eval.h"

namespace dance {
namespace {

constexpr const char* kExamples = R"(Examples:
  dance display eval salsa.bvh
  dance display eval *.bvh.xz --noise 0.2 --json
)";

struct Wishes {
  std::vector<std::string> files;
  DisplayEvalOptions options;
  bool is_json = false;
};

Result<void> run(const Wishes& wishes) {
  std::vector<DisplayTake> takes;
  for (const std::string& file : wishes.files) {
    DANCE_TRY(DisplayTake take, load_display_take(file, wishes.options.hz));
    takes.push_back(std::move(take));
  }
  const DisplayEval eval = evaluate_display(takes, wishes.options);
  const std::string text = wishes.is_json ? display_eval_json(eval, wishes.options)
                                          : display_eval_table(eval, wishes.options);
  std::fputs(text.c_str(), stdout);
  return {};
}

}  // namespace
}  // namespace dance

int main(int argc, char** argv) {
  dance::Wishes wishes;
  dance::CommandLine line("Extrapolation to the photon on recorded dances: errors beside holding.",
                          "dance display eval");
  line.add("FILE", wishes.files, "BVH files, also packed with xz").required();
  line.add("--hz", wishes.options.hz, "poses a second that are heard")
      .range(10.0, 240.0)
      .shows_default();
  line.add("--horizons", wishes.options.horizons_ms, "milliseconds to the light, with commas")
      .split_at(',')
      .range(1.0, 90.0);
  line.add("--noise", wishes.options.noise_deg,
           "degrees that each bone trembles by about each axis, as sensors do")
      .range(0.0, 10.0);
  line.add_flag("--json", wishes.is_json, "one JSON object on stdout");
  line.footer(dance::kExamples);
  return dance::run_program(line, argc, argv, [&] { return dance::run(wishes); });
}
