// dance codec eval: the pose codec on recorded dances.
#include <cstdio>
#include <iterator>

#include "core/program/command_line.h"
#include "core/program/program.h"
#include "core/program/talk.h"
#include "formats/bvh/clip_file.h"
#include "research/codec/codec_eval.h"
#include "research/codec/codec_plot.h"
#include "testing/line/lossy_spec.h"

namespace dance {
namespace {

constexpr const char* kExamples = R"(Examples:
  dance codec eval salsa.bvh
  dance codec eval *.bvh.xz --hz 30 --quality 2 --json
  dance codec eval salsa.bvh --loss 5 --rtt 67ms
  dance codec eval salsa.bvh --plot bytes-over-error.svg
  dance codec eval *.bvh.xz --room 30 --loss 1 --rtt 67ms
)";

struct Wishes {
  std::vector<std::string> files;
  CodecEvalOptions eval;
  double quality_mm = 1.0;
  double loss_percent = -1.0;
  std::uint32_t room = 0;
  double room_s = 8.0;
  std::string rtt = "67ms";
  std::string model;
  std::string plot;
  bool generic = false;
  bool json = false;
};

Result<std::shared_ptr<const PoseModel>> choose_model(const Wishes& wishes) {
  if (wishes.generic) return generic_model();
  if (wishes.model.empty()) return built_in_model();
  DANCE_TRY(const std::string file, read_clip_text(wishes.model, 1 << 24));
  auto model = read_model({reinterpret_cast<const std::uint8_t*>(file.data()), file.size()});
  if (!model) return fail(wishes.model + ": " + model.error().what);
  return model;
}

Result<void> run(Wishes wishes) {
  DANCE_TRY(wishes.eval.model, choose_model(wishes));
  wishes.eval.error_m = wishes.quality_mm * 1e-3;
  if (wishes.loss_percent >= 0.0) wishes.eval.loss_percent = wishes.loss_percent;
  DANCE_TRY(const LossySpec line, LossySpec::parse("delay=" + wishes.rtt));
  wishes.eval.round_trip = line.delay;
  wishes.eval.room_guests = wishes.room;
  wishes.eval.room_time = Duration::seconds(wishes.room_s);
  DANCE_TRY(const std::vector<CodecTake> takes,
            load_codec_takes(wishes.files, wishes.eval.hz, wishes.eval.jitter_deg));
  const CodecEval result = evaluate_codec(takes, wishes.eval);
  const std::string text =
      wishes.json ? codec_eval_json(result, wishes.eval) : codec_eval_table(result, wishes.eval);
  std::fwrite(text.data(), 1, text.size(), stdout);
  if (wishes.plot.empty()) return {};
  return draw_rate_plot(measure_rates(takes, wishes.eval, result), wishes.plot);
}

}  // namespace
}  // namespace dance

int main(int argc, char** argv) {
  dance::Wishes wishes;
  dance::CommandLine line("The pose codec on recorded dances: bytes, errors, times, losses.",
                          "dance codec eval");
  line.add("FILE", wishes.files, "BVH files, also packed with xz").required();
  line.add("--hz", wishes.eval.hz, "frames a second").range(1.0, 240.0).shows_default();
  line.add("--quality", wishes.quality_mm, "millimetres that no joint is off by more")
      .range(0.125, 20.0)
      .shows_default();
  line.add("--jitter", wishes.eval.jitter_deg,
           "degrees that each bone trembles by, as cameras see it")
      .range(0.0, 10.0);
  line.add("--loss", wishes.loss_percent,
           "percent that a line loses in each direction: adds the table of policies")
      .range(0.0, 90.0);
  line.add("--rtt", wishes.rtt,
           "round trip of that line; of a room: from one dancer to another and back")
      .shows_default();
  line.add("--room", wishes.room,
           "how many dance in a room, through the tunnel's own server and links: adds what that "
           "costs. Each house's "
           "line to the server loses what --loss says, in each direction, so that a pose passes "
           "two that lose")
      .range(2.0, 64.0);
  line.add("--seconds", wishes.room_s, "of the room's dance that are measured")
      .range(1.0, 600.0)
      .shows_default();
  line.add("--model", wishes.model, "a model of dance codec train instead of the built-in one");
  line.add("--plot", wishes.plot,
           "an SVG picture: bytes over errors of 0.25 to 5 mm, whatever --quality says");
  line.add_flag("--generic", wishes.generic, "the model that was never trained");
  line.add_flag("--json", wishes.json, "one JSON object on stdout");
  line.footer(dance::kExamples);
  return dance::run_program(line, argc, argv, [&] { return dance::run(wishes); });
}
