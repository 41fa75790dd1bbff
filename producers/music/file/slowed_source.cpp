#include "producers/music/file/slowed_source.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/music/music_speed.h"

namespace dance {
namespace {

constexpr double kCompared_hz = 11025.0;
constexpr float kLeastEnergy = 1e-6f;

std::int64_t floor_divide(std::int64_t a, std::int64_t b) { return a / b - (a % b < 0 ? 1 : 0); }

}  // namespace

SlowedSource::SlowedSource(std::unique_ptr<MusicSource> source)
    : source_(std::move(source)),
      half_(std::llround(0.5 * kWindow_s * source_->rate_hz())),
      search_(std::llround(kSearch_s * source_->rate_hz())),
      stride_(std::max<std::int64_t>(1, std::llround(source_->rate_hz() / kCompared_hz))),
      fade_(static_cast<std::size_t>(half_)),
      made_(2 * static_cast<std::size_t>(half_)),
      tail_(made_.size()) {
  for (std::size_t i = 0; i < fade_.size(); ++i) {
    const double part = (static_cast<double>(i) + 0.5) / static_cast<double>(fade_.size());
    const double root = std::sin(0.5 * std::numbers::pi * part);
    fade_[i] = static_cast<float>(root * root);
  }
}

void SlowedSource::set_loops(bool loops) { source_->set_loops(loops); }

void SlowedSource::set_speed(double speed) {
  speed = std::clamp(speed, kLeastMusicSpeed, kMostMusicSpeed);
  if (speed == speed_) return;
  speed_ = speed;
  is_made_ = false;
}

Result<void> SlowedSource::read(std::int64_t frame, std::span<float> interleaved) {
  if (speed_ == 1.0) return source_->read(frame, interleaved);
  while (!interleaved.empty()) {
    const std::int64_t piece = floor_divide(frame, half_);
    if (auto made = make_piece(piece); !made) return made;
    const std::int64_t at = frame - piece * half_;
    const auto frames = std::min(half_ - at, static_cast<std::int64_t>(interleaved.size()) / 2);
    const auto part = std::span(made_).subspan(static_cast<std::size_t>(2 * at),
                                               static_cast<std::size_t>(2 * frames));
    std::copy(part.begin(), part.end(), interleaved.begin());
    interleaved = interleaved.subspan(part.size());
    frame += frames;
  }
  return {};
}

// The middle of a window is heard on time.
std::int64_t SlowedSource::begin_of_window(std::int64_t piece) const {
  return std::llround(static_cast<double>((piece + 1) * half_) * speed_) - half_;
}

Result<void> SlowedSource::make_piece(std::int64_t piece) {
  if (is_made_ && piece == piece_) return {};
  if (!is_made_ || piece != piece_ + 1) {
    std::fill(tail_.begin(), tail_.end(), 0.0f);
    buffer_.clear();
    const std::int64_t before = begin_of_window(piece - 1);
    if (auto kept = buffer(before, before + 2 * half_); !kept) return kept;
    if (auto added = add_window(piece - 1, before); !added) return added;
  }
  const std::int64_t nominal = begin_of_window(piece);
  const std::int64_t first = std::min(nominal - search_, last_begin_ + half_);
  const std::int64_t end = std::max(nominal + search_, last_begin_) + 2 * half_;
  if (auto kept = buffer(first, end); !kept) return kept;
  return add_window(piece, best_begin(nominal));
}

Result<void> SlowedSource::add_window(std::int64_t piece, std::int64_t begin) {
  const auto from = static_cast<std::size_t>(2 * (begin - buffer_begin_));
  for (std::size_t i = 0; i < fade_.size(); ++i)
    for (std::size_t c = 0; c < 2; ++c) {
      const std::size_t at = 2 * i + c;
      made_[at] = tail_[at] + fade_[i] * buffer_[from + at];
      tail_[at] = (1.0f - fade_[i]) * buffer_[from + made_.size() + at];
    }
  last_begin_ = begin;
  piece_ = piece;
  is_made_ = true;
  return {};
}

// Reads the music on, in its order: some formats go back by decoding all again.
Result<void> SlowedSource::buffer(std::int64_t begin, std::int64_t end) {
  std::int64_t known = buffer_begin_ + static_cast<std::int64_t>(buffer_.size() / 2);
  if (buffer_.empty() || begin < buffer_begin_ || begin > known) {
    buffer_.clear();
    buffer_begin_ = known = begin;
  }
  buffer_.erase(buffer_.begin(), buffer_.begin() + 2 * (begin - buffer_begin_));
  buffer_begin_ = begin;
  if (end <= known) return {};
  const std::size_t size = buffer_.size();
  buffer_.resize(static_cast<std::size_t>(2 * (end - begin)));
  return source_->read(known, std::span(buffer_).subspan(size));
}

float SlowedSource::mono(std::int64_t frame) const {
  const auto at = static_cast<std::size_t>(2 * (frame - buffer_begin_));
  return buffer_[at] + buffer_[at + 1];
}

// How like `wanted` the music is from that frame on.
float SlowedSource::likeness(const std::vector<float>& wanted, std::int64_t frame) const {
  float product = 0.0f, energy = kLeastEnergy;
  for (const float sample : wanted) {
    const float other = mono(frame);
    product += sample * other;
    energy += other * other;
    frame += stride_;
  }
  return product / std::sqrt(energy);
}

// Finds the frame from which the music resembles most what followed the last window: first in
// steps, then frame by frame.
std::int64_t SlowedSource::best_begin(std::int64_t nominal) const {
  std::vector<float> wanted;
  wanted.reserve(static_cast<std::size_t>(half_ / stride_ + 1));
  for (std::int64_t i = 0; i < half_; i += stride_) wanted.push_back(mono(last_begin_ + half_ + i));
  std::int64_t best = nominal;
  float best_likeness = 0.0f;
  const auto search = [&](std::int64_t first, std::int64_t last, std::int64_t step) {
    for (std::int64_t begin = first; begin <= last; begin += step) {
      const float found = likeness(wanted, begin);
      if (found <= best_likeness) continue;
      best_likeness = found;
      best = begin;
    }
  };
  search(nominal - search_, nominal + search_, stride_);
  const std::int64_t rough = best;
  search(std::max(rough - stride_ + 1, nominal - search_),
         std::min(rough + stride_ - 1, nominal + search_), 1);
  return best;
}

}  // namespace dance
