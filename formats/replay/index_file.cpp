#include "formats/replay/index_file.h"

#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <memory>

#include "core/base/fnv1a.h"
#include "core/program/whole_file.h"

namespace dance {
namespace {

constexpr std::uint64_t kEnd_bytes = 64 << 10;

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};

std::string cache_folder() {
  const char* cache = std::getenv("XDG_CACHE_HOME");
  if (cache != nullptr && cache[0] == '/') return std::string(cache) + "/dancegraph";
  const char* home = std::getenv("HOME");
  if (home != nullptr && home[0] == '/') return std::string(home) + "/.cache/dancegraph";
  return "";
}

}  // namespace

Result<LogMark> mark_of_log(const std::string& path) {
  struct stat found {};
  if (stat(path.c_str(), &found) != 0) return fail(path + ": " + std::strerror(errno));
  LogMark mark;
  if (!S_ISREG(found.st_mode)) return mark;  // nothing is kept of devices
  mark.bytes = static_cast<std::uint64_t>(found.st_size);
  mark.changed_ns = found.st_mtim.tv_sec * 1'000'000'000 + found.st_mtim.tv_nsec;
  const std::unique_ptr<std::FILE, CloseFile> file(std::fopen(path.c_str(), "rb"));
  if (!file) return fail(path + ": " + std::strerror(errno));
  std::vector<std::uint8_t> end(kEnd_bytes);
  mark.ends_hash = kFnvBegin;
  for (const bool is_first : {true, false}) {
    if (!is_first &&
        fseeko(file.get(), static_cast<off_t>(mark.bytes - std::min(mark.bytes, kEnd_bytes)),
               SEEK_SET) != 0)
      break;
    const std::size_t got = std::fread(end.data(), 1, end.size(), file.get());
    mark.ends_hash = fnv1a(std::span(end).first(got), mark.ends_hash);
  }
  return mark;
}

std::vector<std::string> index_places(const std::string& log_path, bool stage_only) {
  const std::string ending = stage_only ? ".stage-only.index" : ".index";
  std::vector<std::string> places{log_path + ending};
  const std::string cache = cache_folder();
  if (cache.empty()) return places;
  std::error_code error;
  const std::string whole = std::filesystem::absolute(log_path, error).lexically_normal().string();
  const std::uint64_t hash = fnv1a(whole);
  std::array<char, 24> name{};
  std::snprintf(name.data(), name.size(), "/%016llx", static_cast<unsigned long long>(hash));
  places.push_back(cache + name.data() + ending);
  return places;
}

Result<ReplayIndex> load_index(const std::string& log_path, const LogMark& mark, bool stage_only) {
  std::string why = "it was not looked through yet";
  if (mark.bytes == 0) return fail(why);
  for (const std::string& place : index_places(log_path, stage_only)) {
    std::error_code error;
    if (!std::filesystem::is_regular_file(place, error)) continue;
    const auto bytes = read_whole_file(place, ReplayIndexLimits::kFile_bytes);
    if (!bytes) continue;
    auto index = read_index({reinterpret_cast<const std::uint8_t*>(bytes->data()), bytes->size()});
    if (!index)
      why = index.error().what;
    else if (index->log != mark || index->stage_only != stage_only)
      why = "the log has changed since";
    else
      return index;
  }
  return fail(why);
}

Result<std::string> save_index(const std::string& log_path, const ReplayIndex& index) {
  if (index.log.bytes == 0) return fail(log_path + ": is no file beside which an index could be");
  const std::vector<std::uint8_t> bytes = write_index(index);
  std::string why;
  for (const std::string& place : index_places(log_path, index.stage_only)) {
    std::error_code ignored;
    if (place != log_path && !why.empty())
      std::filesystem::create_directories(std::filesystem::path(place).parent_path(), ignored);
    auto written = write_whole_file(place, std::span<const std::uint8_t>(bytes));
    if (written) return place;
    why += (why.empty() ? "" : "; ") + written.error().what;
  }
  return fail(why);
}

}  // namespace dance
