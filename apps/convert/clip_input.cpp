#include "apps/convert/clip_input.h"

#include <algorithm>
#include <chrono>
#include <filesystem>

#include "formats/bvh/clip_file.h"
#include "formats/clip/dancers_file.h"
#include "formats/recording/clip_source.h"

namespace dance {
namespace {

std::int64_t changed_us(const std::string& path) {
  std::error_code error;
  const auto time = std::filesystem::last_write_time(path, error);
  if (error) return 0;
  const auto wall = std::chrono::file_clock::to_sys(time).time_since_epoch();
  return std::max<std::int64_t>(
      1, std::chrono::duration_cast<std::chrono::microseconds>(wall).count());
}

class ClipInput : public ConvertSource {
 public:
  ClipInput(std::vector<NamedClip> clips, std::vector<GuestId> names, std::int64_t start_us)
      : clips_(std::move(clips)), names_(std::move(names)), start_us_(start_us) {}

  Result<void> read_into(RecordingSink& sink) override {
    std::vector<GuestClip> guests;
    for (std::size_t i = 0; i < clips_.size(); ++i) guests.push_back({names_[i], &clips_[i].clip});
    play_clips_into(guests, start_us_, sink);
    return {};
  }
  std::vector<std::string> notes() const override {
    std::vector<std::string> all;
    for (const NamedClip& clip : clips_)
      all.insert(all.end(), clip.notes.begin(), clip.notes.end());
    return all;
  }

 private:
  std::vector<NamedClip> clips_;
  std::vector<GuestId> names_;
  std::int64_t start_us_;
};

// As they are named, each once: alice, alice-2.
std::vector<GuestId> names_of(const std::vector<NamedClip>& clips) {
  std::vector<GuestId> names;
  for (const NamedClip& clip : clips) {
    const std::string name = guest_name_of(clip.name);
    GuestId id = GuestId::parse(name).value();
    for (int n = 2; std::find(names.begin(), names.end(), id) != names.end(); ++n) {
      const std::string end = "-" + std::to_string(n);
      id = GuestId::parse(name.substr(0, kMaxGuestIdLength - end.size()) + end).value();
    }
    names.push_back(id);
  }
  return names;
}

// Written by write_bvh(): bones of ours by name, and no others, in metres on their floor.
bool is_ours(const Bvh& bvh) {
  std::size_t bones = 0;
  for (const BvhJoint& joint : bvh.joints) {
    const bool is_finger =
        std::any_of(kFingerBones.begin(), kFingerBones.end(),
                    [&](const BoneInfo& bone) { return bone.name == joint.name; });
    if (!is_finger && !find_bone(joint.name)) return false;
    bones += !is_finger;
  }
  return bones == kBoneCount;
}

}  // namespace

Result<std::unique_ptr<ConvertSource>> open_bvh_input(const std::string& path,
                                                      const GuestId& guest) {
  DANCE_TRY(const std::string text, read_clip_text(path));
  const auto bvh = read_bvh(text);
  if (!bvh) return fail(path + ": " + bvh.error().what);
  RetargetOptions options;
  if (is_ours(*bvh)) {
    options.metres_per_unit = 1.0;
    options.up = UpAxis::kY;
    options.puts_feet_on_floor = false;
  }
  auto retargeted = retarget(*bvh, options);
  if (!retargeted) return fail(path + ": " + retargeted.error().what);
  std::vector<NamedClip> clips(1);
  clips[0].clip = std::move(retargeted->clip);
  clips[0].notes = std::move(retargeted->notes);
  const GuestId name = guest.is_set() ? guest : GuestId::parse(guest_name_of(path)).value();
  return std::make_unique<ClipInput>(std::move(clips), std::vector{name}, changed_us(path));
}

Result<std::unique_ptr<ConvertSource>> open_glb_input(const std::string& path,
                                                      const GuestId& guest) {
  DANCE_TRY(std::vector<NamedClip> clips, load_dancers(path));
  std::vector<GuestId> names = names_of(clips);
  if (guest.is_set() && names.size() == 1) names[0] = guest;
  return std::make_unique<ClipInput>(std::move(clips), std::move(names), changed_us(path));
}

}  // namespace dance
