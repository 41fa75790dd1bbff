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

tl::unexpected<Error> not_written(const std::string& path, const std::error_code& why) {
  return fail(fmt::format(
      "{} cannot be written: {}; name a file in a folder that is yours, with space left", path,
      why.message()));
}

// What the system says of it where it went wrong.
std::error_code put(const fs::path& file, std::string_view content) {
  errno = 0;
  std::ofstream out(file, std::ios::binary | std::ios::trunc);
  out.write(content.data(), static_cast<std::streamsize>(content.size()));
  out.close();
  if (out) return {};
  return {errno != 0 ? errno : EIO, std::generic_category()};
}

}  // namespace

Result<void> write_whole_file(const std::string& path, std::string_view content) {
  std::error_code error;
  // A link stays a link: what it leads to is written.
  fs::path place = fs::canonical(path, error);
  if (error) place = path;
  const fs::file_status status = fs::status(place, error);
  if (fs::exists(status) && !fs::is_regular_file(status)) {
    if (const std::error_code why = put(place, content)) return not_written(path, why);
    return {};
  }
  const fs::path beside = fmt::format("{}.{}.part", place.native(), getpid());
  std::error_code why = put(beside, content);
  if (!why) fs::rename(beside, place, why);
  if (!why) return {};
  fs::remove(beside, error);
  return not_written(path, why);
}

Result<void> write_whole_file(const std::string& path, std::span<const std::uint8_t> content) {
  return write_whole_file(
      path, std::string_view(reinterpret_cast<const char*>(content.data()), content.size()));
}

}  // namespace dance
