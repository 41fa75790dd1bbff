#include "house/dancer/dancer_file.h"

#include <algorithm>

#include "formats/recorded/recorded_file.h"
#include "formats/recording/clips_together.h"

namespace dance {
namespace {

constexpr double kLogClip_hz = 60.0;

Result<std::vector<NamedClip>> dancers_of_recording(const std::string& path) {
  DANCE_TRY(const auto file, RecordedFile::open(path));
  Recording recording;
  if (auto read = file->read_into(recording); !read) return tl::make_unexpected(read.error());
  ClipsTogether together = clips_together(recording, kLogClip_hz);
  std::vector<NamedClip> dancers;
  for (ClipsTogether::Of& of : together.clips)
    dancers.push_back(
        {std::string(of.guest.view()), std::move(of.clip), file->notes(), file->lost()});
  if (dancers.empty()) return fail(path + ": nobody dances in this recording");
  return dancers;
}

Result<std::vector<NamedClip>> dancers_of(const std::string& path) {
  DANCE_TRY(const FileKind kind, input_kind(path));
  return kind == FileKind::kBvh || kind == FileKind::kGlb ? load_dancers(path)
                                                          : dancers_of_recording(path);
}

std::vector<std::string> names_of_dancers(const std::vector<NamedClip>& dancers) {
  std::vector<std::string> names;
  for (const NamedClip& dancer : dancers) names.push_back(dancer.name);
  return names;
}

}  // namespace

Result<std::vector<std::string>> dancers_in_file(const std::string& path) {
  DANCE_TRY(const std::vector<NamedClip> dancers, dancers_of(path));
  return names_of_dancers(dancers);
}

std::string chosen_dancer(const std::string& asked, const GuestId& guest,
                          const std::vector<std::string>& names) {
  if (!asked.empty()) return asked;
  const auto found = std::find(names.begin(), names.end(), guest.view());
  if (found != names.end()) return *found;
  return names.empty() ? std::string() : names.front();
}

Result<NamedClip> load_dancer_of(const std::string& path, const std::string& asked,
                                 const GuestId& guest) {
  DANCE_TRY(std::vector<NamedClip> dancers, dancers_of(path));
  const std::vector<std::string> names = names_of_dancers(dancers);
  const std::string name = chosen_dancer(asked, guest, names);
  for (NamedClip& dancer : dancers)
    if (dancer.name == name) return std::move(dancer);
  std::string all;
  for (const std::string& it : names) all += (all.empty() ? "" : ", ") + it;
  return fail(path + ": none in it is called " + name + "; there are " + all);
}

}  // namespace dance
