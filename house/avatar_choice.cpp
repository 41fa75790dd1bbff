#include "house/avatar_choice.h"

#include <algorithm>
#include <charconv>
#include <filesystem>

#include "core/base/text/plain_text.h"
#include "core/program/confinement.h"
#include "formats/avatar/avatar_reader.h"
#include "formats/body/look_names.h"

namespace dance {
namespace {

namespace fs = std::filesystem;

static_assert(AvatarStore::kMostFileBytes == kMaxAvatarFileBytes);

constexpr std::array<std::string_view, 3> kEndings{".vrm", ".glb", ".gltf"};

bool is_file_name(const std::string& what) {
  return what.find('/') != std::string::npos ||
         std::ranges::any_of(kEndings, [&](auto ending) { return what.ends_with(ending); });
}

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

Result<void> choose_file(const std::string& path, const AvatarStore& store, ChosenAvatar& chosen) {
  DANCE_TRY(const AvatarStore::Kept kept, AvatarStore::read_file(path));
  const std::string name = fs::path(path).filename().string();
  auto read = run_confined([&] { return read_avatar(kept.bytes, {}, name); });
  if (!read) return fail("the avatar " + path + " cannot be read: " + read.error().what);
  chosen.notes = std::move(read->notes);
  if (auto stored = store.keep_own(kept, path.ends_with(".vrm")); !stored) return stored;
  chosen.file.hash = kept.hash;
  chosen.file.size_bytes = static_cast<std::int32_t>(kept.bytes.size());
  // Other houses refuse a name that is too long or not plain text.
  if (!is_plain_text(name) || !chosen.file.name.assign(name))
    static_cast<void>(chosen.file.name.assign(path.ends_with(".vrm") ? "avatar.vrm" : "avatar"));
  return {};
}

Result<void> choose_name(const AvatarChoice& choice, const std::string& shipped_folder,
                         ChosenAvatar& chosen) {
  const std::vector<std::string> shipped = shipped_avatars(shipped_folder);
  const bool is_shipped = std::ranges::find(shipped, choice.what) != shipped.end();
  std::string name = choice.what;
  if (!is_shipped && (name.empty() || name == kMannequinName))
    name = choice.look.empty() ? std::string(kMannequinName) : choice.look;
  else if (!choice.look.empty())
    return fail("a look is the mannequin's: leave out '" + choice.what + "', or the look");
  const auto parsed = AvatarName::parse(name);
  if (!parsed || (!is_shipped && !is_look_name(name)))
    return fail("there is no avatar '" + name + "'; there are files (.vrm, .glb), " +
                (shipped.empty() ? "" : joined(shipped) + ", ") +
                "and mannequin with looks of these words, joined by '-': " + look_names());
  chosen.avatar.name = *parsed;
  return {};
}

}  // namespace

Result<std::array<float, 3>> parse_colour(const std::string& text) {
  std::string_view digits = text;
  if (digits.starts_with('#')) digits.remove_prefix(1);
  std::uint32_t rgb = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), rgb, 16);
  if (digits.size() != 6 || error != std::errc() || end != digits.data() + digits.size())
    return fail("the colour '" + text + "' is not written as #e04080");
  const Eigen::Vector3f linear = linear_from_srgb(rgb);
  return std::array<float, 3>{linear.x(), linear.y(), linear.z()};
}

Result<ChosenAvatar> choose_avatar(const AvatarChoice& choice, const AvatarStore& store,
                                   const std::string& shipped_folder) {
  ChosenAvatar chosen;
  if (!choice.colour.empty()) {
    DANCE_TRY(chosen.avatar.colour_rgb, parse_colour(choice.colour));
  }
  chosen.avatar.height_scale = static_cast<float>(choice.height);
  if (!is_valid(chosen.avatar)) return fail("a height is 0.25 to 4 times the dancer's");
  if (is_file_name(choice.what)) {
    if (!choice.look.empty())
      return fail("a look is the mannequin's: leave out '" + choice.what + "', or the look");
    if (auto read = choose_file(choice.what, store, chosen); !read)
      return tl::make_unexpected(read.error());
  } else if (auto named = choose_name(choice, shipped_folder, chosen); !named) {
    return tl::make_unexpected(named.error());
  }
  return chosen;
}

AvatarOfGuest parse_avatar_of_guest(const std::string& text) {
  const std::size_t equals = text.find('=');
  const auto guest = GuestId::parse(std::string_view(text).substr(0, equals));
  if (equals == std::string::npos || !guest) return {GuestId(), text};
  return {*guest, text.substr(equals + 1)};
}

}  // namespace dance
