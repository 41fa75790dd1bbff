// dance touch eval: holds on recorded couples: are held hands recognised, and brought together?
#include <cstdio>

#include "core/program/command_line.h"
#include "core/program/program.h"
#include "research/predict_model_file.h"
#include "research/touch/touch_eval.h"
#include "research/touch/touch_spread.h"
#include "transformers/settings.h"

namespace dance {
namespace {

constexpr const char* kTouchExamples = R"(Examples:
  dance touch eval lead.bvh.xz follow.bvh.xz
  dance touch eval lead.bvh.xz follow.bvh.xz --delay 120ms --jitter 30ms --noise 1
  dance touch eval lead.bvh.xz follow.bvh.xz --through hold --json
  dance touch eval lead.bvh.xz follow.bvh.xz --delays 30ms,60ms,120ms --seeds 5
                                                     how much of it is luck
  dance touch eval lead1.bvh follow1.bvh lead2.bvh follow2.bvh --seeds 5 --choose
                                                     with limits that were chosen on other dances
Files in pairs, lead and follow. The lead is here, the follow comes over a line and through the
route. found: of the pictures in which the recording has two palms within 8 cm, those in which they
are reported held. false: holds during which the recording has them never within 8 cm; far: never
within 12 cm. breaks: ends of a reported hold while the recording holds on. apart: of the pictures
reported, those in which the recording has the palms over 16 cm apart. "within 8 cm" is the same
threshold on what is shown.
)";

struct Wishes {
  std::vector<std::string> files;
  std::string delay = "60ms", jitter = "15ms", model;
  std::vector<std::string> through{"predict", "bridge"};
  double loss_percent = 1.0, noise_deg = 0.5, join_m = 0.4, hz = 60.0;
  double begin_mm = 1e3 * static_cast<double>(PalmHold::Limits().begin_m);
  double end_mm = 1e3 * static_cast<double>(PalmHold::Limits().end_m);
  double again_mm = 1e3 * static_cast<double>(PalmHold::Limits().again_m);
  double early_mm = 1e3 * static_cast<double>(PalmHold::Limits().early_m);
  double soon_mm = 1e3 * static_cast<double>(PalmHold::Limits().soon_m);
  std::string release = "260ms", look = "120ms";
  std::vector<std::string> delays;
  int seeds = 0;
  std::int64_t seed = 0;
  bool is_json = false, chooses = false;
};

constexpr Duration kLongestLine = Duration::s(1);
constexpr int kUsualSeeds = 5;

Result<void> run_spread(const std::vector<CoupleTake>& couples, const TouchLine& line,
                        const Wishes& wishes) {
  SpreadWish wish;
  for (const std::string& text : wishes.delays) {
    DANCE_TRY(const Duration delay, parse_duration(text));
    if (delay < Duration() || delay > kLongestLine)
      return fail("--delays: " + text + " cannot be judged: 0ms to 1s, please");
    wish.delays.push_back(delay);
  }
  if (wish.delays.empty()) wish.delays.push_back(line.delay);
  wish.seeds = static_cast<std::size_t>(wishes.seeds > 0 ? wishes.seeds : kUsualSeeds);
  wish.chooses = wishes.chooses;
  if (wish.chooses && couples.size() < 2)
    return fail("--choose needs two dances at least: limits are chosen on the others");
  const TouchSpread spread = evaluate_spread(couples, line, wish);
  if (spread.rows.front().figures.front().seconds < 1.0)
    return fail("the takes are too short: at least 5 s are needed");
  const std::string text = wishes.is_json ? touch_spread_json(spread) : touch_spread_table(spread);
  std::fwrite(text.data(), 1, text.size(), stdout);
  return {};
}

Result<void> run(const Wishes& wishes) {
  TouchLine line;
  DANCE_TRY(line.delay, parse_duration(wishes.delay));
  DANCE_TRY(line.jitter, parse_duration(wishes.jitter));
  DANCE_TRY(line.limits.release_delay, parse_duration(wishes.release));
  DANCE_TRY(line.limits.look, parse_duration(wishes.look));
  line.limits.again_m = static_cast<float>(1e-3 * wishes.again_mm);
  line.limits.early_m = static_cast<float>(1e-3 * wishes.early_mm);
  line.limits.soon_m = static_cast<float>(1e-3 * wishes.soon_mm);
  if (line.delay < Duration() || line.delay > kLongestLine || line.jitter < Duration() ||
      line.jitter > kLongestLine)
    return fail("a line with --delay " + wishes.delay + " --jitter " + wishes.jitter +
                " cannot be judged: 0ms to 1s, please");
  line.loss_percent = wishes.loss_percent;
  line.noise_deg = wishes.noise_deg;
  line.limits.begin_m = static_cast<float>(1e-3 * wishes.begin_mm);
  line.limits.end_m = static_cast<float>(1e-3 * wishes.end_mm);
  line.through = wishes.through;
  if (line.through.size() == 1 && line.through[0] == "none") line.through.clear();
  DANCE_TRY(line.parts, parts_with_model(wishes.model));
  if (const auto flow = Flow::make(line.through, line.parts); !flow)
    return tl::make_unexpected(flow.error());
  std::vector<PredictTake> takes;
  for (const std::string& file : wishes.files) {
    DANCE_TRY(PredictTake take, load_predict_take(file, wishes.hz));
    takes.push_back(std::move(take));
  }
  DANCE_TRY(std::vector<CoupleTake> couples, couples_of(std::move(takes)));
  for (CoupleTake& couple : couples) join_palms(couple, static_cast<float>(wishes.join_m));
  line.seed = static_cast<std::uint64_t>(wishes.seed);
  if (wishes.seeds > 0 || !wishes.delays.empty() || wishes.chooses)
    return run_spread(couples, line, wishes);
  const TouchEval eval = evaluate_touch(couples, line);
  if (eval.rows.front().figures.seconds < 1.0)
    return fail("the takes are too short: at least 5 s are needed");
  const std::string text = wishes.is_json ? touch_eval_json(eval) : touch_eval_table(eval);
  std::fwrite(text.data(), 1, text.size(), stdout);
  return {};
}

}  // namespace
}  // namespace dance

int main(int argc, char** argv) {
  dance::Wishes wishes;
  dance::CommandLine line("Held hands of recorded couples: recognised, and brought together?",
                          "dance touch eval");
  line.add("FILE", wishes.files, "BVH files, also packed with xz; lead, follow, lead, follow")
      .required();
  line.add("--delay", wishes.delay, "of the line").shows_default();
  line.add("--jitter", wishes.jitter, "mean of what is added to it").shows_default();
  line.add("--loss", wishes.loss_percent, "percent of the poses that never come")
      .range(0.0, 90.0)
      .shows_default();
  line.add("--noise", wishes.noise_deg, "of the sensors, degrees about each axis of each bone")
      .range(0.0, 5.0)
      .shows_default();
  line.add("--join", wishes.join_m,
           "metres: palms nearer than this are first brought together in the recording, which "
           "holds hands at 20 cm, as it was put onto other bodies")
      .range(0.0, 0.6)
      .shows_default();
  line.add("--through", wishes.through, "words of the follow's route; none: as poses come");
  line.add("--model", wishes.model, "a model of dance predict train instead of the built-in one");
  line.add("--begin", wishes.begin_mm, "mm: palms so near begin a hold")
      .range(1.0, 500.0)
      .shows_default();
  line.add("--end", wishes.end_mm, "mm: palms further apart end it")
      .range(1.0, 1000.0)
      .shows_default();
  line.add("--release", wishes.release, "for so long").shows_default();
  line.add("--again", wishes.again_mm, "mm: of palms that held each other lately")
      .range(1.0, 1000.0)
      .shows_default();
  line.add("--early", wishes.early_mm, "mm: nearer than this begins a hold, too, where …")
      .range(1.0, 1000.0)
      .shows_default();
  line.add("--soon", wishes.soon_mm, "mm: … the palms come so near, as they move, …")
      .range(0.0, 1000.0)
      .shows_default();
  line.add("--look", wishes.look, "… within so long").shows_default();
  line.add("--seed", wishes.seed, "of noise, jitter and losses").range(0.0, 1e9).shows_default();
  line.add("--seeds", wishes.seeds,
           "so many seeds, one after the other: prints means and extremes of the stage; 0 = one")
      .range(0.0, 100.0);
  line.add("--delays", wishes.delays, "of several lines, as 30ms,60ms; for the same table")
      .split_at(',');
  line.add_flag("--choose", wishes.chooses,
                "for each dance also limits that were chosen on the other dances");
  line.add_flag("--json", wishes.is_json, "one JSON object on stdout");
  line.footer(dance::kTouchExamples);
  return dance::run_program(line, argc, argv, [&] { return dance::run(wishes); });
}
