#include "research/predict/predict_training.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <mutex>
#include <thread>

namespace dance {
namespace {

// The network sees every dance still, trembling a little, and twice as a sensor trembles: every
// other moment.
constexpr std::array<double, 4> kNetTrembles_deg{0.0, 0.25, 0.5, 0.5};
constexpr std::size_t kNetEvery = 2;

struct TakeOrigin {
  std::size_t dancer;
  std::size_t fold;
};

// Takes of one dancer are dealt to the folds in their order: partners' takes of one dance, which
// have the same place in their order, fall into the same fold.
std::vector<TakeOrigin> origins_of(const std::vector<PredictTake>& takes, std::size_t folds,
                                   std::vector<BoneLengths>& dancers) {
  std::vector<TakeOrigin> origins;
  std::vector<std::size_t> seen;
  for (const PredictTake& take : takes) {
    PredictModel known;
    known.dancers = dancers;
    std::size_t dancer = dancers.size();
    for (std::size_t d = 0; d < dancers.size(); ++d) {
      known.dancers = {dancers[d]};
      if (known.knows(take.skeleton)) dancer = d;
    }
    if (dancer == dancers.size()) {
      dancers.push_back(bone_lengths(take.skeleton));
      seen.push_back(0);
    }
    origins.push_back({dancer, seen[dancer]++ % folds});
  }
  return origins;
}

// A network to train, and the takes it may see.
struct NetJob {
  std::string name;
  PredictModel model;
  std::vector<const PredictTake*> takes;
};

void run_job(NetJob& job, const PredictTraining& training, std::mutex& talking) {
  NetSamples samples;
  Random random(training.seed + 17);
  for (const PredictTake* take : job.takes) {
    const PredictTake other = mirrored(*take);
    for (const PredictTake* seen : {take, &other})
      for (const double tremble_deg : kNetTrembles_deg)
        add_samples(job.model, *seen, tremble_deg, kNetEvery, random, samples);
  }
  fit_basis(job.model, samples);
  fit_net(job.model, samples,
          {training.epochs, training.seed, [&](int epoch, double error) {
             if (!training.tell) return;
             const std::lock_guard<std::mutex> lock(talking);
             training.tell(fmt::format("{}: {} moments, round {} of {}, error {:.4f}", job.name,
                                       samples.count, epoch + 1, training.epochs, error));
           }});
}

void run_jobs(std::vector<NetJob>& jobs, const PredictTraining& training) {
  std::mutex talking, taking;
  std::size_t next = 0;
  const auto work = [&] {
    for (;;) {
      std::size_t mine;
      {
        const std::lock_guard<std::mutex> lock(taking);
        mine = next++;
      }
      if (mine >= jobs.size()) return;
      run_job(jobs[mine], training, talking);
    }
  };
  std::vector<std::thread> threads;
  for (unsigned i = 1; i < std::clamp(std::thread::hardware_concurrency(), 1u, 4u); ++i)
    threads.emplace_back(work);
  work();
  for (std::thread& thread : threads) thread.join();
}

}  // namespace

Result<PredictModel> train_predict(const PredictTraining& training) {
  for (const PredictTake& take : training.takes)
    if (take.poses.size() < kLeastTakeFrames)
      return fail(fmt::format("{} has {} frames, {} at least are needed: leave it out", take.name,
                              take.poses.size(), kLeastTakeFrames));
  const auto folds = static_cast<std::size_t>(training.folds);
  PredictModel model;
  const auto origins = origins_of(training.takes, folds, model.dancers);
  if (model.dancers.size() > kMostKnownDancers)
    return fail("a model knows at most " + std::to_string(kMostKnownDancers) + " dancers");
  if (model.dancers.size() < 2 || training.takes.size() < 2 * folds)
    return fail("at least two dancers and " + std::to_string(2 * folds) +
                " takes are needed: some are kept back to learn what predictions are worth");
  if (std::all_of(origins.begin(), origins.end(), [](const auto& o) { return o.fold == 0; }))
    return fail(
        "two takes of one dancer at least are needed: without one, the other is left to learn "
        "from");
  fit_space(model, training.takes);
  // The network of the model, those that have not seen a part of the takes, and those that have not
  // seen a dancer.
  std::vector<NetJob> jobs;
  jobs.push_back({"all takes", model, {}});
  for (std::size_t f = 0; f < folds; ++f)
    jobs.push_back({fmt::format("without part {}", f + 1), model, {}});
  const std::size_t dancers = std::min<std::size_t>(model.dancers.size(), 4);
  for (std::size_t d = 0; d < dancers; ++d)
    jobs.push_back({fmt::format("without dancer {}", d + 1), model, {}});
  for (std::size_t t = 0; t < training.takes.size(); ++t)
    for (std::size_t j = 0; j < jobs.size(); ++j) {
      const bool is_kept_back = j == 0       ? false
                                : j <= folds ? origins[t].fold == j - 1
                                             : origins[t].dancer % dancers == j - 1 - folds;
      if (!is_kept_back) jobs[j].takes.push_back(&training.takes[t]);
    }
  run_jobs(jobs, training);
  // Dancers count alike, however long they were recorded: what holds for one is not what holds for
  // all.
  std::vector<double> frames(model.dancers.size());
  for (std::size_t t = 0; t < training.takes.size(); ++t)
    frames[origins[t].dancer] += static_cast<double>(training.takes[t].poses.size());
  for (std::size_t a = 0; a < kAcquaintances; ++a) {
    const auto acquaintance = static_cast<Acquaintance>(a);
    std::vector<WeighedTake> takes;
    for (std::size_t t = 0; t < training.takes.size(); ++t) {
      const std::size_t job = acquaintance == Acquaintance::kDancer
                                  ? 1 + origins[t].fold
                                  : 1 + folds + origins[t].dancer % dancers;
      const double weight =
          acquaintance == Acquaintance::kDancer ? 1.0 : 1e4 / frames[origins[t].dancer];
      takes.push_back({&training.takes[t], &jobs[job].model, weight});
    }
    for (std::size_t past = 0; past < 2; ++past)
      for (std::size_t n = 0; n < kTrainedTremble_deg.size(); ++n)
        model.weights[a][past][n] =
            fit_weights(takes, kTrainedTremble_deg[n], acquaintance != Acquaintance::kNone,
                        past == 0, model.tremble_rad[n]);
  }
  model.net = jobs[0].model.net;
  model.horizon_scale = jobs[0].model.horizon_scale;
  return model;
}

}  // namespace dance
