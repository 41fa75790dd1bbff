#include "formats/media/media_module.h"

#include <dlfcn.h>
#include <unistd.h>

#include <filesystem>
#include <mutex>

#include "core/base/printable.h"
#include "core/program/program.h"

namespace dance {
namespace {

using EntryFunction = decltype(&dance_media_module_1);

constexpr const char* kEntryName = "dance_media_module_1";

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
  if (::access(path.c_str(), R_OK) != 0)
    return fail("FFmpeg is needed and not here: " + std::string(kMediaCure));
  void* const module = ::dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (module == nullptr)
    return fail("FFmpeg is needed and cannot be loaded (" + printable(::dlerror()) +
                "): " + kMediaCure);
  const auto entry = reinterpret_cast<EntryFunction>(::dlsym(module, kEntryName));
  const MediaModule* const table = entry != nullptr ? entry(DANCE_MEDIA_INTERFACE) : nullptr;
  if (table == nullptr) {
    ::dlclose(module);
    return fail(path + " is of another version than this program; install dancegraph and " +
                "dancegraph-media of the same version, or build all again");
  }
  return table;
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
    const auto prefix = std::filesystem::path(program_folder()).parent_path();
    // Never from the folder that somebody happens to work in.
    if (!prefix.is_absolute())
      return fail("FFmpeg is needed, and this program cannot tell where it lies; is /proc there?");
    DANCE_TRY(loaded, media_module_from(prefix / "lib/dancegraph/libdance_media.so"));
  }
  return loaded;
}

}  // namespace dance
