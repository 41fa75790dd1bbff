#include "research/stage/stage_take.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include "core/program/whole_file.h"
#include "formats/avatar/avatar_reader.h"
#include "formats/avatar/mannequin_model.h"
#include "formats/clip/dancers_file.h"
#include "formats/kind/file_kind.h"
#include "formats/recording/clips_together.h"
#include "formats/recording/log_source.h"

namespace dance {
namespace {

constexpr std::size_t kMostDancers = 30;
constexpr std::string_view kMannequin = "mannequin";

Result<std::vector<StageDancer>> dancers_of(const std::string& path, double hz) {
  std::vector<StageDancer> dancers;
  if (std::filesystem::path(path).extension() == ".lcm") {
    DANCE_TRY(LogSource source, LogSource::open(path));
    Recording recording;
    if (auto read = source.read_into(recording); !read) return tl::make_unexpected(read.error());
    for (auto& of : clips_together(recording, hz).clips)
      dancers.push_back({std::string(of.guest.view()), std::move(of.clip)});
  } else {
    DANCE_TRY(std::vector<NamedClip> clips, load_dancers(path));
    for (NamedClip& clip : clips)
      dancers.push_back({clip.name.empty() ? std::filesystem::path(path).filename().string()
                                           : std::move(clip.name),
                         std::move(clip.clip)});
  }
  if (dancers.empty()) return fail(path + ": nobody dances in it");
  return dancers;
}

}  // namespace

std::size_t StageTake::frames() const {
  double shortest_s = 1e9;
  for (const StageDancer& dancer : dancers)
    shortest_s = std::min(shortest_s, dancer.clip.length().as_seconds());
  return dancers.empty() ? 0 : static_cast<std::size_t>(shortest_s * hz + 1e-3);
}

Result<StageTake> load_stage_take(std::span<const std::string> files, double hz) {
  StageTake take;
  take.hz = hz;
  for (const std::string& file : files) {
    DANCE_TRY(std::vector<StageDancer> dancers, dancers_of(file, hz));
    std::ranges::move(dancers, std::back_inserter(take.dancers));
  }
  if (take.dancers.empty()) return fail("nobody dances: name the files of a recorded couple");
  if (take.dancers.size() > kMostDancers)
    return fail("more than " + std::to_string(kMostDancers) + " dancers: name fewer files");
  if (take.frames() < 3) return fail(files[0] + ": too short, at least 3 frames are needed");
  return take;
}

Result<std::shared_ptr<const AvatarModel>> load_stage_avatar(const std::string& name,
                                                             const Skeleton& dancer) {
  if (name.starts_with(kMannequin)) {
    Skeleton body = dancer;
    if (name.size() > kMannequin.size()) {
      const double height_m = std::atof(name.c_str() + kMannequin.size() + 1);
      if (name[kMannequin.size()] != ':' || !(height_m >= 0.5 && height_m <= 2.5))
        return fail(name + ": a mannequin's height is 0.5 to 2.5 m, as mannequin:1.1");
      body = average_skeleton(static_cast<float>(height_m));
    }
    return std::make_shared<const AvatarModel>(
        mannequin_model(body, look_of(*GuestId::parse("guest")), true));
  }
  DANCE_TRY(const std::string bytes, read_whole_file(name, AvatarLimits().file_bytes));
  auto read = read_avatar({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()}, {},
                          std::filesystem::path(name).stem().string());
  if (!read) return fail(name + ": " + read.error().what);
  return std::make_shared<const AvatarModel>(std::move(read->model));
}

SceneState scene_of(const StageTake& take, const StageWear& wear, std::size_t frame) {
  SceneState scene;
  const Duration t = Duration::seconds(static_cast<double>(frame) / take.hz);
  scene.time = MonoTime() + Duration::s(1) + t;
  for (std::size_t d = 0; d < take.dancers.size(); ++d) {
    const MotionClip& clip = take.dancers[d].clip;
    SceneGuest& guest = scene.guests.emplace_back();
    guest.id = *GuestId::parse("dancer-" + std::to_string(d + 1));
    guest.skeleton = clip.skeleton;
    sample_clip(clip, t + Duration::ns(100), ClipEnd::kHold, guest.pose);
    normalize(guest.pose);
    guest.avatar = wear.avatars[d];
    guest.figure_size = wear.size;
    guest.height_scale = wear.height_scale;
  }
  return scene;
}

}  // namespace dance
