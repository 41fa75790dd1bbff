// Assignment: the cheapest way of giving candidates to persons, by trying all: there are four of
// each at most.
//
// Units/frames: costs of any unit.
// Ownership:    refers to the costs while it is made.
// Threads:      none inside.
// Failure:      none; a person whom no candidate suits stays without.
#pragma once

#include <array>
#include <cstddef>

#include "producers/camera/people/people_tracker.h"

namespace dance {

class Assignment {
 public:
  using Costs = std::array<std::array<float, kMostDancers>, kMostDancers>;
  static constexpr std::size_t kNone = kMostDancers;

  // Without a candidate a person costs `nobody`.
  Assignment(const Costs& costs, std::size_t persons, std::size_t candidates, float nobody)
      : costs_(costs), persons_(persons), candidates_(candidates), nobody_(nobody) {
    try_all(0, 0.0f);
  }
  std::size_t of(std::size_t person) const { return best_[person]; }

 private:
  void try_all(std::size_t person, float cost) {
    if (cost >= least_) return;
    if (person == persons_) {
      least_ = cost;
      best_ = now_;
      return;
    }
    for (std::size_t c = 0; c < candidates_; ++c) {
      if (is_taken_[c]) continue;
      is_taken_[c] = true;
      now_[person] = c;
      try_all(person + 1, cost + costs_[person][c]);
      is_taken_[c] = false;
    }
    now_[person] = kNone;
    try_all(person + 1, cost + nobody_);
  }

  const Costs& costs_;
  std::size_t persons_, candidates_;
  float nobody_;
  std::array<bool, kMostDancers> is_taken_{};
  std::array<std::size_t, kMostDancers> now_{}, best_{kNone, kNone, kNone, kNone};
  float least_ = 1e9f;
};

}  // namespace dance
