// dance rhythm eval: remote dancers on the listener's beat, on recorded dances.
#include <cstdio>

#include "core/program/command_line.h"
#include "core/program/program.h"
#include "producers/music/beats_file.h"
#include "research/predict_model_file.h"
#include "research/rhythm/rhythm_eval.h"
#include "research/rhythm/rhythm_eval_report.h"
#include "research/rhythm/steps_eval.h"
#include "research/rhythm/untagged_takes.h"
#include "transformers/settings.h"

namespace dance {
namespace {

constexpr const char* kExamples = R"(Examples:
  dance rhythm eval salsa.bvh --beats song.beats --delay 150ms
  dance rhythm eval *.bvh.xz --beats song.beats --delay 180ms --jitter 20ms --loss 2 --stall 400ms
  dance rhythm eval *.bvh.xz --beats song.beats --beta auto --json
  dance rhythm eval *.bvh.xz --beats song.beats --beta 0 --model kept.model
  dance rhythm eval --salsa 4 --beats song.beats --untagged --each
)";

constexpr Duration kSalsaLength = Duration::s(60);

struct Wishes {
  std::vector<std::string> files;
  RhythmEvalOptions eval;
  std::string beats, delay = "150ms", jitter = "0ms", stall = "0ms", beta = "auto", model;
  double strength = 1.0, salsa_bpm = 0.0;
  std::uint32_t salsa = 0;
  bool json = false, each = false, couples = false, learn_steps = false;
  std::vector<std::string> others;
};

// What steps alone tell, of the takes, of synthetic dancers, and of what does not dance.
Result<std::string> steps_told(const Wishes& wishes, const std::vector<UntaggedTake>& takes,
                               const std::vector<BeatDance>& dances, const BeatGrid& music) {
  const double music_bpm =
      music.tempo_bpm(music.first_beat() + 4.0) * (1.0 + wishes.eval.tempo_offset_percent / 100.0);
  const auto row_of = [&](const BeatDance& dance, const StepPattern& others) {
    const auto score = [&](const ToldBeats& told) { return steps_score(dance, told, music_bpm); };
    return StepsRow{dance.name, feet_stand_ms(dance, music_bpm),
                    score(told_by_period(dance, music_bpm)),
                    score(told_by_steps(dance, music_bpm, salsa_steps())),
                    score(told_by_steps(dance, music_bpm, others))};
  };
  std::vector<StepsRow> rows, none;
  for (std::size_t i = 0; i < dances.size(); ++i)
    rows.push_back(row_of(dances[i], i < takes.size() ? takes[i].others : salsa_steps()));
  for (std::size_t i = 0; i < takes.size(); ++i) {
    none.push_back(row_of(shuffled(dances[i], 1 + i), takes[i].others));
    none.back().name = "shuffled " + takes[i].take.name;
  }
  if (!dances.empty()) none.push_back(row_of(standing(dances[0], 1), salsa_steps()));
  for (const std::string& file : wishes.others) {
    DANCE_TRY(const CodecTake take, load_codec_take(file, wishes.eval.hz));
    none.push_back(row_of(lay_onto_beats(take, music, wishes.eval.hz), salsa_steps()));
  }
  return partners_table(takes) + steps_table(rows, none);
}

// Both dancers of a couple hear one music, and each has the other beside.
std::vector<BeatDance> couples_on_beats(const std::vector<UntaggedTake>& takes,
                                        const BeatGrid& music, double hz) {
  std::vector<std::shared_ptr<BeatDance>> laid;
  for (const UntaggedTake& take : takes)
    laid.push_back(std::make_shared<BeatDance>(lay_onto_beats(take.take, take.beats, music, hz)));
  std::vector<BeatDance> dances;
  for (std::size_t i = 0; i < takes.size(); ++i) {
    dances.push_back(*laid[i]);
    dances.back().partner = laid[takes[i].partner];
  }
  return dances;
}

Result<void> run(Wishes wishes) {
  // Steps have to be seen for a while before they tell a beat.
  if (wishes.eval.untagged) wishes.eval.warm_up = Duration::s(12);
  DANCE_TRY(wishes.eval.delay, parse_duration(wishes.delay));
  DANCE_TRY(wishes.eval.jitter, parse_duration(wishes.jitter));
  DANCE_TRY(wishes.eval.stall, parse_duration(wishes.stall));
  DANCE_TRY(const BeatGrid music, read_beats_file(wishes.beats));
  std::vector<BeatDance> dances;
  std::vector<UntaggedTake> takes;
  if (wishes.eval.untagged || wishes.learn_steps) {
    DANCE_TRY(takes, load_untagged_takes(wishes.files, wishes.couples, wishes.eval.hz));
    for (const UntaggedTake& take : takes)
      dances.push_back(lay_onto_beats(take.take, take.beats, music, wishes.eval.hz));
  } else if (wishes.couples) {
    DANCE_TRY(takes, load_untagged_takes(wishes.files, true, wishes.eval.hz));
    dances = couples_on_beats(takes, music, wishes.eval.hz);
    takes.clear();
  } else {
    for (const std::string& file : wishes.files) {
      DANCE_TRY(const CodecTake take, load_codec_take(file, wishes.eval.hz));
      dances.push_back(lay_onto_beats(take, music, wishes.eval.hz));
    }
  }
  for (std::uint32_t i = 0; i < wishes.salsa; ++i)
    dances.push_back(salsa_to_music(i % 2 == 0 ? SalsaRole::kLead : SalsaRole::kFollow, 1 + i / 2,
                                    wishes.salsa_bpm, kSalsaLength, music, wishes.eval.hz));
  if (wishes.learn_steps) {
    std::fputs(pattern_text(learn_from_all(takes, dances, music)).c_str(), stdout);
    return {};
  }
  if (dances.empty()) return fail("nobody dances: name BVH files, or --salsa 2");
  std::string rhythm = "rhythm beats=" + wishes.beta;
  if (wishes.strength < 1.0) rhythm += " strength=" + std::to_string(wishes.strength);
  DANCE_TRY(const FlowParts parts, parts_with_model(wishes.model));
  std::vector<NamedFlow> flows{
      {"raw", {}},
      {"hold", {"hold"}},
      {"predict", {"predict"}, parts},
      {"predict, bridge, " + rhythm, {"predict", "bridge", rhythm}, parts},
  };
  if (wishes.couples && !wishes.eval.untagged)
    flows.insert(flows.end() - 1,
                 {"the last without the partner", {"predict partner=0", "bridge", rhythm}, parts});
  std::vector<RhythmRun> runs;
  for (const NamedFlow& flow : flows) {
    DANCE_TRY(RhythmRun run, evaluate_rhythm(dances, music, flow, wishes.eval));
    runs.push_back(std::move(run));
  }
  std::string text =
      wishes.json ? rhythm_eval_json(dances, runs) : rhythm_eval_table(dances, runs, wishes.each);
  if (wishes.eval.untagged && !wishes.json) {
    DANCE_TRY(const std::string told, steps_told(wishes, takes, dances, music));
    text += told;
  }
  std::fwrite(text.data(), 1, text.size(), stdout);
  return {};
}

}  // namespace
}  // namespace dance

int main(int argc, char** argv) {
  dance::Wishes wishes;
  dance::CommandLine line("Remote dancers on the listener's beat, on recorded dances.",
                          "dance rhythm eval");
  line.add("FILE", wishes.files, "BVH files, also packed with xz");
  line.add("--salsa", wishes.salsa, "so many synthetic dancers as well").range(0.0, 64.0);
  line.add("--salsa-tempo", wishes.salsa_bpm,
           "at which they dance, whatever the music; 0: to the music")
      .range(0.0, 240.0);
  line.add("--beats", wishes.beats, "the song that is danced to: a .beats file").required();
  line.add("--delay", wishes.delay, "of the line, one way").shows_default();
  line.add("--jitter", wishes.jitter, "mean of what comes on top").shows_default();
  line.add("--loss", wishes.eval.loss_percent, "percent of poses that are lost").range(0.0, 90.0);
  line.add("--stall", wishes.stall, "once, in the middle, nothing comes for so long")
      .shows_default();
  line.add("--noise", wishes.eval.noise_deg,
           "degrees about each axis by which each bone trembles in each frame that is sent")
      .range(0.0, 10.0);
  line.add("--tempo-offset", wishes.eval.tempo_offset_percent,
           "percent by which the listener's music is faster")
      .range(-20.0, 20.0);
  line.add("--beta", wishes.beta, "beats of delay that the room wishes, or auto").shows_default();
  line.add("--strength", wishes.strength, "0 untouched to 1 on the beat")
      .range(0.0, 1.0)
      .shows_default();
  line.add("--model", wishes.model,
           "a model of dance predict train instead of the built-in one, which knows some takes");
  line.add("--every", wishes.eval.every,
           "only each so many-th pose is sent: 2 is a camera of 30 Hz")
      .range(1.0, 12.0)
      .shows_default();
  line.add("--seed", wishes.eval.seed, "of the line").shows_default();
  line.add_flag("--untagged", wishes.eval.untagged, "poses come without musical time");
  line.add_flag("--couples", wishes.couples,
                "the second half of the files are the partners of the first half, who dance where "
                "the first are shown, and the other way round");
  line.add("--others", wishes.others, "without tags: takes that do not dance to the song");
  line.add_flag("--learn-steps", wishes.learn_steps,
                "print the steps that the takes have in common, and do nothing else");
  line.add_flag("--each", wishes.each, "a line for each take, too");
  line.add_flag("--json", wishes.json, "one JSON object on stdout");
  line.footer(dance::kExamples);
  return dance::run_program(line, argc, argv, [&] { return dance::run(wishes); });
}
