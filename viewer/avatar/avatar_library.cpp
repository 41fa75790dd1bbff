#include "viewer/avatar/avatar_library.h"

#include <algorithm>
#include <cstring>

#include "core/base/raw_twin.h"
#include "formats/avatar/mannequin_model.h"
#include "formats/body/look_names.h"

namespace dance {
namespace {

constexpr Duration kNoteStays = Duration::s(12);
constexpr Duration kLooksAgain = Duration::s(1);  // for a file that is on its way
constexpr Duration kTriesAgain = Duration::s(5);  // where there was no room
constexpr std::size_t kMostFigures = 256;         // guests, also those who have left

// What stands there until a dancer's own figure is ready: of no colour, so that it is not taken for
// somebody.
GuestLook plain_look() {
  GuestLook look;
  look.skin = look.top = look.legs = look.shoes = look.hair = Eigen::Vector3f::Constant(0.35f);
  look.tag = Eigen::Vector3f::Constant(0.8f);
  return look;
}

void append_look(std::string& key, const GuestLook& look) {
  for (const Eigen::Vector3f* colour : {&look.skin, &look.top, &look.legs, &look.shoes, &look.hair})
    key.append(reinterpret_cast<const char*>(colour->data()), 3 * sizeof(float));
  key += static_cast<char>(look.sleeves);
  key += static_cast<char>(look.legwear);
  key += static_cast<char>(look.hair_style);
}

bool is_named_look(const AvatarWish& wish) {
  return !wish.name.is_set() || is_look_name(wish.name.view());
}

}  // namespace

AvatarLibrary::AvatarLibrary(AvatarLibraryOptions options)
    : options_(std::move(options)),
      stand_in_(std::make_shared<const AvatarModel>(
          mannequin_model(average_skeleton(), plain_look(), false))) {}

void AvatarLibrary::dress(SceneState& scene) {
  ++picture_;
  const auto find_guest = [&](const GuestId& id) {
    return std::ranges::find(scene.guests, id, &SceneGuest::id);
  };
  for (SceneGuest& guest : scene.guests) {
    // A raw twin looks as its dancer does.
    const auto whose = twin_of_whom(guest.id);
    if (whose && find_guest(*whose) != scene.guests.end()) continue;
    dress(guest, scene.time);
    const Figure& figure = figures_.at(guest.id);
    if (!figure.note.empty() && scene.time - figure.noted < kNoteStays)
      scene.notes.push_back(figure.note);
  }
  for (SceneGuest& guest : scene.guests) {
    if (guest.avatar) continue;
    const auto original = find_guest(*twin_of_whom(guest.id));
    guest.avatar = original->avatar;
    guest.height_scale = original->height_scale;
  }
  evict();
  forget_absent();
}

void AvatarLibrary::wait_and_dress(SceneState& scene) {
  // Twice, as a file that cannot be read makes a mannequin necessary.
  const std::vector<std::string> notes = scene.notes;
  for (int round = 0; round < 3; ++round) {
    for (SceneGuest& guest : scene.guests) guest.avatar.reset();
    scene.notes = notes;
    dress(scene);
    if (round < 2) loader_.wait();
  }
}

void AvatarLibrary::dress(SceneGuest& guest, MonoTime now) {
  Figure& figure = figures_[guest.id];
  figure.last_seen = picture_;
  const bool has_fingers = guest.hands.has_value();
  const bool has_new_shape = !figure.shape.fits(guest.skeleton, has_fingers);
  if (has_new_shape)
    // Fingers stay once they have been seen.
    figure.shape = MannequinShape(guest.skeleton, has_fingers || figure.shape.has_fingers());
  if (figure.key.empty() || has_new_shape || figure.wish != guest.wish) {
    figure.wish = guest.wish;
    choose(figure, guest.id, now);
  }
  const Entry& entry = look_up(figure.key, now);
  if (entry.job->is_done()) {
    figure.shown = entry.job->model();
    if (figure.shown && entry.may_come) figure.note.clear();  // it has arrived
    if (!figure.shown) {
      tell(figure, guest.id, entry, now);
      figure.shown = plain_figure(figure, guest.id, now);
    }
  }
  if (!figure.shown) figure.shown = stand_in_;
  guest.avatar = figure.shown;
  guest.height_scale = guest.wish.height_scale;
}

// The mannequin of a guest whose chosen avatar cannot be shown; null until it is ready.
std::shared_ptr<const AvatarModel> AvatarLibrary::plain_figure(Figure& figure, const GuestId& guest,
                                                               MonoTime now) {
  if (figure.plain_key.empty()) figure.plain_key = ask_mannequin(figure, guest);
  return look_up(figure.plain_key, now).job->model_if_done();
}

void AvatarLibrary::tell(Figure& figure, const GuestId& guest, const Entry& entry, MonoTime now) {
  const std::string whose = std::string(guest.view()) + "'s avatar ";
  std::string note;
  if (entry.job->is_missing())
    note = whose + "is on its way; until then a mannequin";
  else if (entry.refusal == Entry::Refusal::kNoRoom)
    note = whose + "has no room beside the others here; shown as a mannequin";
  else if (entry.refusal == Entry::Refusal::kTooLarge)
    note = whose + "is too large; make its meshes or pictures smaller; shown as a mannequin";
  else
    note = whose + "cannot be read: " + entry.job->error() + "; shown as a mannequin";
  if (note == figure.note) return;
  figure.note = std::move(note);
  figure.noted = now;
}

void AvatarLibrary::choose(Figure& figure, const GuestId& guest, MonoTime now) {
  figure.note.clear();
  figure.plain_key.clear();
  const AvatarSources& sources = options_.sources;
  if (const std::string* file = override_of(guest)) {
    figure.key = ask_file(*file);
    return;
  }
  if (figure.wish.file.is_set() && sources.read_hash) {
    figure.key = ask_hash(figure.wish.file, now);
    return;
  }
  if (!is_named_look(figure.wish)) {
    const std::string_view name = figure.wish.name.view();
    const std::string file = sources.shipped_file ? sources.shipped_file(name) : "";
    if (!file.empty()) {
      figure.key = ask_file(file);
      return;
    }
    figure.note = std::string(guest.view()) + "'s avatar " + std::string(name) +
                  " is not among those here; shown as a mannequin";
    figure.noted = now;
  }
  figure.key = ask_mannequin(figure, guest);
}

const std::string* AvatarLibrary::override_of(const GuestId& guest) const {
  const std::string* of_all = nullptr;
  for (const AvatarOverride& it : options_.overrides) {
    if (it.guest == guest) return &it.file;
    if (!it.guest.is_set()) of_all = &it.file;
  }
  return of_all;
}

std::string AvatarLibrary::ask_mannequin(const Figure& figure, const GuestId& guest) {
  const std::string_view name = is_named_look(figure.wish) ? figure.wish.name.view() : "";
  const GuestLook look = named_look(guest, name, figure.wish.colour_rgb).value_or(look_of(guest));
  std::string key = "m";
  figure.shape.append_to(key);
  append_look(key, look);
  return ask(std::move(key), [shape = figure.shape, look](const AvatarStop&) {
    return Result<AvatarModel>(mannequin_model(shape.skeleton(), look, shape.has_fingers()));
  });
}

std::string AvatarLibrary::ask_file(const std::string& path) {
  return ask("f" + path,
             [read = options_.sources.read_file, path](const AvatarStop& stop) -> AvatarJob::Made {
               if (!read) return Result<AvatarModel>(fail("this program reads no files"));
               return read(path, stop);
             });
}

std::string AvatarLibrary::ask_hash(const FileHash& hash, MonoTime now) {
  std::string key = "h" + hex_of(hash);
  const bool is_new = !cache_.contains(key);
  key = ask(std::move(key), [read = options_.sources.read_hash, hash](const AvatarStop& stop) {
    return read(hash, stop);
  });
  Entry& entry = cache_.at(key);
  if (is_new) entry.asked = now;
  entry.may_come = true;
  return key;
}

std::string AvatarLibrary::ask(std::string key, AvatarJob::Make make) {
  Entry& entry = cache_[key];
  entry.last_used = picture_;
  if (!entry.job) {
    entry.make = std::move(make);
    entry.job = loader_.start(entry.make);
  }
  return key;
}

AvatarLibrary::Entry& AvatarLibrary::look_up(const std::string& key, MonoTime now) {
  Entry& entry = cache_.at(key);
  entry.last_used = picture_;
  if (!entry.job->is_done()) return entry;
  // The job that found nothing is not asked any more; its successor's answer comes in time.
  if (!entry.next && is_to_make_again(entry, now)) {
    entry.asked = now;
    entry.next = loader_.start(entry.make);
  }
  if (entry.next && entry.next->is_done()) {
    entry.job = std::move(entry.next);
    entry.refusal = Entry::Refusal::kNone;
    entry.is_counted = false;
  }
  count(entry, now);
  return entry;
}

// What is missing may have arrived; what had no room may have it now that others are not shown.
bool AvatarLibrary::is_to_make_again(const Entry& entry, MonoTime now) const {
  if (entry.job->is_missing()) return now - entry.asked >= kLooksAgain;
  if (entry.refusal != Entry::Refusal::kNoRoom || now - entry.asked < kTriesAgain) return false;
  std::size_t kept = 0;  // what evict() cannot take
  for (const auto& [key, other] : cache_)
    if (other.is_counted && other.last_used + 1 >= picture_) kept += other.job->size_bytes();
  return kept + entry.refused_bytes <= options_.most_bytes;
}

// Once for each model: what it takes, or that there is no room for it.
void AvatarLibrary::count(Entry& entry, MonoTime now) {
  if (entry.is_counted || !entry.job->model()) return;
  entry.is_counted = true;
  const std::size_t bytes = entry.job->size_bytes();
  const bool is_too_large = bytes > options_.most_model_bytes;
  if (!is_too_large) {
    size_bytes_ += bytes;
    evict();
    if (size_bytes_ <= options_.most_bytes) return;
    size_bytes_ -= bytes;
  }
  entry.refusal = is_too_large ? Entry::Refusal::kTooLarge : Entry::Refusal::kNoRoom;
  entry.refused_bytes = bytes;
  entry.may_come = true;
  entry.asked = now;
  entry.job = AvatarJob::empty();
}

// What no guest of this picture or the last shows, the longest unused first, while there is too
// much.
void AvatarLibrary::evict() {
  while (cache_.size() > options_.most_models || size_bytes_ > options_.most_bytes) {
    auto oldest = cache_.end();
    for (auto it = cache_.begin(); it != cache_.end(); ++it)
      if (it->second.last_used + 1 < picture_ &&
          (oldest == cache_.end() || it->second.last_used < oldest->second.last_used))
        oldest = it;
    if (oldest == cache_.end()) return;
    if (oldest->second.is_counted)  // one that is refused has none
      size_bytes_ -= oldest->second.job->size_bytes();
    for (auto& [guest, figure] : figures_) {
      if (figure.key == oldest->first) figure.key.clear(), figure.shown.reset();
      if (figure.plain_key == oldest->first) figure.plain_key.clear();
    }
    cache_.erase(oldest);
  }
}

void AvatarLibrary::forget_absent() {
  if (figures_.size() <= kMostFigures) return;
  std::erase_if(figures_, [&](const auto& it) { return it.second.last_seen != picture_; });
}

}  // namespace dance
