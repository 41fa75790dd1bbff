// FileSource: the sound of a music file.
//
// Ownership: owns the file.
#pragma once

#include "producers/music/decode/audio_file.h"
#include "producers/music/music_source.h"

namespace dance {

class FileSource : public MusicSource {
 public:
  explicit FileSource(AudioFile file) : file_(std::move(file)) {}

  double rate_hz() const override { return file_.rate_hz(); }
  Result<void> read(std::int64_t frame, std::span<float> interleaved) override;
  void set_loops(bool loops) override { loops_ = loops; }

 private:
  AudioFile file_;
  bool loops_ = false;
};

}  // namespace dance
