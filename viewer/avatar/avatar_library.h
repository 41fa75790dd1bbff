// AvatarLibrary: gives each guest of a scene its figure: the avatar that the guest has chosen, from
// a file or from those that ship with the program, or a mannequin in the dancer's proportions. They
// are made and read in a thread of their own, so that drawing never waits: until one is ready the
// guest's last figure stays, and before the first a plain mannequin.
//
// Units/frames: as formats/avatar/avatar_model.h; times of the scene.
// Ownership:    owns its thread and a cache bounded in number and bytes; shares the models.
// Threads:      one owner, the drawing thread.
// Failure:      an avatar that cannot be read is told for a while in the scene's notes, and its
//               guest is a mannequin.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "viewer/avatar/avatar_loader.h"
#include "viewer/avatar/mannequin_shape.h"
#include "viewer/scene/scene.h"

namespace dance {

// Where avatars' files are found and how they are read.
struct AvatarSources {
  // Both in the loading thread, which they leave soon after `stop` is true. The file of that hash:
  // nullopt while it is not here yet.
  std::function<std::optional<Result<AvatarModel>>(const FileHash&, const AvatarStop& stop)>
      read_hash;
  std::function<Result<AvatarModel>(const std::string& path, const AvatarStop& stop)> read_file;
  // In the drawing thread: the file of a shipped avatar; "" for a name that is none.
  std::function<std::string(std::string_view name)> shipped_file;
};

// A file for one guest, or for all without one here, whatever they have chosen.
struct AvatarOverride {
  GuestId guest;  // not set: all
  std::string file;
};

struct AvatarLibraryOptions {
  AvatarSources sources;
  std::vector<AvatarOverride> overrides;
  std::size_t most_models = 192;
  std::size_t most_bytes = std::size_t{768} << 20;
  // Of one: so that no few strangers fill the cache. AvatarLimits::bytes, and what holds them.
  std::size_t most_model_bytes = std::size_t{144} << 20;
};

class AvatarLibrary {
 public:
  explicit AvatarLibrary(AvatarLibraryOptions options = {});

  // Sets avatar and height_scale of all guests, and adds to the notes what went wrong.
  void dress(SceneState& scene);
  // As dress(), when all figures are ready: for pictures in files.
  void wait_and_dress(SceneState& scene);

  std::size_t models() const { return cache_.size(); }
  std::size_t size_bytes() const { return size_bytes_; }

 private:
  struct Entry {
    std::shared_ptr<AvatarJob> job;
    std::uint64_t last_used = 0;  // in pictures
    bool is_counted = false;      // in size_bytes_, unless it is refused
    enum class Refusal : std::uint8_t { kNone, kNoRoom, kTooLarge };
    Refusal refusal = Refusal::kNone;
    std::size_t refused_bytes = 0;
    MonoTime asked;  // of a file that may come later, or find room: looked for again
    bool may_come = false;
    AvatarJob::Make make = {};
    std::shared_ptr<AvatarJob> next = {};
  };
  struct Figure {
    AvatarWish wish;
    MannequinShape shape;
    std::string key;        // of the chosen figure in the cache
    std::string plain_key;  // of the mannequin instead; "" until it is needed
    std::shared_ptr<const AvatarModel> shown;
    std::string note;
    MonoTime noted;
    std::uint64_t last_seen = 0;
  };

  void dress(SceneGuest& guest, MonoTime now);
  void choose(Figure& figure, const GuestId& guest, MonoTime now);
  std::string ask_mannequin(const Figure& figure, const GuestId& guest);
  std::string ask_file(const std::string& path);
  std::string ask_hash(const FileHash& hash, MonoTime now);
  std::string ask(std::string key, AvatarJob::Make make);
  Entry& look_up(const std::string& key, MonoTime now);
  std::shared_ptr<const AvatarModel> plain_figure(Figure& figure, const GuestId& guest,
                                                  MonoTime now);
  static void tell(Figure& figure, const GuestId& guest, const Entry& entry, MonoTime now);
  const std::string* override_of(const GuestId& guest) const;
  bool is_to_make_again(const Entry& entry, MonoTime now) const;
  void count(Entry& entry, MonoTime now);
  void evict();
  void forget_absent();

  AvatarLibraryOptions options_;
  std::shared_ptr<const AvatarModel> stand_in_;
  std::map<GuestId, Figure> figures_;
  std::map<std::string, Entry> cache_;
  std::size_t size_bytes_ = 0;
  std::uint64_t picture_ = 0;
  AvatarLoader loader_;
};

}  // namespace dance
