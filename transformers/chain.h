// Chain: the stations of one route for one guest, made from their specifications ("hold 20ms"). The
// table of transformers stands in chain.cpp: a new one is one line there.
//
// Units/frames: as transformers/transformer.h.
// Ownership:    owns its stations; allocates only in make().
// Threads:      none inside; one owner.
// Failure:      make() names the word that it does not know, and the ones it does.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"
#include "transformers/settings.h"
#include "transformers/transformer.h"

namespace dance {

struct PredictModel;

// What stations may be made with and no specification can say, as nothing here reads files.
struct ChainParts {
  std::shared_ptr<const PredictModel> predict_model;  // null: the built-in one
};

class Chain {
 public:
  static Result<Chain> make(const std::vector<std::string>& specifications,
                            const ChainParts& parts = {});

  // A chain without stations hands poses through as they come.
  bool is_pass_through() const { return stations_.empty(); }
  void observe(const Pose& pose, MonoTime now) {
    for (auto& station : stations_) station->observe(pose, now);
  }
  void hear(const Beat& beat, MonoTime now) {
    for (auto& station : stations_) station->hear(beat, now);
  }
  void set_body(const Skeleton& skeleton) {
    for (auto& station : stations_) station->set_body(skeleton);
  }
  void set_style(const Style& style) {
    for (auto& station : stations_) station->set_style(style);
  }
  // What learns beside the pose path; see transformers/predict/learner.h.
  std::vector<std::shared_ptr<Learner>> learners() const;
  bool sample(MonoTime now, Pose& out) { return stations_.back()->sample(now, out); }
  // The longest of the stations'.
  Duration patience() const;
  // Summed over the stations.
  Transformer::Counters counters() const;

 private:
  std::vector<std::unique_ptr<Transformer>> stations_;
};

}  // namespace dance
