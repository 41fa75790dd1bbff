// dance codec train: makes a model of the pose codec from recorded dances.
#include "core/program/command_line.h"
#include "core/program/program.h"
#include "core/program/talk.h"
#include "core/program/whole_file.h"
#include "research/codec/codec_training.h"

namespace dance {
namespace {

constexpr const char* kExamples = R"(Examples:
  dance codec train salsa/*.bvh -o body.model
  dance codec eval other/*.bvh --model body.model
)";

Result<void> train(const std::vector<std::string>& files, const std::string& out, int rounds) {
  if (auto possible = try_whole_file(out); !possible) return possible;
  CodecTraining training;
  training.rounds = rounds;
  training.tell = [](const std::string& line) { talk::info("{}", line); };
  for (const std::string& file : files) {
    DANCE_TRY(CodecTake fast, load_codec_take(file, 60.0));
    DANCE_TRY(CodecTake slow, load_codec_take(file, 30.0));
    talk::info("{}: {} frames", fast.name, fast.poses.size());
    training.fast.push_back(std::move(fast));
    training.slow.push_back(std::move(slow));
  }
  DANCE_TRY(const auto model, train_codec(training));
  const std::vector<std::uint8_t> bytes = write_model(*model);
  DANCE_TRY(const auto read, read_model(bytes));
  if (auto written = write_whole_file(out, bytes); !written) return written;
  talk::info("{}: model {:08x}, {} bytes", out, read->name, bytes.size());
  return {};
}

}  // namespace
}  // namespace dance

int main(int argc, char** argv) {
  std::vector<std::string> files;
  std::string out = "body.model";
  int rounds = 2;
  dance::CommandLine line("trains a model of the pose codec on recorded dances",
                          "dance codec train");
  line.add("FILE", files, "BVH files, also packed with xz").required();
  line.add("-o,--out", out, "where the model goes").shows_default();
  line.add("--rounds", rounds, "how often it learns from what it coded itself").range(1, 10);
  line.footer(dance::kExamples);
  return dance::run_program(line, argc, argv, [&] { return dance::train(files, out, rounds); });
}
