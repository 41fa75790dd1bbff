// dance lapse eval: dances whose poses stop for a while, and what is shown meanwhile.
#include <cstdio>

#include "core/program/command_line.h"
#include "core/program/program.h"
#include "research/lapse/lapse_eval_report.h"
#include "research/predict_model_file.h"
#include "transformers/settings.h"

namespace dance {
namespace {

constexpr const char* kLapseExamples = R"(Examples:
  dance lapse eval salsa.bvh
  dance lapse eval *.bvh.xz --lapses 250ms,1s,4s
  dance lapse eval salsa.bvh --through "predict,bridge" --json
  error     mean distance of the joints from the dance, the hips' place and rotation removed
  activity  mean speed of the joints meanwhile, the dancer's own is 1; body: relative to the hips
  start, wraps, return
            the fastest joint of all trials, the dancer's own fastest about there is 1
  drift     how far the hips go at most;  after: distance from the dance 300 ms after the return
)";

struct Wishes {
  std::vector<std::string> files;
  std::string lapses = "250ms,500ms,1s,2s,4s";
  std::vector<std::string> through;
  std::string model;
  bool is_json = false;
};

Result<std::vector<Duration>> parse_lapses(std::string_view text) {
  std::vector<Duration> lapses;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find(','), text.size());
    DANCE_TRY(const Duration lapse, parse_duration(text.substr(0, end)));
    if (lapse < Duration::ms(50) || lapse > Duration::s(20))
      return fail("a lapse of '" + std::string(text.substr(0, end)) +
                  "' cannot be judged: 50ms to 20s, please");
    lapses.push_back(lapse);
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  if (lapses.empty()) return fail("--lapses names no lapse: write some like 250ms,1s");
  return lapses;
}

Result<void> run(const Wishes& wishes) {
  DANCE_TRY(const std::vector<Duration> lapses, parse_lapses(wishes.lapses));
  NamedSubjects subjects{{"newest", newest_subject()}, {"continuation", continuation_subject()}};
  DANCE_TRY(const FlowParts parts, parts_with_model(wishes.model));
  if (auto added = add_flow_subjects(wishes.through, subjects, parts); !added)
    return tl::make_unexpected(added.error());
  DANCE_TRY(const std::vector<CodecTake> takes, load_codec_takes(wishes.files, 60.0));
  std::vector<LapseRow> rows;
  for (const Duration lapse : lapses)
    for (const auto& subject : subjects)
      rows.push_back({lapse, subject.first, evaluate_lapse(takes, subject.second, lapse)});
  if (rows.front().figures.trials == 0)
    return fail("the takes are too short: at least 7 s and the lapse are needed");
  const std::string text = wishes.is_json ? lapse_json(rows) : lapse_table(rows);
  std::fwrite(text.data(), 1, text.size(), stdout);
  return {};
}

}  // namespace
}  // namespace dance

int main(int argc, char** argv) {
  dance::Wishes wishes;
  dance::CommandLine line("Dances whose poses stop for a while: what is shown meanwhile.",
                          "dance lapse eval");
  line.add("FILE", wishes.files, "BVH files, also packed with xz").required();
  line.add("--lapses", wishes.lapses, "how long the poses stay away, one after the other")
      .shows_default();
  line.add("--through", wishes.through,
           "routes to judge too: transformers as session files name them, with commas between");
  line.add("--model", wishes.model, "a model of dance predict train instead of the built-in one");
  line.add_flag("--json", wishes.is_json, "one JSON array on stdout");
  line.footer(dance::kLapseExamples);
  return dance::run_program(line, argc, argv, [&] { return dance::run(wishes); });
}
