// DanceAdapter.hpp: the dancers of a house for C++17, as a wrapper of dance_adapter.h that owns its
// handles. It finds libdance_adapter.so.1 when the program runs, so that a program starts without
// it too; with DANCE_ADAPTER_LINKED defined it calls the library that the program is linked with.
//
// Units/frames: as dance_adapter.h says, in the axes that an Adapter or a Producer was opened with.
// Ownership:    Adapter and Producer close their handle; the Library must outlive them. No call but
//               their constructors allocates.
// Threads:      an Adapter or a Producer belongs to one thread at a time; a Library to any number.
// Failure:      no exceptions: a Library, an Adapter or a Producer that could not be opened is
//               false, and every call on it returns DANCE_NO_HOUSE or nothing.
#ifndef DANCE_ADAPTER_HPP
#define DANCE_ADAPTER_HPP

#include <dance_adapter.h>

#include <cstdint>
#ifndef DANCE_ADAPTER_LINKED
#include <dlfcn.h>
#endif

namespace dancegraph {

// Every function of dance_adapter.h without its first word.
// clang-format off
#define DANCE_ADAPTER_FUNCTIONS(X) \
  X(adapter_abi) X(adapter_now_ns) X(bone_name) X(bone_parent) X(finger_bone_name) \
  X(finger_bone_parent) X(status_text) X(adapter_open) X(adapter_close) X(adapter_state) \
  X(adapter_guests) X(adapter_find) X(adapter_newest) X(adapter_at) X(adapter_skeleton) \
  X(adapter_hands) X(adapter_beat) X(adapter_counters) X(world_of) X(producer_open) \
  X(producer_close) X(producer_skeleton) X(producer_pose) X(producer_hands)
// clang-format on

// The library's functions as members, and why they are not there.
class Library {
 public:
  // Where no path is given, or an empty one, the dynamic linker looks: LD_LIBRARY_PATH, the
  // system's folders. The name with a version is that of the package dancegraph, the other one of a
  // build.
  explicit Library(const char* path = nullptr) {
#ifdef DANCE_ADAPTER_LINKED
    (void)path;
#define DANCE_ADAPTER_FIND(name) name = &dance_##name;
#else
    constexpr int kMode = RTLD_NOW | RTLD_LOCAL;
    const bool is_given = path && *path;
    image_ = dlopen(is_given ? path : "libdance_adapter.so.1", kMode);
    if (!image_ && !is_given) image_ = dlopen("libdance_adapter.so", kMode);
    if (!image_) {
      problem_ = "libdance_adapter.so.1 cannot be loaded: install dancegraph, or give its path";
      return;
    }
#define DANCE_ADAPTER_FIND(name) find(name, "dance_" #name);
#endif
    DANCE_ADAPTER_FUNCTIONS(DANCE_ADAPTER_FIND)
#undef DANCE_ADAPTER_FIND
    if (!problem_ && adapter_abi() != DANCE_ADAPTER_ABI)
      problem_ = "libdance_adapter.so and dance_adapter.h are of different versions";
  }
  ~Library() {
#ifndef DANCE_ADAPTER_LINKED
    if (image_) dlclose(image_);
#endif
  }
  Library(const Library&) = delete;
  Library& operator=(const Library&) = delete;

  explicit operator bool() const { return problem_ == nullptr; }
  // nullptr where there is none.
  const char* problem() const { return problem_; }

#define DANCE_ADAPTER_MEMBER(name) decltype(&dance_##name) name = nullptr;
  DANCE_ADAPTER_FUNCTIONS(DANCE_ADAPTER_MEMBER)
#undef DANCE_ADAPTER_MEMBER

 private:
#ifndef DANCE_ADAPTER_LINKED
  template <class Function>
  void find(Function& function, const char* name) {
    function = reinterpret_cast<Function>(dlsym(image_, name));
    if (!function) problem_ = "libdance_adapter.so lacks a function: it is of another version";
  }
  void* image_ = nullptr;
#endif
  const char* problem_ = nullptr;
};
#undef DANCE_ADAPTER_FUNCTIONS

// A struct of dance_adapter.h as every call wants it: empty, with its size.
template <class Struct>
Struct make() {
  Struct made{};
  made.struct_size = static_cast<std::uint32_t>(sizeof(Struct));
  return made;
}

// The dancers that are there: iterate over it.
struct GuestList {
  dance_guest guests[DANCE_MAX_GUESTS];
  std::uint32_t count = 0;

  const dance_guest* begin() const { return guests; }
  const dance_guest* end() const { return guests + count; }
};

// A reader of a house.
class Adapter {
 public:
  Adapter(const Library& library, const char* name, dance_axes axes)
      : library_(&library), handle_(library ? library.adapter_open(name, axes) : nullptr) {}
  ~Adapter() {
    if (handle_) library_->adapter_close(handle_);
  }
  Adapter(Adapter&& other) noexcept : library_(other.library_), handle_(other.handle_) {
    other.handle_ = nullptr;
  }
  Adapter& operator=(Adapter&& other) noexcept {
    if (this == &other) return *this;
    if (handle_) library_->adapter_close(handle_);
    library_ = other.library_;
    handle_ = other.handle_;
    other.handle_ = nullptr;
    return *this;
  }

  explicit operator bool() const { return handle_ != nullptr; }
  const Library& library() const { return *library_; }

  dance_status state() { return handle_ ? library_->adapter_state(handle_) : DANCE_NO_HOUSE; }

  void guests(GuestList& list) {
    list.guests[0].struct_size = static_cast<std::uint32_t>(sizeof(dance_guest));
    list.count = handle_ ? library_->adapter_guests(handle_, list.guests, DANCE_MAX_GUESTS) : 0u;
    if (list.count > DANCE_MAX_GUESTS) list.count = DANCE_MAX_GUESTS;
  }
  dance_status find(const char* id, std::uint32_t& slot) {
    return handle_ ? library_->adapter_find(handle_, id, &slot) : DANCE_NO_HOUSE;
  }
  dance_status newest(std::uint32_t slot, dance_pose& pose) {
    return sized(pose) ? library_->adapter_newest(handle_, slot, &pose) : DANCE_NO_HOUSE;
  }
  // The pose to show at a time: interpolated, or predicted beyond the newest.
  dance_status at(std::uint32_t slot, std::int64_t time_ns, dance_pose& pose) {
    return sized(pose) ? library_->adapter_at(handle_, slot, time_ns, &pose) : DANCE_NO_HOUSE;
  }
  dance_status skeleton(std::uint32_t slot, dance_skeleton& skeleton) {
    return sized(skeleton) ? library_->adapter_skeleton(handle_, slot, &skeleton) : DANCE_NO_HOUSE;
  }
  dance_status hands(std::uint32_t slot, dance_hands& hands) {
    return sized(hands) ? library_->adapter_hands(handle_, slot, &hands) : DANCE_NO_HOUSE;
  }
  dance_status beat(std::int64_t time_ns, dance_beat& beat) {
    return sized(beat) ? library_->adapter_beat(handle_, time_ns, &beat) : DANCE_NO_HOUSE;
  }
  dance_status counters(dance_counters& counters) {
    return sized(counters) ? library_->adapter_counters(handle_, &counters) : DANCE_NO_HOUSE;
  }
  // Where every bone is, of a pose and a skeleton in the same axes.
  dance_status world_of(const dance_skeleton& skeleton, const dance_pose& pose,
                        dance_world& world) {
    return sized(world) ? library_->world_of(&skeleton, &pose, &world) : DANCE_NO_HOUSE;
  }

 private:
  template <class Struct>
  bool sized(Struct& one) const {
    one.struct_size = static_cast<std::uint32_t>(sizeof(Struct));
    return handle_ != nullptr;
  }

  const Library* library_;
  dance_adapter* handle_;
};

// The way back: a tracker's poses become captures of a guest in the house whose receiver has that
// name. None waits; without a house they are dropped.
class Producer {
 public:
  Producer(const Library& library, const char* name, dance_axes axes)
      : library_(&library), handle_(library ? library.producer_open(name, axes) : nullptr) {}
  ~Producer() {
    if (handle_) library_->producer_close(handle_);
  }
  Producer(Producer&& other) noexcept : library_(other.library_), handle_(other.handle_) {
    other.handle_ = nullptr;
  }
  Producer& operator=(Producer&& other) noexcept {
    if (this == &other) return *this;
    if (handle_) library_->producer_close(handle_);
    library_ = other.library_;
    handle_ = other.handle_;
    other.handle_ = nullptr;
    return *this;
  }

  explicit operator bool() const { return handle_ != nullptr; }

  // The structs as make() has begun them.
  dance_status skeleton(const dance_skeleton& skeleton) {
    return handle_ ? library_->producer_skeleton(handle_, &skeleton) : DANCE_NO_HOUSE;
  }
  dance_status pose(const dance_pose& pose) {
    return handle_ ? library_->producer_pose(handle_, &pose) : DANCE_NO_HOUSE;
  }
  dance_status hands(const dance_hands& hands) {
    return handle_ ? library_->producer_hands(handle_, &hands) : DANCE_NO_HOUSE;
  }

 private:
  const Library* library_;
  dance_producer* handle_;
};

}  // namespace dancegraph

#endif
