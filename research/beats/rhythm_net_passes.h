// RhythmPasses: part of a batch of sequences through a recurrent network and back: its loss, and
// the gradient of that for each parameter.
//
// Units/frames: rows of features by step and sequence; parameters in one row (RhythmPlaces).
// Ownership:    owns what a pass keeps of each step; refers to the songs of its sequences.
// Threads:      none inside; several may run at the same time on the same parameters.
// Failure:      none.
// Source:       back-propagation through time (Werbos, 1990).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/base/random.h"
#include "research/beats/rhythm_net_fit.h"
#include "research/matrix_product.h"
#include "research/recurrent_fit.h"

namespace dance {

constexpr std::size_t kRhythmBatch = 32, kRhythmHalfBatch = kRhythmBatch / 2;
constexpr std::size_t kRhythmUnits = RhythmNet::kUnits, kRhythmGates = 3 * kRhythmUnits;
constexpr std::size_t kRhythmAnswers = RhythmNet::kAnswers, kRhythmMeanings = RhythmNet::kMeanings;
constexpr std::size_t kRhythmWideInputs = (RhythmNet::kInputs + 31) / 32 * 32;
constexpr std::size_t kRhythmWideAnswers = (kRhythmAnswers + 31) / 32 * 32;
// Judged from the first part on.
constexpr std::size_t kFirstJudged_part = 13;
constexpr float kDropInputs = 0.2f, kDropUnits = 0.2f;
constexpr float kTempoSpread = 0.8f;   // of places
constexpr float kTempoWeight = 0.25f;  // against a moment's class

using RhythmFloats = std::vector<float>;

using RhythmPlaces =
    RecurrentPlaces<kRhythmWideInputs, kRhythmUnits, kRhythmWideAnswers, RhythmNet::kLayers>;

inline float rhythm_sigmoid(float x) { return 1.0f / (1.0f + std::exp(-x)); }

// Half a batch through the network and back.
class RhythmPasses {
 public:
  RhythmPasses(const RhythmPlaces& places, std::size_t steps)
      : gradient(places.count), places_(places), steps_(steps) {
    for (std::size_t l = 0; l < RhythmNet::kLayers; ++l) {
      Kept& kept = kept_[l];
      for (RhythmFloats* of : {&kept.z, &kept.r, &kept.n, &kept.again_n, &kept.h, &kept.shown})
        of->resize(steps_ * kRhythmHalfBatch * kRhythmUnits);
      kept.mask.resize(kRhythmHalfBatch * kRhythmUnits);
    }
    inputs.resize(steps_ * kRhythmHalfBatch * kRhythmWideInputs);
    input_mask_.resize(kRhythmHalfBatch * kRhythmWideInputs);
    answers_.resize(steps_ * kRhythmHalfBatch * kRhythmWideAnswers);
    in_.resize(kRhythmHalfBatch * kRhythmGates);
    again_.resize(kRhythmHalfBatch * kRhythmGates);
    for (RhythmFloats* of : {&down_[0], &down_[1], &carried_})
      of->resize((of == &carried_ ? 1 : steps_) * kRhythmHalfBatch * kRhythmUnits);
    carried_next_.resize(carried_.size());
    songs.resize(kRhythmHalfBatch);
    first.resize(kRhythmHalfBatch);
  }

  RhythmFloats inputs;                   // step, sequence, feature
  std::vector<const RhythmSong*> songs;  // of each sequence
  std::vector<std::size_t> first;        // its first step
  RhythmFloats gradient;
  double loss = 0.0, tempo_loss = 0.0, weights = 0.0, right = 0.0;

  void run(const RhythmFloats& p, Random& random) {
    std::fill(gradient.begin(), gradient.end(), 0.0f);
    draw(input_mask_, kDropInputs, random);
    for (Kept& kept : kept_) draw(kept.mask, kDropUnits, random);
    for (std::size_t i = 0; i < inputs.size(); ++i)
      inputs[i] *= input_mask_[i % input_mask_.size()];
    for (std::size_t l = 0; l < RhythmNet::kLayers; ++l) forward(p, l);
    judge(p);
    turn(p);
    for (std::size_t l = RhythmNet::kLayers; l-- > 0;) backward(l);
  }

 private:
  struct Kept {
    RhythmFloats z, r, n, again_n, h;
    RhythmFloats shown;  // h after dropout
    RhythmFloats mask;
  };

  static void draw(RhythmFloats& mask, float share, Random& random) {
    for (float& m : mask)
      m = static_cast<float>(random.uniform()) < share ? 0.0f : 1.0f / (1.0f - share);
  }

  const float* below(std::size_t l, std::size_t t) const {
    return l == 0 ? &inputs[t * kRhythmHalfBatch * kRhythmWideInputs]
                  : &kept_[l - 1].shown[t * kRhythmHalfBatch * kRhythmUnits];
  }

  void forward(const RhythmFloats& p, std::size_t l) {
    Kept& kept = kept_[l];
    const RhythmPlaces::Layer& at = places_.layers[l];
    const std::size_t inner = RhythmPlaces::inputs(l);
    const RhythmFloats nothing(kRhythmHalfBatch * kRhythmUnits, 0.0f);
    for (std::size_t t = 0; t < steps_; ++t) {
      const std::size_t row = t * kRhythmHalfBatch * kRhythmUnits;
      const float* before =
          t == 0 ? nothing.data() : &kept.h[row - kRhythmHalfBatch * kRhythmUnits];
      for (std::size_t b = 0; b < kRhythmHalfBatch; ++b) {
        std::copy_n(&p[at.in_bias], kRhythmGates, &in_[b * kRhythmGates]);
        std::copy_n(&p[at.again_bias], kRhythmGates, &again_[b * kRhythmGates]);
      }
      add_matrix_product(below(l, t), inner, 1, &p[at.in], kRhythmGates, in_.data(),
                         kRhythmHalfBatch, inner, kRhythmGates);
      add_matrix_product(before, kRhythmUnits, 1, &p[at.again], kRhythmGates, again_.data(),
                         kRhythmHalfBatch, kRhythmUnits, kRhythmGates);
      for (std::size_t b = 0; b < kRhythmHalfBatch; ++b)
        for (std::size_t u = 0; u < kRhythmUnits; ++u) {
          const std::size_t g = b * kRhythmGates + u, i = row + b * kRhythmUnits + u;
          const float z = rhythm_sigmoid(in_[g] + again_[g]);
          const float r = rhythm_sigmoid(in_[g + kRhythmUnits] + again_[g + kRhythmUnits]);
          const float n = std::tanh(in_[g + 2 * kRhythmUnits] + r * again_[g + 2 * kRhythmUnits]);
          kept.z[i] = z, kept.r[i] = r, kept.n[i] = n,
          kept.again_n[i] = again_[g + 2 * kRhythmUnits];
          kept.h[i] = (1.0f - z) * n + z * before[b * kRhythmUnits + u];
          kept.shown[i] = kept.h[i] * kept.mask[b * kRhythmUnits + u];
        }
    }
  }

  // answers_ become the errors of the answers.
  void judge(const RhythmFloats& p) {
    loss = tempo_loss = weights = right = 0.0;
    const Kept& top = kept_.back();
    for (std::size_t t = 0; t < steps_; ++t) {
      float* answers = &answers_[t * kRhythmHalfBatch * kRhythmWideAnswers];
      for (std::size_t b = 0; b < kRhythmHalfBatch; ++b)
        std::copy_n(&p[places_.out_bias], kRhythmWideAnswers, answers + b * kRhythmWideAnswers);
      add_matrix_product(&top.shown[t * kRhythmHalfBatch * kRhythmUnits], kRhythmUnits, 1,
                         &p[places_.out], kRhythmWideAnswers, answers, kRhythmHalfBatch,
                         kRhythmUnits, kRhythmWideAnswers);
      for (std::size_t b = 0; b < kRhythmHalfBatch; ++b) {
        const std::size_t step = first[b] + t;
        const bool is_heard = step < songs[b]->classes.size();
        const float weight =
            t < steps_ / kFirstJudged_part || !is_heard ? 0.0f : songs[b]->weights[step];
        judge_one(answers + b * kRhythmWideAnswers, is_heard ? songs[b]->classes[step] : 0,
                  is_heard ? songs[b]->tempi[step] : 0.0f, weight);
      }
    }
  }

  static void to_shares(float* x, std::size_t n) {
    const float most = *std::max_element(x, x + n);
    float sum = 0.0f;
    for (std::size_t i = 0; i < n; ++i) sum += x[i] = std::exp(x[i] - most);
    for (std::size_t i = 0; i < n; ++i) x[i] /= sum;
  }

  void judge_one(float* answer, std::size_t truth, float tempo, float weight) {
    constexpr std::size_t kTempi = RhythmNet::kTempi;
    if (weight <= 0.0f) {
      std::fill_n(answer, kRhythmWideAnswers, 0.0f);
      return;
    }
    to_shares(answer, kRhythmMeanings);
    loss -= static_cast<double>(weight) * std::log(std::max(answer[truth], 1e-9f));
    weights += static_cast<double>(weight);
    answer[truth] -= 1.0f;
    for (std::size_t i = 0; i < kRhythmMeanings; ++i) answer[i] *= weight;
    float* tempi = answer + kRhythmMeanings;
    to_shares(tempi, kTempi);
    // A beat that the list lost is no tempo, but some place must be likely.
    const float place = std::clamp(tempo, -1.0f, static_cast<float>(kTempi));
    std::array<float, kTempi> wanted;
    float sum = 0.0f;
    for (std::size_t i = 0; i < kTempi; ++i) {
      const float away = (static_cast<float>(i) - place) / kTempoSpread;
      sum += wanted[i] = std::exp(-0.5f * away * away);
    }
    std::size_t best = 0;
    for (std::size_t i = 0; i < kTempi; ++i) {
      wanted[i] /= sum;
      if (tempi[i] > tempi[best]) best = i;
      tempo_loss -= static_cast<double>(weight * wanted[i]) *
                    std::log(std::max(tempi[i], 1e-9f) / std::max(wanted[i], 1e-9f));
    }
    if (std::abs(static_cast<float>(best) - place) < 1.6f) right += static_cast<double>(weight);
    for (std::size_t i = 0; i < kTempi; ++i)
      tempi[i] = kTempoWeight * weight * (tempi[i] - wanted[i]);
    std::fill(tempi + kTempi, answer + kRhythmWideAnswers, 0.0f);
  }

  // Matrices by columns, for the way back.
  void turn(const RhythmFloats& p) {
    const auto turned = [&](std::size_t at, std::size_t rows, std::size_t columns,
                            RhythmFloats& to) {
      to.resize(rows * columns);
      for (std::size_t i = 0; i < rows; ++i)
        for (std::size_t j = 0; j < columns; ++j) to[j * rows + i] = p[at + i * columns + j];
    };
    turned(places_.out, kRhythmUnits, kRhythmWideAnswers, out_turned_);
    for (std::size_t l = 0; l < RhythmNet::kLayers; ++l) {
      turned(places_.layers[l].again, kRhythmUnits, kRhythmGates, again_turned_[l]);
      if (l > 0) turned(places_.layers[l].in, kRhythmUnits, kRhythmGates, in_turned_[l]);
    }
  }

  void backward(std::size_t l) {
    constexpr std::size_t kRow = kRhythmHalfBatch * kRhythmUnits;
    const Kept& kept = kept_[l];
    const RhythmPlaces::Layer& at = places_.layers[l];
    const std::size_t inner = RhythmPlaces::inputs(l);
    const bool is_top = l + 1 == RhythmNet::kLayers;
    RhythmFloats& errors = down_[l];  // of shown, from above
    if (is_top) {
      std::fill(errors.begin(), errors.end(), 0.0f);
      for (std::size_t t = 0; t < steps_; ++t) {
        const float* of = &answers_[t * kRhythmHalfBatch * kRhythmWideAnswers];
        add_matrix_product(of, kRhythmWideAnswers, 1, out_turned_.data(), kRhythmUnits,
                           &errors[t * kRow], kRhythmHalfBatch, kRhythmWideAnswers, kRhythmUnits);
        add_matrix_product(&kept.shown[t * kRow], 1, kRhythmUnits, of, kRhythmWideAnswers,
                           &gradient[places_.out], kRhythmUnits, kRhythmHalfBatch,
                           kRhythmWideAnswers);
        for (std::size_t b = 0; b < kRhythmHalfBatch; ++b)
          for (std::size_t i = 0; i < kRhythmWideAnswers; ++i)
            gradient[places_.out_bias + i] += of[b * kRhythmWideAnswers + i];
      }
    }
    if (l > 0) std::fill(down_[l - 1].begin(), down_[l - 1].end(), 0.0f);
    std::fill(carried_.begin(), carried_.end(), 0.0f);
    const RhythmFloats nothing(kRow, 0.0f);
    for (std::size_t t = steps_; t-- > 0;) {
      const std::size_t row = t * kRow;
      const float* before = t == 0 ? nothing.data() : &kept.h[row - kRow];
      for (std::size_t b = 0; b < kRhythmHalfBatch; ++b)
        for (std::size_t u = 0; u < kRhythmUnits; ++u) {
          const std::size_t g = b * kRhythmGates + u, k = b * kRhythmUnits + u, i = row + k;
          const float dh = carried_[k] + errors[i] * kept.mask[k];
          const float z = kept.z[i], r = kept.r[i], n = kept.n[i];
          const float dn = dh * (1.0f - z) * (1.0f - n * n);
          const float dz = dh * (before[k] - n) * z * (1.0f - z);
          const float dr = dn * kept.again_n[i] * r * (1.0f - r);
          carried_next_[k] = dh * z;
          in_[g] = again_[g] = dz;
          in_[g + kRhythmUnits] = again_[g + kRhythmUnits] = dr;
          in_[g + 2 * kRhythmUnits] = dn;
          again_[g + 2 * kRhythmUnits] = dn * r;
        }
      add_matrix_product(again_.data(), kRhythmGates, 1, again_turned_[l].data(), kRhythmUnits,
                         carried_next_.data(), kRhythmHalfBatch, kRhythmGates, kRhythmUnits);
      std::swap(carried_, carried_next_);
      add_matrix_product(below(l, t), 1, inner, in_.data(), kRhythmGates, &gradient[at.in], inner,
                         kRhythmHalfBatch, kRhythmGates);
      add_matrix_product(before, 1, kRhythmUnits, again_.data(), kRhythmGates, &gradient[at.again],
                         kRhythmUnits, kRhythmHalfBatch, kRhythmGates);
      for (std::size_t b = 0; b < kRhythmHalfBatch; ++b)
        for (std::size_t g = 0; g < kRhythmGates; ++g) {
          gradient[at.in_bias + g] += in_[b * kRhythmGates + g];
          gradient[at.again_bias + g] += again_[b * kRhythmGates + g];
        }
      if (l > 0)
        add_matrix_product(in_.data(), kRhythmGates, 1, in_turned_[l].data(), kRhythmUnits,
                           &down_[l - 1][row], kRhythmHalfBatch, kRhythmGates, kRhythmUnits);
    }
  }

  const RhythmPlaces& places_;
  std::size_t steps_;
  std::array<Kept, RhythmNet::kLayers> kept_;
  RhythmFloats input_mask_, answers_, in_, again_;
  std::array<RhythmFloats, RhythmNet::kLayers> down_;
  RhythmFloats carried_, carried_next_, out_turned_;
  std::array<RhythmFloats, RhythmNet::kLayers> again_turned_, in_turned_;
};

}  // namespace dance
