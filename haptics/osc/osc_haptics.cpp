#include "haptics/osc/osc_haptics.h"

#include "core/base/deadline.h"
#include "core/base/fixed_string.h"

namespace dance {
namespace {

using OscName = FixedString<63>;

OscName joined(std::string_view front, std::string_view bone) {
  std::array<char, 63> text{};
  std::size_t size = 0;
  for (const std::string_view part : {front, bone})
    for (const char c : part)
      if (size < text.size()) text[size++] = c;
  OscName name;
  [[maybe_unused]] const bool fits = name.assign({text.data(), size});
  return name;
}

}  // namespace

Result<std::unique_ptr<HapticOutput>> OscHaptics::open(const std::string& address) {
  DANCE_TRY(OscOutput output, OscOutput::open(address, kUsualAddress));
  return std::unique_ptr<HapticOutput>(new OscHaptics(std::move(output)));
}

void OscHaptics::send_level(std::size_t bone, float level) {
  writer_.add(joined("/avatar/parameters/dance_", kBones[bone].name).c_str(), {level});
}

bool OscHaptics::play(const Haptic& haptic, MonoTime now) {
  const std::size_t bone = index_of(haptic.bone);
  writer_.add(
      joined("/dance/haptic/", kBones[bone].name).c_str(),
      {haptic.amplitude, static_cast<float>(haptic.duration.as_seconds()), haptic.frequency_hz});
  send_level(bone, haptic.amplitude);
  writer_.flush();
  const MonoTime end = now + haptic.duration;
  if (end > ends_[bone]) ends_[bone] = end;
  return true;
}

MonoTime OscHaptics::work(MonoTime now) {
  MonoTime next;
  bool has_ended = false;
  for (std::size_t bone = 0; bone < kBoneCount; ++bone) {
    MonoTime& end = ends_[bone];
    if (!end.is_set()) continue;
    if (end > now) {
      next = earlier(next, end);
      continue;
    }
    end = MonoTime();
    send_level(bone, 0.0f);
    has_ended = true;
  }
  if (has_ended) writer_.flush();
  return next;
}

void OscHaptics::stop() {
  for (std::size_t bone = 0; bone < kBoneCount; ++bone)
    if (ends_[bone].is_set()) send_level(bone, 0.0f);
  ends_ = {};
  writer_.flush();
}

}  // namespace dance
