// dance predict eval: prediction on recorded dances.
#include <cmath>
#include <cstdio>
#include <string>

#include "core/program/command_line.h"
#include "core/program/program.h"
#include "research/predict/couple_eval.h"
#include "research/predict/predict_eval.h"
#include "research/predict_model_file.h"

namespace dance {
namespace {

constexpr const char* kPredictEvalExamples = R"(Examples:
  dance predict eval salsa.bvh
  dance predict eval *.bvh.xz --hz 60 --noise 0.5
  dance predict eval *.bvh.xz --noise 0.5 --fresh --json
  dance predict eval lead.bvh follow.bvh --partner --horizons 60,120,200

Files are danced in the order given; what was learned of a dancer (told by the lengths of the bones)
is kept for the next file. --fresh begins anew with each, as with a dancer never met, and does not
use a network that was trained on this dancer. --partner takes the two dancers of a dance behind
each other, and predicts each alone, beside the other, and beside a dancer of the next dance.
)";

struct PredictEvalWishes {
  std::vector<std::string> files;
  double hz = 60.0;
  std::vector<double> horizons_ms{50, 100, 150, 200, 300, 400, 600, 1000};
  double noise_deg = 0.0;
  bool fresh = false;
  bool json = false, partner = false, fit_palms = false;
  double join_m = 0.0;
  std::string model;
};

Result<void> run_predict_eval(const PredictEvalWishes& wishes) {
  if (wishes.fit_palms && !wishes.partner)
    return fail("--fit-palms fits what partners' palms say of each other: give --partner, too");
  PredictEvalOptions options;
  options.model = built_in_predict_model();
  if (!wishes.model.empty()) {
    DANCE_TRY(options.model, read_predict_model_file(wishes.model));
  }
  options.noise_deg = wishes.noise_deg;
  options.fresh = wishes.fresh;
  for (const double ms : wishes.horizons_ms) {
    if (!(ms > 0.0 && ms <= 1000.0))
      return fail("--horizons takes milliseconds above 0, at most 1000");
    options.horizons.push_back(Duration::seconds(ms * 1e-3));
  }
  std::vector<PredictTake> takes;
  for (const std::string& file : wishes.files) {
    DANCE_TRY(PredictTake take, load_predict_take(file, wishes.hz));
    takes.push_back(std::move(take));
  }
  if (wishes.partner) {
    DANCE_TRY(const auto couples, couples_of(std::move(takes)));
    const CoupleEvalOptions couple{options.horizons, options.noise_deg, wishes.join_m,
                                   options.model, wishes.fit_palms};
    const CoupleEval eval = evaluate_couples(couples, couple);
    if (wishes.fit_palms) {
      DANCE_TRY(const PalmWeights weights, fit_palms(eval.palms));
      std::fputs(palm_weights_text(weights).c_str(), stdout);
      return {};
    }
    const std::string text =
        wishes.json ? couple_eval_json(eval, couple) : couple_eval_table(eval, couple);
    std::fwrite(text.data(), 1, text.size(), stdout);
    return {};
  }
  const PredictEval eval = evaluate_prediction(takes, options);
  const std::string text =
      wishes.json ? predict_eval_json(eval, options) : predict_eval_table(eval, options);
  std::fwrite(text.data(), 1, text.size(), stdout);
  return {};
}

}  // namespace
}  // namespace dance

int main(int argc, char** argv) {
  dance::PredictEvalWishes wishes;
  dance::CommandLine line("Prediction on recorded dances: errors beside plain predictions, cost.",
                          "dance predict eval");
  line.add("FILE", wishes.files, "BVH files, also packed with xz").required();
  line.add("--hz", wishes.hz, "poses a second that are heard").range(10.0, 240.0).shows_default();
  line.add("--horizons", wishes.horizons_ms, "milliseconds ahead, with commas").split_at(',');
  line.add("--noise", wishes.noise_deg,
           "degrees that each bone trembles by about each axis, as sensors do; half a degree "
           "shakes the hips by 3 mm")
      .range(0.0, 10.0);
  line.add_flag("--fresh", wishes.fresh, "each file as the first of a dancer never met");
  line.add_flag("--partner", wishes.partner, "files are couples: predict each beside the other");
  line.add("--join", wishes.join_m,
           "with --partner: metres within which palms are brought together, as captures that were "
           "put onto other bodies hold hands at 20 cm")
      .range(0.0, 1.0);
  line.add_flag("--fit-palms", wishes.fit_palms,
                "with --partner: print the weights of what the partner's palms say, fitted to "
                "these couples, as they are built in");
  line.add("--model", wishes.model, "a model of dance predict train instead of the built-in one");
  line.add_flag("--json", wishes.json, "one JSON object on stdout");
  line.footer(dance::kPredictEvalExamples);
  return dance::run_program(line, argc, argv, [&] { return dance::run_predict_eval(wishes); });
}
