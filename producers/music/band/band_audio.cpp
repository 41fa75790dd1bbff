#include "producers/music/band/band_audio.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <list>

#include "producers/music/band/section_sound.h"
#include "producers/music/band/synth/band_module.h"
#include "producers/music/band/synth/own_instruments.h"

namespace dance {
namespace {

// The section that is played, the one before with its tail, and three within the eight seconds that
// a player prepares ahead: at fast tempi four bars last less than five seconds.
constexpr std::size_t kMostKept = 5;

// Leaves samples below kKnee as they are and lets none exceed kCeiling. It has no state: a frame
// sounds the same wherever reading began.
float limited(float sample) {
  constexpr float kKnee = 0.6f;
  constexpr float kCeiling = 0.86f;
  const float loud = std::abs(sample);
  if (loud <= kKnee) return sample;
  const float over = (loud - kKnee) / (kCeiling - kKnee);
  return std::copysign(kKnee + (kCeiling - kKnee) * over / (1.0f + over), sample);
}

}  // namespace

class BandAudio::Impl {
 public:
  Impl(std::shared_ptr<const BandScore> score, std::unique_ptr<BandInstruments> instruments)
      : score_(std::move(score)), instruments_(std::move(instruments)) {}

  std::string sound() const { return instruments_->name(); }
  const BandScore& score() const { return *score_; }

  void set_score(std::shared_ptr<const BandScore> score) {
    score_ = std::move(score);
    std::erase_if(kept_, [this](Kept& kept) {
      const auto sections = score_->sections();
      return kept.index >= sections.size() || !kept.sound.try_change(sections[kept.index]);
    });
  }

  bool prepare(std::int64_t frame, std::int64_t budget_frames) {
    if (frame < 0 || frame >= score_->length_frames()) return true;
    const std::size_t index = score_->section_at(frame);
    const std::int64_t begin = score_->sections()[index].begin_frame;
    if (index > 0 && frame < begin + BandScore::kTail_frames)
      budget_frames -= render(index - 1, frame + 1, budget_frames);
    if (budget_frames > 0) budget_frames -= render(index, frame + 1, budget_frames);
    return budget_frames > 0;
  }

  void read(std::int64_t frame, std::span<float> interleaved) {
    std::fill(interleaved.begin(), interleaved.end(), 0.0f);
    const std::int64_t end = frame + static_cast<std::int64_t>(interleaved.size() / 2);
    const std::int64_t to = std::min(end, score_->length_frames());
    for (std::int64_t at = std::max<std::int64_t>(frame, 0); at < to;) {
      const std::size_t index = score_->section_at(at);
      const bool is_last = index + 1 == score_->sections().size();
      const std::int64_t run_end = is_last ? to : std::min(to, score_->sections()[index].end_frame);
      const auto from = static_cast<std::size_t>(2 * (at - frame));
      const auto size = static_cast<std::size_t>(2 * (run_end - at));
      if (index > 0) add(index - 1, at, interleaved.subspan(from, size));
      add(index, at, interleaved.subspan(from, size));
      at = run_end;
    }
    for (float& sample : interleaved) sample = limited(sample);
  }

 private:
  struct Kept {
    std::size_t index;
    SectionSound sound;
  };

  // The newest is at the front.
  SectionSound& section(std::size_t index) {
    const auto found = std::find_if(kept_.begin(), kept_.end(),
                                    [&](const Kept& kept) { return kept.index == index; });
    if (found != kept_.end()) {
      kept_.splice(kept_.begin(), kept_, found);
      return kept_.front().sound;
    }
    if (kept_.size() == kMostKept) kept_.pop_back();
    kept_.push_front({index, SectionSound(score_->sections()[index], instruments_->make_synth())});
    return kept_.front().sound;
  }

  std::int64_t render(std::size_t index, std::int64_t to_frame, std::int64_t most_frames) {
    SectionSound& sound = section(index);
    const std::int64_t wanted = to_frame - sound.begin_frame();
    return sound.render_to(std::min(wanted, sound.ready_frames() + most_frames));
  }

  void add(std::size_t index, std::int64_t at, std::span<float> interleaved) {
    const BandSection& notes = score_->sections()[index];
    const std::int64_t end = std::min(at + static_cast<std::int64_t>(interleaved.size() / 2),
                                      notes.end_frame + BandScore::kTail_frames);
    if (end <= at) return;
    render(index, end, end - notes.begin_frame);
    section(index).add_to(at - notes.begin_frame,
                          interleaved.first(static_cast<std::size_t>(2 * (end - at))));
  }

  std::shared_ptr<const BandScore> score_;
  std::unique_ptr<BandInstruments> instruments_;
  std::list<Kept> kept_;
};

BandSound best_band_sound() {
  if (!has_band_module()) return {};
  // The first is the one that the players' loudness is tuned with.
  for (const char* const file : {"TimGM6mb.sf2", "default-GM.sf2", "FluidR3_GM.sf2"}) {
    const std::string path = std::string("/usr/share/sounds/sf2/") + file;
    if (::access(path.c_str(), R_OK) == 0) return {path};
  }
  return {};
}

BandAudio::BandAudio(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
BandAudio::~BandAudio() = default;

Result<std::unique_ptr<BandAudio>> BandAudio::make(std::shared_ptr<const BandScore> score,
                                                   const BandSound& sound) {
  std::unique_ptr<BandInstruments> instruments;
  if (sound.soundfont.empty()) {
    instruments = make_own_instruments();
  } else {
    DANCE_TRY(instruments, open_soundfont(sound.soundfont));
  }
  return std::unique_ptr<BandAudio>(
      new BandAudio(std::make_unique<Impl>(std::move(score), std::move(instruments))));
}

std::string BandAudio::sound() const { return impl_->sound(); }
const BandScore& BandAudio::score() const { return impl_->score(); }
void BandAudio::set_score(std::shared_ptr<const BandScore> score) {
  impl_->set_score(std::move(score));
}
bool BandAudio::prepare(std::int64_t frame, std::int64_t budget_frames) {
  return impl_->prepare(frame, budget_frames);
}
void BandAudio::read_stereo(std::int64_t frame, std::span<float> interleaved) {
  impl_->read(frame, interleaved);
}

}  // namespace dance
