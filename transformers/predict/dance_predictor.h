// DancePredictor: where one dancer's body will be. It hears poses as they come and tells the pose
// of any moment after the newest, up to a second ahead: many predictions
// (transformers/predict/model/predict_model.h), weighted by what this dancer has shown.
//
// Units/frames: capture times of one clock; poses in W.
// Ownership:    about three megabytes of its own, and the shared model; never allocates after
//               construction.
// Threads:      one owner; personal() may be shared with a thread that learns.
// Failure:      poses that are not newer are refused. Nothing is told before the first pose. A
//               prediction that is not finite is dropped for standing still, and counted.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "transformers/predict/blend/moment_predictions.h"
#include "transformers/predict/blend/prediction_blend.h"
#include "transformers/predict/blend/prediction_guard.h"
#include "transformers/predict/blend/prediction_proof.h"
#include "transformers/predict/model/personal_model.h"
#include "transformers/predict/past/steady_rows.h"

namespace dance {

class DancePredictor {
 public:
  static constexpr Duration kFurthest = Duration::s(1);

  explicit DancePredictor(std::shared_ptr<const PredictModel> model);
  // Whether the model was trained on this dancer too: then its network is trusted from the
  // beginning.
  void set_acquaintance(Acquaintance acquaintance);
  // Another dancer from the next pose on: nothing that was learned of the one before holds.
  void forget_dancer();

  SteadyRows::Heard observe(const Pose& pose);
  // How many rows a pose of that moment would take in, each at the price of a frame; and forgets
  // where the last one was, so that the next pose takes in one.
  double rows_until(MonoTime capture) const { return rows_.rows_until(capture); }
  void lose_thread() { rows_.forget(); }
  std::size_t rows_taken() const { return turn_; }
  bool is_empty() const { return !has_newest_; }
  const Pose& newest() const { return newest_; }
  // The pose of a moment from the newest on; what lies further than kFurthest stands as it would be
  // there.
  void predict(MonoTime moment, Pose& out) const;

  const std::shared_ptr<PersonalModel>& personal() const { return personal_; }
  std::uint64_t dropped() const { return dropped_; }
  // How often a bone turned impossibly fast, and was held where it was.
  std::uint64_t held_bones() const { return rows_.held(); }

  // For training: the predictions of `age` rows ago, and the rows.
  const MomentPredictions& predictions(std::size_t age = 0) const;
  const DanceMemory& memory() const { return memory_; }
  float tremble_rad() const { return rows_.tremble_rad(); }

 private:
  static constexpr std::size_t kMoments = 64;

  void take(const BodyRow& row);
  void ask_models(MomentPredictions& now);
  void learn_from_past();
  void make_ways(MomentPredictions& now);
  void set_prior();
  BodyRow row_at(double rows_ahead) const;
  double rows_ahead(MonoTime moment) const;
  void note_seen();

  std::shared_ptr<const PredictModel> model_;
  BodySpace space_;
  SteadyRows rows_;
  DanceMemory memory_;
  RowMean mean_;
  PredictionBlend blend_;
  PredictionProof proof_;
  PredictionGuard guard_;
  std::shared_ptr<PersonalModel> personal_;

  std::vector<MomentPredictions> moments_;
  std::size_t turn_ = 0;   // rows ever taken
  std::size_t since_ = 0;  // rows since the last restart
  Acquaintance acquaintance_ = Acquaintance::kOthers;
  bool anew_ = true;
  bool has_newest_ = false;
  Pose newest_;
  NetInputs inputs_{};
  // From the newest row to 0 and kHorizonFrames from it.
  std::array<BodyRow, kHorizons + 1> path_;
  // Where the newest pose lies between two rows: by how many, and what it shows beside path_.
  double seen_rows_ = 0.0;
  BodyRow seen_beside_;
  std::uint64_t dropped_ = 0;
};

}  // namespace dance
