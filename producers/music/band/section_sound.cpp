#include "producers/music/band/section_sound.h"

#include <algorithm>
#include <tuple>

#include "core/base/assert.h"

namespace dance {
namespace {

constexpr std::int64_t kFade_frames = 24000;

std::int64_t frames_of(const BandSection& section) {
  return section.end_frame - section.begin_frame + BandScore::kTail_frames;
}

}  // namespace

SectionSound::SectionSound(const BandSection& section, std::unique_ptr<BandSynth> synth)
    : begin_frame_(section.begin_frame),
      frames_(frames_of(section)),
      events_(events_of(section)),
      synth_(std::move(synth)) {
  samples_.reserve(static_cast<std::size_t>(2 * frames_));
}

std::vector<SectionSound::Event> SectionSound::events_of(const BandSection& section) {
  std::vector<Event> events;
  events.reserve(2 * section.notes.size());
  for (const BandNote& note : section.notes) {
    events.push_back({note.begin_frame - section.begin_frame, true, note});
    events.push_back({note.end_frame - section.begin_frame, false, note});
  }
  // Ends come before begins, so that a key may be struck again.
  std::stable_sort(events.begin(), events.end(), [](const Event& a, const Event& b) {
    return std::tuple(a.frame, a.begins) < std::tuple(b.frame, b.begins);
  });
  return events;
}

std::int64_t SectionSound::render_to(std::int64_t frames) {
  const std::int64_t before = ready_frames();
  while (ready_frames() < std::min(frames, frames_)) render_block();
  if (ready_frames() == frames_) synth_ = nullptr;
  return ready_frames() - before;
}

void SectionSound::render_block() {
  DANCE_ASSERT(synth_ != nullptr, ready_frames(), frames_);
  const std::int64_t at = ready_frames();
  for (; next_event_ < events_.size() && events_[next_event_].frame <= at; ++next_event_) {
    const Event& event = events_[next_event_];
    if (event.begins)
      synth_->begin_note(event.note.voice, event.note.key, event.note.velocity);
    else
      synth_->end_note(event.note.voice, event.note.key);
  }
  BandBlock block;
  synth_->render(block);
  reverb_.process(block);
  for (std::size_t n = 0; n < block.left.size(); ++n) {
    const float fade = fade_at(at + static_cast<std::int64_t>(n));
    samples_.push_back(fade * block.left[n]);
    samples_.push_back(fade * block.right[n]);
  }
}

float SectionSound::fade_at(std::int64_t frame) const {
  const std::int64_t left = frames_ - frame;
  return left >= kFade_frames ? 1.0f : static_cast<float>(left) / kFade_frames;
}

void SectionSound::add_to(std::int64_t from, std::span<float> interleaved) const {
  const auto begin = static_cast<std::size_t>(2 * from);
  DANCE_ASSERT(begin + interleaved.size() <= samples_.size(), from, interleaved.size());
  for (std::size_t i = 0; i < interleaved.size(); ++i) interleaved[i] += samples_[begin + i];
}

bool SectionSound::try_change(const BandSection& section) {
  if (section.begin_frame != begin_frame_) return false;
  const std::int64_t frames = frames_of(section);
  std::vector<Event> events = events_of(section);
  const bool same_length = frames == frames_;
  if (!same_length && ready_frames() > std::min(frames, frames_) - kFade_frames) return false;
  if (events.size() < next_event_ ||
      !std::equal(events.begin(), events.begin() + static_cast<std::ptrdiff_t>(next_event_),
                  events_.begin()))
    return false;
  if (next_event_ < events.size() && events[next_event_].frame < ready_frames()) return false;
  frames_ = frames;
  events_ = std::move(events);
  return true;
}

}  // namespace dance
