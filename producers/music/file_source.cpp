#include "producers/music/file_source.h"

#include <algorithm>

namespace dance {

Result<void> FileSource::read(std::int64_t frame, std::span<float> interleaved) {
  std::fill(interleaved.begin(), interleaved.end(), 0.0f);
  const std::int64_t length = file_.length_frames();
  auto frames = static_cast<std::int64_t>(interleaved.size() / 2);
  if (frame < 0) {
    const std::int64_t silent = std::min(-frame, frames);
    interleaved = interleaved.subspan(static_cast<std::size_t>(2 * silent));
    frame += silent;
  }
  while (!interleaved.empty()) {
    if (frame >= length && !loops_) return {};
    const std::int64_t file_frame = frame % length;
    if (file_.at_frame() != file_frame)
      if (auto found = file_.seek(file_frame); !found) return found;
    frames = std::min<std::int64_t>(static_cast<std::int64_t>(interleaved.size() / 2),
                                    length - file_frame);
    const auto part = interleaved.first(static_cast<std::size_t>(2 * frames));
    DANCE_TRY(const std::size_t read, file_.read_stereo(part));
    // A file that holds less than its header states: the rest is silence.
    if (read == 0) return {};
    frame += frames;
    interleaved = interleaved.subspan(part.size());
  }
  return {};
}

}  // namespace dance
