#include "core/program/whole_file.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <fstream>
#include <system_error>

namespace dance {
namespace {

namespace fs = std::filesystem;

constexpr const char* kCure = "name a file in a folder that is yours, with space left";

tl::unexpected<Error> not_written(const std::string& path, const std::error_code& why,
                                  const std::string& then = kCure) {
  return fail(fmt::format("{} cannot be written: {}; {}", path, why.message(), then));
}

// The system's message for the failed call.
std::error_code put(const fs::path& file, std::string_view content) {
  errno = 0;
  std::ofstream out(file, std::ios::binary | std::ios::trunc);
  out.write(content.data(), static_cast<std::streamsize>(content.size()));
  out.close();
  if (out) return {};
  return {errno != 0 ? errno : EIO, std::generic_category()};
}

struct Place {
  fs::path file, beside;
  fs::file_status was;
  // Pipes and devices are not renamed onto.
  bool is_device() const { return fs::exists(was) && !fs::is_regular_file(was); }
};

Place place_of(const std::string& path) {
  std::error_code error;
  // A symbolic link stays: its target is written.
  Place place{fs::canonical(path, error), {}, {}};
  if (error) {
    place.file = path;
    const fs::path target = fs::read_symlink(path, error);
    if (!error) place.file = place.file.parent_path() / target;
  }
  place.was = fs::status(place.file, error);
  place.beside = fmt::format("{}.{}.part", place.file.native(), getpid());
  return place;
}

}  // namespace

Result<void> try_whole_file(const std::string& path) {
  const Place place = place_of(path);
  std::error_code why, error;
  if (place.is_device()) {
    if (fs::is_directory(place.was))
      why = std::make_error_code(std::errc::is_a_directory);
    else if (access(place.file.c_str(), W_OK) != 0)
      why = {errno, std::generic_category()};
  } else {
    why = put(place.beside, {});
    fs::remove(place.beside, error);
  }
  if (why) return not_written(path, why);
  return {};
}

Result<void> write_whole_file(const std::string& path, std::string_view content) {
  const Place place = place_of(path);
  std::error_code error;
  if (place.is_device()) {
    if (const std::error_code why = put(place.file, content)) return not_written(path, why);
    return {};
  }
  if (const std::error_code why = put(place.beside, content)) {
    fs::remove(place.beside, error);
    return not_written(path, why);
  }
  if (fs::exists(place.was)) fs::permissions(place.beside, place.was.permissions(), error);
  std::error_code why;
  fs::rename(place.beside, place.file, why);
  // The temporary file is kept: it may have taken minutes to make.
  if (why) return not_written(path, why, "what was to be there is in " + place.beside.native());
  return {};
}

Result<void> write_whole_file(const std::string& path, std::span<const std::uint8_t> content) {
  return write_whole_file(
      path, std::string_view(reinterpret_cast<const char*>(content.data()), content.size()));
}

}  // namespace dance
