#include "viewer/avatar/user_avatars.h"

#include <unistd.h>

#include <algorithm>

#include "core/program/confinement.h"
#include "formats/avatar/avatar_reader.h"

namespace dance {
namespace {

Result<AvatarModel> model_of(std::span<const std::uint8_t> bytes, std::string_view name,
                             const AvatarStop& stop) {
  auto read = read_avatar(bytes, {}, name, stop);
  if (!read) return tl::make_unexpected(std::move(read.error()));
  return std::move(read->model);
}

// "" for a name that is none.
std::string shipped_file(const std::string& folder, std::string_view name) {
  const std::string path = folder + "/" + std::string(name) + ".vrm";
  return GuestId::parse(name) && access(path.c_str(), R_OK) == 0 ? path : std::string();
}

}  // namespace

AvatarLibraryOptions avatars_of(const AvatarStore& store, const std::string& shipped_folder,
                                std::vector<AvatarOverride> overrides) {
  AvatarLibraryOptions options;
  options.overrides = std::move(overrides);
  options.sources.read_hash =
      [store](const FileHash& hash, const AvatarStop& stop) -> std::optional<Result<AvatarModel>> {
    const auto bytes = store.read(hash);
    if (!bytes) return std::nullopt;
    return model_of(*bytes, hex_of(hash).substr(0, 12), stop);
  };
  options.sources.read_file = [](const std::string& path,
                                 const AvatarStop& stop) -> Result<AvatarModel> {
    DANCE_TRY(const AvatarStore::Kept kept, AvatarStore::read_file(path));
    return model_of(kept.bytes, path.substr(path.rfind('/') + 1), stop);
  };
  options.sources.shipped_file = [shipped_folder](std::string_view name) {
    return shipped_file(shipped_folder, name);
  };
  return options;
}

Result<AvatarOverride> parse_avatar_override(const std::string& text,
                                             const std::string& shipped_folder) {
  AvatarOverride wish;
  wish.file = text;
  const std::size_t equals = text.find('=');
  const auto guest = GuestId::parse(std::string_view(text).substr(0, equals));
  if (equals != std::string::npos && guest) {
    wish.guest = *guest;
    wish.file = text.substr(equals + 1);
  }
  if (std::string shipped = shipped_file(shipped_folder, wish.file); !shipped.empty())
    wish.file = std::move(shipped);
  DANCE_TRY(const AvatarStore::Kept kept, AvatarStore::read_file(wish.file));
  if (auto read = run_confined([&] { return read_avatar(kept.bytes); }); !read)
    return fail("--avatar " + wish.file + ": " + read.error().what);
  return wish;
}

}  // namespace dance
