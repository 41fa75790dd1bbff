#include "haptics/haptic_table.h"

#include <algorithm>
#include <array>

#include "haptics/evdev/evdev_output.h"
#include "haptics/osc/osc_haptics.h"
#if DANCE_HAVE_BHAPTICS
#include "haptics/bhaptics/bhaptics_output.h"
#endif
#if DANCE_HAVE_SOUND
#include "haptics/sound/sound_output.h"
#endif

namespace dance {
namespace {

using Made = Result<std::unique_ptr<HapticOutput>>;

struct Row {
  const char* name;
  bool has_address;  // else a device
  Made (*make)(const HapticOptions&);
  std::unique_ptr<HapticOutput> (*later)(const HapticOptions&);  // null: not this kind
};

Made make_bhaptics([[maybe_unused]] const HapticOptions& options) {
#if DANCE_HAVE_BHAPTICS
  return BhapticsOutput::open(options.address);
#else
  return fail("built without bHaptics: apt-get install libwebsockets-dev, and build again");
#endif
}

#if DANCE_HAVE_BHAPTICS
constexpr auto kBhapticsLater = [](const HapticOptions& o) {
  return BhapticsOutput::later(o.address);
};
#else
constexpr std::nullptr_t kBhapticsLater = nullptr;
#endif

#if DANCE_HAVE_SOUND
constexpr auto kSoundLater = [](const HapticOptions& o) { return SoundOutput::later(o.device); };
#else
constexpr std::nullptr_t kSoundLater = nullptr;
#endif

Made make_sound([[maybe_unused]] const HapticOptions& options) {
#if DANCE_HAVE_SOUND
  return SoundOutput::open(options.device);
#else
  return fail("built without sound: apt-get install libpulse-dev, and build again");
#endif
}

constexpr std::array<Row, 4> kRows{{
    {"evdev", false, [](const HapticOptions& o) { return EvdevOutput::open(o.device); },
     [](const HapticOptions& o) { return EvdevOutput::later(o.device); }},
    {"osc", true, [](const HapticOptions& o) { return OscHaptics::open(o.address); },
     [](const HapticOptions& o) { return OscHaptics::later(o.address); }},
    {"bhaptics", true, make_bhaptics, kBhapticsLater},
    {"sound", false, make_sound, kSoundLater},
}};

Result<const Row*> find_row(const std::string& name) {
  std::string known;
  for (const Row& row : kRows) {
    if (row.name == name) return &row;
    known += (known.empty() ? "" : ", ") + std::string(row.name);
  }
  return fail("there is no kind of device '" + name + "'; there are: " + known);
}

}  // namespace

std::vector<std::string> haptic_output_names() {
  std::vector<std::string> names;
  for (const Row& row : kRows) names.emplace_back(row.name);
  return names;
}

Result<void> check_haptic_options(const std::string& to, const HapticOptions& options) {
  DANCE_TRY(const Row* row, find_row(to));
  if (row->has_address && !options.device.empty())
    return fail("'" + to + "' takes an address, as 127.0.0.1:9001, not a device");
  if (!row->has_address && !options.address.empty())
    return fail("'" + to + "' takes a device, not an address");
  return {};
}

Result<std::unique_ptr<HapticOutput>> make_haptic_output(const std::string& to,
                                                         const HapticOptions& options) {
  if (auto checked = check_haptic_options(to, options); !checked)
    return tl::make_unexpected(checked.error());
  DANCE_TRY(const Row* row, find_row(to));
  return row->make(options);
}

std::unique_ptr<HapticOutput> haptic_output_for_later(const std::string& to,
                                                      const HapticOptions& options) {
  const auto row = find_row(to);
  return row && (*row)->later ? (*row)->later(options) : nullptr;
}

Result<std::uint32_t> parse_bones(const std::vector<std::string>& names) {
  std::uint32_t bones = 0;
  for (const std::string& name : names) {
    const auto bone = find_bone(name);
    if (!bone) {
      std::string known;
      for (const BoneInfo& each : kBones)
        known += (known.empty() ? "" : ", ") + std::string(each.name);
      return fail("there is no bone '" + name + "'; there are: " + known);
    }
    bones |= 1u << index_of(*bone);
  }
  return bones == 0 ? kAllBones : bones;
}

Result<HapticMakerOptions> parse_felt(const std::vector<std::string>& words) {
  HapticMakerOptions felt{false, false, FeltBeats::kNone};
  for (const std::string& word : words) {
    if (word == "touch")
      felt.touch = true;
    else if (word == "lead")
      felt.lead = true;
    else if (word == "one")
      felt.beats = FeltBeats::kOne;
    else if (word == "beats")
      felt.beats = FeltBeats::kAll;
    else
      return fail("there is nothing to feel by the name '" + word +
                  "'; there are: touch, lead, one (of each bar), beats (all of them)");
  }
  return felt;
}

}  // namespace dance
