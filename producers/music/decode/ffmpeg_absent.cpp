#include "producers/music/decode/audio_decoder.h"

namespace dance {

Result<std::unique_ptr<AudioDecoder>> open_with_ffmpeg(const std::string& path) {
  return fail(
      "libsndfile cannot read it, and this dance was built without FFmpeg; install "
      "libavformat-dev libavcodec-dev libavutil-dev libswresample-dev and build again, or "
      "convert it to " +
      other_audio_format(path));
}

}  // namespace dance
