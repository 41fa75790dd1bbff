// PersonalModel: what one dancer does otherwise than bodies in general: a ridge regression from the
// network's inputs to what the network left over, learned beside the pose path while they dance.
//
// Units/frames: rows 60 a second, as transformers/predict/model/body_row.h; corrections as
//               the network's answers.
// Ownership:    shared by the predictor and the thread that learns; four megabytes.
// Threads:      push() and weights() are the pose path's, learn() another thread's; they meet in a
//               ring and in a slot.
// Failure:      rows that the learning thread was too late for are lost and counted; it goes on
//               behind them.
#pragma once

#include <atomic>
#include <memory>
#include <vector>

#include "core/base/latest.h"
#include "core/base/spsc_ring.h"
#include "transformers/predict/learner.h"
#include "transformers/predict/model/predict_model.h"

namespace dance {

class PersonalModel : public Learner {
 public:
  // inputs x answers
  using Weights = std::array<float, kNetInputs * kNetAnswers>;

  explicit PersonalModel(std::shared_ptr<const PredictModel> model);
  // Whether it learns what the network leaves over, or everything; before the first row.
  void set_asks_net(bool asks) { asks_net_.store(asks, std::memory_order_relaxed); }
  ~PersonalModel() override;

  // Pose path: a row more; `anew` where it does not follow the one before.
  void push(const BodyRow& row, float tremble_rad, bool anew);
  // Pose path: the rows from here on are another dancer's; there are no weights before those are
  // learned.
  void forget();
  // Pose path: the newest weights, nullptr before the first. `is_new`: since the last call.
  const Weights* weights(bool& is_new);

  void learn() override;
  // Of the learning thread.
  std::uint64_t moments() const { return moments_; }

 private:
  struct Sample {
    BodyRow row;
    float tremble_rad;
    bool anew;
    std::uint32_t dancer;
  };
  struct Solved {
    alignas(64) Weights weights{};
    std::uint32_t dancer = 0;
  };
  struct Sums;
  void take(const Sample& sample);
  void begin_dancer(std::uint32_t dancer);
  void take_in_batch();
  void solve();

  std::shared_ptr<const PredictModel> model_;
  std::atomic<bool> asks_net_{true};
  static constexpr std::size_t kRing = 1024;  // 17 s
  std::unique_ptr<SpscRing<Sample, kRing>> samples_;
  std::unique_ptr<Latest<Solved>> solved_;
  const Weights* newest_ = nullptr;
  std::uint32_t dancer_ = 0;  // counts those who were here

  // The learning thread's.
  std::unique_ptr<Sums> sums_;
  std::uint64_t moments_ = 0;
};

}  // namespace dance
