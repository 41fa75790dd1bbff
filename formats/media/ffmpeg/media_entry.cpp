// The one function that the media module exports.
#include <cstring>

#include "formats/media/ffmpeg/picture_decoder.h"
#include "formats/media/ffmpeg/picture_encoder.h"
#include "formats/media/ffmpeg/sound_decoder.h"
#include "formats/media/media_module.h"

extern "C" __attribute__((visibility("default"))) const void* dance_media_module_1(
    const char* interface_hash) {
  static constexpr dance::MediaModule kModule{&dance::FfmpegDecoder::open,
                                              &dance::PictureStream::open,
                                              &dance::create_video_file, &dance::encodable_formats};
  return std::strcmp(interface_hash, DANCE_MEDIA_INTERFACE) == 0 ? &kModule : nullptr;
}
