// dance predict stream: dances over a line with delay, jitter and loss, and what a stage shows of
// them.
#include <cstdio>

#include "core/program/command_line.h"
#include "core/program/program.h"
#include "research/lapse/predict_stream.h"
#include "research/predict_model_file.h"
#include "transformers/settings.h"

namespace dance {
namespace {

constexpr const char* kStreamExamples = R"(Examples:
  dance predict stream salsa.bvh
  dance predict stream *.bvh.xz --delay 200ms --jitter 30ms --loss 5
  dance predict stream salsa.bvh --through "hold" "hold,bridge"
  raw       the newest pose that came, as it came
  error     mean distance of the joints from the dance now, the hips' place and rotation removed
  lag       the shift in time that fits best;  of raw: against the newest pose
  jerk      third difference of the joints' places, the dance's own is 1
  feet      how fast feet slide while they stand, the dance's own is 1
)";

struct Wishes {
  std::vector<std::string> files;
  std::string delay = "100ms", jitter = "15ms";
  double loss_percent = 1.0;
  std::uint64_t seed = 1;
  std::size_t every = 1;
  std::vector<std::string> through{"hold", "predict", "predict,bridge"};
  std::string model;
  bool is_json = false;
};

Result<void> run(const Wishes& wishes) {
  StreamOptions options;
  DANCE_TRY(options.delay, parse_duration(wishes.delay));
  DANCE_TRY(options.jitter, parse_duration(wishes.jitter));
  if (options.delay < Duration() || options.delay > Duration::s(1) || options.jitter < Duration() ||
      options.jitter > Duration::s(1))
    return fail("a line with --delay " + wishes.delay + " --jitter " + wishes.jitter +
                " cannot be judged: 0ms to 1s, please");
  options.loss_percent = wishes.loss_percent;
  options.seed = wishes.seed;
  options.every = wishes.every;
  NamedSubjects subjects{
      {"raw", newest_subject()},
      {"damped velocity", damped_velocity_subject()},
      {"damped velocity, inertialised", damped_velocity_subject(Duration::ms(60))}};
  DANCE_TRY(const FlowParts parts, parts_with_model(wishes.model));
  if (auto added = add_flow_subjects(wishes.through, subjects, parts); !added)
    return tl::make_unexpected(added.error());
  DANCE_TRY(const std::vector<CodecTake> takes, load_codec_takes(wishes.files, 60.0));
  std::vector<StreamRow> rows;
  for (const auto& subject : subjects)
    rows.push_back({subject.first, evaluate_stream(takes, subject.second, options)});
  if (rows.front().figures.seconds <= 0.0)
    return fail("the takes are too short: at least 6 s are needed");
  const std::string text = wishes.is_json ? stream_json(rows) : stream_table(rows);
  std::fwrite(text.data(), 1, text.size(), stdout);
  return {};
}

}  // namespace
}  // namespace dance

int main(int argc, char** argv) {
  dance::Wishes wishes;
  dance::CommandLine line("Dances over a line with delay, jitter and loss: what a stage shows.",
                          "dance predict stream");
  line.add("FILE", wishes.files, "BVH files, also packed with xz").required();
  line.add("--delay", wishes.delay, "of the line").shows_default();
  line.add("--jitter", wishes.jitter, "mean of what is added to it").shows_default();
  line.add("--loss", wishes.loss_percent, "percent of the poses that never come")
      .range(0.0, 90.0)
      .shows_default();
  line.add("--every", wishes.every, "only each so many-th pose is sent: 2 is a camera of 30 Hz")
      .range(1.0, 12.0)
      .shows_default();
  line.add("--seed", wishes.seed, "another draw of the same line").shows_default();
  line.add("--through", wishes.through,
           "routes to judge: transformers as session files name them, with commas between");
  line.add("--model", wishes.model, "a model of dance predict train instead of the built-in one");
  line.add_flag("--json", wishes.is_json, "one JSON array on stdout");
  line.footer(dance::kStreamExamples);
  return dance::run_program(line, argc, argv, [&] { return dance::run(wishes); });
}
