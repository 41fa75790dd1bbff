// dance-bench-view: what a picture of a full stage costs, beside the empty one.

#include <cstdio>

#include "bench/view/bench_view.h"
#include "core/program/program.h"
#include "viewer/program/view_options.h"

namespace dance {
namespace {

constexpr const char* kExamples = R"(Examples:
  dance bench view                                       30 mannequins beside the empty stage
  dance bench view --avatar dancer.vrm --json            and 30 times that avatar
  dance bench view --stereo --size 1440x1600             and for both eyes of a headset
  dance bench view --places --guests 2 --size 640x360 --quality low
                                                         a couple in each place, and without
  dance bench view --size 640x360 --quality low          as on a computer without a graphics card
Pictures of all rows are drawn in turn; each counts until the card has finished it.
)";

struct Wishes {
  BenchViewOptions bench;
  std::string size = "1280x720";
  bool is_json = false;
};

Result<void> finish(Wishes& wishes) {
  DANCE_TRY(const ViewPictureSize size, parse_size(wishes.size));
  wishes.bench.width_px = size.width_px;
  wishes.bench.height_px = size.height_px;
  if (wishes.bench.places && (wishes.bench.stereo || !wishes.bench.avatar.empty()))
    return fail("--places takes no --stereo and no --avatar; measure them without it");
  return {};
}

Result<void> run(const Wishes& wishes) {
  DANCE_TRY(const BenchViewResult result, run_bench_view(wishes.bench));
  const std::string text = wishes.is_json ? bench_view_json(wishes.bench, result)
                                          : bench_view_table(wishes.bench, result);
  std::fputs(text.c_str(), stdout);
  return {};
}

}  // namespace
}  // namespace dance

int main(int argc, char** argv) {
  dance::Wishes wishes;
  dance::BenchViewOptions& bench = wishes.bench;
  dance::CommandLine line("What a picture of a full stage costs, beside the empty one.",
                          "dance bench view");
  line.add("--guests", bench.guests, "dancers on the stage").range(1, 200).shows_default();
  line.add("--avatar", bench.avatar, "a .glb or .vrm that all of them wear, in a row of its own");
  line.add("--size", wishes.size, "of the pictures").shows_default();
  line.add_choice<dance::Quality>("--quality", bench.quality,
                                  {{"low", dance::Quality::kLow}, {"high", dance::Quality::kHigh}},
                                  "low or high");
  line.add_flag("--places", bench.places,
                "instead: the guests in each place, and the ratio to the plain stage");
  line.add_flag("--stereo", bench.stereo,
                "a row more for each, of both eyes of a headset, each of that size");
  line.add("--seconds", bench.seconds, "how long to measure").range(0.1, 3600.0).shows_default();
  line.add("--picture", bench.picture, "also writes the last picture, as this PNG file");
  line.add_flag("--json", wishes.is_json, "one JSON object instead of the table");
  line.footer(dance::kExamples);
  line.finally([&] { return dance::finish(wishes); });
  return dance::run_program(line, argc, argv, [&] { return dance::run(wishes); });
}
