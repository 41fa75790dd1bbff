// SectionSound: renders one section of a score with its tail, in steps.
//
// Units/frames: frames from the begin of the section; stereo samples are interleaved.
// Ownership:    keeps a copy of the section's notes, its synth, and all that is rendered.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "producers/music/band/band_score.h"
#include "producers/music/band/synth/band_reverb.h"
#include "producers/music/band/synth/band_synth.h"

namespace dance {

class SectionSound {
 public:
  // The synth is new.
  SectionSound(const BandSection& section, std::unique_ptr<BandSynth> synth);

  std::int64_t begin_frame() const { return begin_frame_; }
  std::int64_t ready_frames() const { return static_cast<std::int64_t>(samples_.size() / 2); }
  // Renders until `frames` are ready, or all; returns how many it rendered.
  std::int64_t render_to(std::int64_t frames);
  // Adds ready frames.
  void add_to(std::int64_t from, std::span<float> interleaved) const;

  // Continues with the notes of a changed section. False if ready frames would differ.
  bool try_change(const BandSection& section);

 private:
  struct Event {
    std::int64_t frame;
    bool begins;
    BandNote note;

    bool operator==(const Event& other) const {
      return frame == other.frame && begins == other.begins && note.voice == other.note.voice &&
             note.key == other.note.key && note.velocity == other.note.velocity;
    }
  };

  static std::vector<Event> events_of(const BandSection& section);
  void render_block();
  float fade_at(std::int64_t frame) const;

  std::int64_t begin_frame_;
  std::int64_t frames_;  // with the tail
  std::vector<Event> events_;
  std::size_t next_event_ = 0;
  std::unique_ptr<BandSynth> synth_;  // until all is ready
  BandReverb reverb_;
  std::vector<float> samples_;
};

}  // namespace dance
