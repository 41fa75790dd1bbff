// dance capture several drawn: two webcams that are drawn, before the real pose network.
#include <fmt/format.h>

#include <cstdio>

#include "core/program/command_line.h"
#include "core/program/program.h"
#include "research/capture/drawn/drawn_views.h"

namespace dance {
namespace {

constexpr const char* kSeveralDrawnExamples = R"(Examples:
  dance capture several drawn
  dance capture several drawn salsa.bvh.xz --seconds 25 --around 90
  dance capture several drawn salsa.bvh.xz --keep out/drawn
  dance capture out/drawn/first --also out/drawn/second --height 1.65 --json
)";

Result<void> run(const DrawnWishes& wishes, bool is_json) {
  DANCE_TRY(const DrawnStage drawn, draw_stage(wishes));
  SeveralCase what;
  what.name =
      fmt::format("drawn, {:g} degrees apart, seen in {:.0f} % of the pictures, {:.2f} m tall",
                  wishes.around_deg, drawn.seen_percent, drawn.stage.first.height_m);
  what.around_deg = wishes.around_deg;
  what.distance_m = wishes.distance_m;
  what.later_ms = wishes.later_ms;
  const std::vector<SeveralScore> scores{evaluate_stages(what, {drawn.stage})};
  const std::string text = is_json ? several_json(scores) : several_table(scores);
  std::fwrite(text.data(), 1, text.size(), stdout);
  return {};
}

}  // namespace
}  // namespace dance

int main(int argc, char** argv) {
  dance::DrawnWishes wishes;
  bool is_json = false;
  dance::CommandLine line(
      "A recorded dance drawn as two webcams see it, before the real pose network: what two know, "
      "and what one knows.",
      "dance capture several drawn");
  line.add("FILE", wishes.take,
           "a recorded dance, BVH, also packed with xz; else the salsa dancer");
  line.add("--seconds", wishes.seconds, "of it").range(5.0, 600.0).shows_default();
  line.add("--distance", wishes.distance_m, "metres from both cameras to the middle of the dance")
      .range(1.5, 8.0)
      .shows_default();
  line.add("--around", wishes.around_deg, "degrees between the cameras")
      .range(-170.0, 170.0)
      .shows_default();
  line.add("--later", wishes.later_ms, "milliseconds that the second camera's stamps are late")
      .range(-150.0, 150.0)
      .shows_default();
  line.add("--guest", wishes.guest, "whose looks the dancer has").guest_name().shows_default();
  line.add("--keep", wishes.folder,
           "keeps the pictures in this folder; those that are there are not drawn again");
  line.add_choice<dance::PoseNetworkModel>("--model", wishes.model,
                                           {{"lite", dance::PoseNetworkModel::kLite},
                                            {"full", dance::PoseNetworkModel::kFull},
                                            {"heavy", dance::PoseNetworkModel::kHeavy}},
                                           "size of the pose network");
  line.add_flag("--json", is_json, "JSON on stdout");
  line.footer(dance::kSeveralDrawnExamples);
  return dance::run_program(line, argc, argv, [&] { return dance::run(wishes, is_json); });
}
