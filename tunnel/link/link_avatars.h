// LinkAvatars: between a link and the store of avatars: reads what this house's guests have chosen,
// so that the link can offer it; looks whether those of the others are here, has the link fetch
// them if not, and keeps what has come when its hash is right. Files are touched in a thread of its
// own only, as poses do not wait for a disk.
//
// Units/frames: times of this house's clock.
// Ownership:    refers to the poller and the link, which must outlive it; owns thread and store.
// Threads:      the poller's, and one that it starts.
// Failure:      an own avatar that is not in the store is told, with the cure; what comes of others
//               and is wrong is counted by the link and told once. However often a guest chooses,
//               it costs one look into the store a second.
#pragma once

#include <atomic>
#include <condition_variable>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <thread>
#include <tuple>

#include "core/net/poller.h"
#include "core/net/system/wake_event.h"
#include "core/store/avatar_store.h"
#include "tunnel/link/link.h"

namespace dance {

class LinkAvatars {
 public:
  using Tell = std::function<void(const std::string& line)>;

  // `tell` gets the lines for the user; it may be empty.
  LinkAvatars(AvatarStore store, WakeEvent wake, Poller& poller, Tell tell);
  ~LinkAvatars();
  LinkAvatars(const LinkAvatars&) = delete;
  LinkAvatars& operator=(const LinkAvatars&) = delete;

  // Before the link is opened: what its handlers do for files.
  void add_to(LinkHandlers& handlers);
  void attach(Link& link) { link_ = &link; }

  // A guest of this house has chosen; said again each second, which is no news.
  void choose(const GuestId& guest, const AvatarFile& file, MonoTime now);
  // A guest of another house has.
  void hear(const GuestId& guest, const AvatarFile& file);
  void forget(const GuestId& guest);

  // Until everything that was begun is done, of the thread and of its answers; for tests.
  void wait();
  // Into the store, for files of others, so far.
  std::uint64_t looks() const;

 private:
  using Work = std::function<void()>;
  struct Own {
    AvatarFile file;
    bool is_loading = false;
    bool is_offered = false;
    bool is_told = false;  // that it is not here
  };
  // For a guest's newest choice; not before then.
  struct Look {
    AvatarFile file;
    MonoTime due;
  };
  // What is said once of a guest's file.
  enum class Said : std::uint8_t { kResumed, kArrived, kAgain, kDamaged, kNotKept, kNoFiles };
  using Told = std::tuple<GuestId, FileHash, Said>;

  void run();
  Work next_work(std::unique_lock<std::mutex>& lock);
  void in_thread(Work work);
  void look_soon(const GuestId& guest, const AvatarFile& file);
  void stop_watching(const GuestId& guest);
  void drop(const GuestId& guest);
  void in_poller(Work work);
  void take_answers();
  void load_own(const GuestId& guest, Own& own);
  void look_for(const GuestId& guest, const AvatarFile& file);
  void keep(const GuestId& guest, const FileHash& hash, ChunkedFile&& file);
  void settle(const GuestId& guest, const FileHash& hash, const Result<bool>& kept);
  void say_once(const Told& what, const std::string& line);
  void say(const std::string& line) const {
    if (tell_) tell_(line);
  }

  AvatarStore store_;
  Poller& poller_;
  Tell tell_;
  Link* link_ = nullptr;
  std::map<GuestId, Own> own_;
  std::map<GuestId, AvatarFile> heard_;
  std::deque<Told> told_;  // the newest
  WakeEvent wake_;

  mutable std::mutex mutex_;
  std::condition_variable wakes_, is_idle_;
  std::deque<Work> work_, answers_;     // guarded
  std::map<GuestId, Look> looks_;       // guarded; one for each guest
  std::map<GuestId, MonoTime> looked_;  // guarded; when last, a second or less ago
  std::uint64_t looks_done_ = 0;        // guarded
  bool is_busy_ = false;                // guarded
  bool ends_ = false;                   // guarded
  std::thread thread_;
};

}  // namespace dance
