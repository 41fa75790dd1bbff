#include "producers/music/room/band_source.h"

#include <algorithm>

namespace dance {
namespace {

// Sound is rendered this far ahead of reading, so that no section delays it.
constexpr std::int64_t kAhead_frames = std::int64_t{8} * kBandRate_hz;
// In each turn of 10 ms: four times as fast as it is played.
constexpr std::int64_t kBudget_frames = 4 * kBandRate_hz / 100;

}  // namespace

Result<std::unique_ptr<BandSource>> BandSource::make(std::shared_ptr<BandSet> set,
                                                     const BandSound& sound) {
  const auto score = std::make_shared<const BandScore>(
      BandScore::make(band_song(BandStyle::kSalsa, 0, usual_tempo_bpm(BandStyle::kSalsa))));
  std::array<std::unique_ptr<BandAudio>, 2> audio;
  for (auto& each : audio) {
    DANCE_TRY(each, BandAudio::make(score, sound));
  }
  return std::unique_ptr<BandSource>(new BandSource(std::move(set), std::move(audio)));
}

BandAudio& BandSource::audio_of(const BandSet::Part& part) {
  BandAudio& audio = *audio_[static_cast<std::size_t>(part.number % 2)];
  if (&audio.score() != part.score.get()) audio.set_score(part.score);
  return audio;
}

Result<void> BandSource::read(std::int64_t frame, std::span<float> interleaved) {
  if (!set_->is_set()) std::fill(interleaved.begin(), interleaved.end(), 0.0f);
  while (set_->is_set() && !interleaved.empty()) {
    const BandSet::Part& part = set_->part_at(frame);
    const auto frames = static_cast<std::int64_t>(interleaved.size() / 2);
    const std::int64_t here = std::min(frames, std::max<std::int64_t>(part.end_frame - frame, 1));
    const auto piece = interleaved.first(static_cast<std::size_t>(2 * here));
    audio_of(part).read_stereo(frame - part.begin_frame, piece);
    frame += here;
    interleaved = interleaved.subspan(piece.size());
  }
  return {};
}

void BandSource::prepare(std::int64_t frame) {
  if (!set_->is_set()) return;
  const BandSet::Part now = set_->part_at(frame);
  const std::int64_t until = frame + kAhead_frames;
  const std::int64_t last = now.score->length_frames() - 1;
  if (!audio_of(now).prepare(std::min(until - now.begin_frame, last), kBudget_frames)) return;
  if (until < now.end_frame) return;
  const BandSet::Part& next = set_->part_at(until);
  if (next.number == now.number + 1)
    audio_of(next).prepare(until - next.begin_frame, kBudget_frames);
}

}  // namespace dance
