// RhythmPeriods: how alike the rhythm of the last seconds is to itself a part of a beat, a beat or
// some beats later, for any beat that one may suppose, and how strokes of one range of pitch follow
// those of another. At the beat that dancers step on this looks otherwise than at half or double of
// its tempo.
//
// Units/frames: periods in hops of onset strengths. Values are correlations, at most 1.
// Ownership:    keeps the last 3.5 s and their correlations, about 45 kB; never allocates after
//               construction.
// Threads:      none inside; one owner.
// Failure:      wants strengths that are finite; before anything was heard all values are 0.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <span>

#include "producers/music/tracker/onset_strength.h"

namespace dance {

class RhythmPeriods {
 public:
  // Of the supposed beat.
  static constexpr std::array kLags_beats{1.0 / 8, 1.0 / 6, 1.0 / 4, 1.0 / 3, 1.0 / 2, 2.0 / 3,
                                          3.0 / 4, 1.0,     3.0 / 2, 2.0,     3.0,     4.0};
  // The group that strikes later, and the one that it follows.
  static constexpr std::array<std::array<std::size_t, 2>, 13> kPairs{{{0, 0},
                                                                      {1, 1},
                                                                      {2, 2},
                                                                      {3, 3},
                                                                      {4, 4},
                                                                      {0, 1},
                                                                      {1, 0},
                                                                      {0, 3},
                                                                      {3, 0},
                                                                      {0, 2},
                                                                      {2, 0},
                                                                      {1, 3},
                                                                      {3, 1}}};
  static constexpr std::size_t kCount = kLags_beats.size() * kPairs.size() + 2;
  static constexpr int kMostPeriod_hops = 84;

  RhythmPeriods();

  void push(const OnsetStrength::Strengths& strengths);
  // What speaks for or against a beat of so many hops, up to kMostPeriod_hops.
  void read(double period_hops, std::span<float, kCount> values) const;

 private:
  static constexpr int kBlur_hops = 3;
  static constexpr int kLags = 4 * kMostPeriod_hops + 6;
  static constexpr int kRoom = 4 * kLags;

  struct Group {
    std::array<float, kBlur_hops> newest{};
    float mean = 0.0f;
    float power = 0.0f;
    Eigen::ArrayXf past = Eigen::ArrayXf::Zero(kRoom);  // newest first, from begin_
  };

  std::array<Group, kOnsetGroups> groups_;
  std::array<Eigen::ArrayXf, kPairs.size()> alike_;  // by lag
  int begin_ = kRoom - kLags;
  int hops_ = 0;
};

}  // namespace dance
