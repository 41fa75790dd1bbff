// dance trackers train: makes a model that guesses whole bodies, from recorded dances.
#include "core/program/command_line.h"
#include "core/program/program.h"
#include "core/program/talk.h"
#include "core/program/whole_file.h"
#include "research/trackers/standing_take.h"
#include "research/trackers/tracker_model_file.h"
#include "research/trackers/tracker_net_fit.h"

namespace dance {
namespace {

constexpr const char* kTrackersTrainExamples = R"(Examples:
  dance trackers train salsa/*.bvh.xz -o body.model
  dance trackers eval other/*.bvh.xz --model body.model
)";

constexpr double kStandingTake_s = 110.0;

struct TrackersTrainWishes {
  std::vector<std::string> files;
  std::string out = "body.model";
  int bodies = 8;
  int standing = 8;
  TrackerFit fit;
};

Result<void> run_trackers_train(TrackersTrainWishes& wishes) {
  if (auto possible = try_whole_file(wishes.out); !possible) return possible;
  wishes.fit.tell = [](const std::string& line) { talk::info("{}", line); };
  std::vector<TrackerDance> dances;
  Random random(wishes.fit.seed);
  for (const std::string& file : wishes.files) {
    DANCE_TRY(const PredictTake take, load_predict_take(file, TrackerRow::kStep_hz));
    talk::info("{}: {} frames", take.name, take.poses.size());
    for (TrackerDance& dance : tracker_dances(take, wishes.bodies, random))
      dances.push_back(std::move(dance));
  }
  for (int i = 0; i < wishes.standing; ++i) {
    const auto height_m = static_cast<float>(random.uniform(1.62, 1.86));
    const PredictTake take = standing_take(height_m, TrackerRow::kStep_hz, kStandingTake_s, random);
    for (TrackerDance& dance : tracker_dances(take, 1, random)) dances.push_back(std::move(dance));
  }
  TrackerModel model;
  model.net = fit_tracker_net(dances, wishes.fit);
  if (auto written = write_tracker_model_file(model, wishes.out); !written) return written;
  DANCE_TRY(const auto read, read_tracker_model_file(wishes.out));
  talk::info("{}: model {:08x}", wishes.out, read->name);
  return {};
}

}  // namespace
}  // namespace dance

int main(int argc, char** argv) {
  dance::TrackersTrainWishes wishes;
  dance::CommandLine line("trains a model of whole bodies from few points on recorded dances",
                          "dance trackers train");
  line.add("FILE", wishes.files, "BVH files, also packed with xz").required();
  line.add("-o,--out", wishes.out, "where the model goes").shows_default();
  line.add("--rounds", wishes.fit.rounds, "how often parameters change; 32 sequences each")
      .range(1, 100000)
      .shows_default();
  line.add("--bodies", wishes.bodies, "bodies that each dance and its mirror image are put on")
      .range(1, 32)
      .shows_default();
  line.add("--standing", wishes.standing,
           "made takes, of 110 s, of somebody who stands about and walks a few steps")
      .range(0, 64)
      .shows_default();
  line.add("--seed", wishes.fit.seed, "another number begins elsewhere").shows_default();
  line.footer(dance::kTrackersTrainExamples);
  return dance::run_program(line, argc, argv, [&] { return dance::run_trackers_train(wishes); });
}
