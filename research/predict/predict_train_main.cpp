// dance predict train: makes a model of prediction from recorded dances.
#include "core/program/command_line.h"
#include "core/program/program.h"
#include "core/program/talk.h"
#include "core/program/whole_file.h"
#include "research/predict/predict_training.h"

namespace dance {
namespace {

constexpr const char* kPredictTrainExamples = R"(Examples:
  dance predict train salsa/*.bvh -o dance.model
  dance predict eval other/*.bvh --model dance.model
)";

Result<void> run_predict_train(PredictTraining& training, const std::vector<std::string>& files,
                               const std::string& out) {
  if (auto possible = try_whole_file(out); !possible) return possible;
  training.tell = [](const std::string& line) { talk::info("{}", line); };
  for (const std::string& file : files) {
    DANCE_TRY(PredictTake take, load_predict_take(file, kGridHz));
    talk::info("{}: {} frames", take.name, take.poses.size());
    training.takes.push_back(std::move(take));
  }
  DANCE_TRY(const PredictModel model, train_predict(training));
  const std::vector<std::uint8_t> bytes = write_predict_model(model);
  DANCE_TRY(const auto read, read_predict_model(bytes));
  if (auto written = write_whole_file(out, bytes); !written) return written;
  talk::info("{}: model {:08x}, {} bytes, {} dancers", out, read->name, bytes.size(),
             read->dancers.size());
  return {};
}

}  // namespace
}  // namespace dance

int main(int argc, char** argv) {
  dance::PredictTraining training;
  std::vector<std::string> files;
  std::string out = "dance.model";
  dance::CommandLine line("trains a model of prediction on recorded dances", "dance predict train");
  line.add("FILE", files, "BVH files, also packed with xz").required();
  line.add("-o,--out", out, "where the model goes").shows_default();
  line.add("--rounds", training.epochs, "how often the network sees each moment")
      .range(1, 100)
      .shows_default();
  line.add("--parts", training.folds,
           "how many parts are kept back in turn to weigh the predictions")
      .range(2, 10)
      .shows_default();
  line.add("--seed", training.seed, "another number begins elsewhere").shows_default();
  line.footer(dance::kPredictTrainExamples);
  return dance::run_program(line, argc, argv,
                            [&] { return dance::run_predict_train(training, files, out); });
}
