#include "formats/media/media_module.h"

#include <mutex>

#include "core/program/program_module.h"

namespace dance {
namespace {

#ifdef DANCE_HAVE_FFMPEG
constexpr const char* kMediaCure =
    "install the package dancegraph-media (apt-get install ./dancegraph-media_*.deb)";
#else
constexpr const char* kMediaCure =
    "this build was made without it; install libavformat-dev libavcodec-dev libavutil-dev "
    "libswresample-dev libswscale-dev and build again";
#endif

}  // namespace

Result<const MediaModule*> media_module_from(const std::string& path) {
  DANCE_TRY(const void* const table,
            load_module(path, {"FFmpeg", "dancegraph-media", kMediaCure, "dance_media_module_1",
                               DANCE_MEDIA_INTERFACE}));
  return static_cast<const MediaModule*>(table);
}

Result<const MediaModule*> media_module() {
  static std::mutex mutex;
  static const MediaModule* loaded = nullptr;
  const std::lock_guard lock(mutex);
  if (loaded == nullptr) {
#ifndef DANCE_HAVE_FFMPEG
    // A module that lies here was made by another build.
    return fail("FFmpeg is needed and not here: " + std::string(kMediaCure));
#endif
    const std::string path = module_path("libdance_media.so");
    if (path.empty())
      return fail("FFmpeg is needed, and this program cannot tell where it lies; is /proc there?");
    DANCE_TRY(loaded, media_module_from(path));
  }
  return loaded;
}

}  // namespace dance
