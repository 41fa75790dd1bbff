#include "transformers/predict/past/dance_memory.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "transformers/predict/model/row_kernels.h"

namespace dance {
namespace {

constexpr std::array<float, DanceMemory::kWindows> kWindow_rows{18.0f, 120.0f};
constexpr float kHeardEnough = 0.6f;
constexpr std::size_t kApart = 6;
constexpr float kSoftness = 0.25f;
// What moves little says little.
constexpr float kLeastLever_m = 0.08f;

}  // namespace

DanceMemory::DanceMemory(const std::array<float, kRowGroups>& lever) : rows_(kRing) {
  for (std::size_t g = 0; g < kBoneCount; ++g)
    for (std::size_t axis = 0; axis < 3; ++axis)
      if (lever[g] >= kLeastLever_m) {
        compared_.push_back(BodyRow::at(g, axis));
        scale_.push_back(lever[g]);
      }
  now_.resize(compared_.size());
  past_.resize(compared_.size() * kStride);
  for (std::size_t w = 0; w < kWindows; ++w) {
    distances_[w].resize(kLags);
    const float keep = 1.0f - 1.0f / kWindow_rows[w];
    for (std::size_t rows = 0; rows <= kLags; ++rows)
      heard_[w].push_back(1.0f - std::pow(keep, static_cast<float>(rows)));
  }
  clear();
}

void DanceMemory::clear() {
  size_ = 0;
  head_ = kStride - kLags - 1;
  std::fill(past_.begin(), past_.end(), 0.0f);
  for (auto& distances : distances_) std::fill(distances.begin(), distances.end(), 0.0f);
}

void DanceMemory::push(const BodyRow& row) {
  newest_ = (newest_ - 1) & kMask;
  rows_[newest_] = row;
  for (std::size_t i = 0; i < compared_.size(); ++i) now_[i] = row.v[compared_[i]] * scale_[i];
  if (size_ > 0) {
    const std::size_t lags = std::min(size_, kLags);
    follow_distances(now_.data(), compared_.size(), past_.data() + head_, kStride, lags,
                     distances_[0].data(), 1.0f - 1.0f / kWindow_rows[0], distances_[1].data(),
                     1.0f - 1.0f / kWindow_rows[1]);
  }
  if (head_ == 0) {
    head_ = kStride - kLags - 1;
    for (std::size_t i = 0; i < compared_.size(); ++i)
      std::memmove(&past_[i * kStride + head_], &past_[i * kStride], (kLags + 1) * sizeof(float));
  }
  --head_;
  for (std::size_t i = 0; i < compared_.size(); ++i) past_[i * kStride + head_] = now_[i];
  size_ = std::min(size_ + 1, kRing);
}

void DanceMemory::find_likeness(std::size_t window, std::size_t least_lag,
                                Likeness& likeness) const {
  likeness.count = 0;
  const std::vector<float>& distances = distances_[window];
  const std::vector<float>& heard = heard_[window];
  // distances[l] is of lag l + 1, followed since the memory had that many rows.
  const std::size_t lags = std::min(size_ > 0 ? size_ - 1 : 0, kLags);
  const bool is_full = size_ == kRing;
  std::array<float, kLikeMost> best{};
  std::array<std::uint8_t, kLags> is_least;
  find_least(distances.data(), lags + 1 < kLags ? lags + 1 : kLags, is_least.data());
  for (std::size_t lag = std::max<std::size_t>(least_lag, 2); lag < lags; ++lag) {
    const void* next = std::memchr(is_least.data() + lag - 1, 1, lags - lag);
    if (next == nullptr) break;
    lag = static_cast<std::size_t>(static_cast<const std::uint8_t*>(next) - is_least.data()) + 1;
    const std::size_t rows = is_full ? kLags : std::min(size_ - lag, kLags);
    if (heard[rows] < kHeardEnough) break;  // and the longer lags have heard less
    const float distance = distances[lag - 1];
    const float alike = distance / heard[rows];
    // One that lies close to a better one is the same moment.
    std::size_t near = likeness.count;
    for (std::size_t k = 0; k < likeness.count; ++k)
      if (lag - likeness.lag[k] <= kApart) near = k;
    if (near < likeness.count) {
      if (alike < best[near]) {
        best[near] = alike;
        likeness.lag[near] = lag;
      }
      continue;
    }
    if (likeness.count < kLikeMost) {
      best[likeness.count] = alike;
      likeness.lag[likeness.count++] = lag;
      continue;
    }
    const auto worst = std::max_element(best.begin(), best.end());
    if (alike >= *worst) continue;
    *worst = alike;
    likeness.lag[static_cast<std::size_t>(worst - best.begin())] = lag;
  }
  if (likeness.count == 0) return;
  const float least =
      *std::min_element(best.begin(), best.begin() + static_cast<std::ptrdiff_t>(likeness.count));
  float sum = 0.0f;
  for (std::size_t k = 0; k < likeness.count; ++k) {
    likeness.weight[k] = std::exp(-(best[k] - least) / (kSoftness * least + 1e-12f));
    sum += likeness.weight[k];
  }
  for (std::size_t k = 0; k < likeness.count; ++k) likeness.weight[k] /= sum;
}

}  // namespace dance
