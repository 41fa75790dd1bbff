// LinkAvatars: between a link and the store of avatars: reads what this house's guests have chosen,
// so that the link can offer it; looks whether those of the others are here, has the link fetch
// them if not, and keeps what has come when its hash is right. Files are touched in a thread of its
// own only, as poses do not wait for a disk.
//
// Units/frames: times of this house's clock.
// Ownership:    refers to the poller and the link, which must outlive it; owns thread and store.
// Threads:      the poller's, and one that it starts.
// Failure:      an own avatar that is not in the store is told, with the cure; what comes of others
//               and is wrong is counted by the link and told once.
#pragma once

#include <atomic>
#include <condition_variable>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <thread>

#include "core/net/poller.h"
#include "core/store/avatar_store.h"
#include "tunnel/link/link.h"

namespace dance {

class LinkAvatars {
 public:
  using Tell = std::function<void(const std::string& line)>;

  // `tell` hears what a user should know; it may be empty.
  LinkAvatars(AvatarStore store, Poller& poller, Tell tell);
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

 private:
  using Work = std::function<void()>;
  struct Own {
    AvatarFile file;
    bool is_loading = false;
    bool is_offered = false;
    bool is_told = false;  // that it is not here
  };

  void run();
  void in_thread(Work work);
  void in_poller(Work work);
  void take_answers();
  void load_own(const GuestId& guest, Own& own);
  void look_for(const GuestId& guest, const AvatarFile& file);
  void keep(const GuestId& guest, const FileHash& hash, ChunkedFile&& file);
  void say(const std::string& line) const {
    if (tell_) tell_(line);
  }

  AvatarStore store_;
  Poller& poller_;
  Tell tell_;
  Link* link_ = nullptr;
  std::map<GuestId, Own> own_;
  std::map<GuestId, AvatarFile> heard_;
  int wake_fd_ = -1;

  std::mutex mutex_;
  std::condition_variable wakes_, is_idle_;
  std::deque<Work> work_, answers_;  // guarded
  bool is_busy_ = false;             // guarded
  bool ends_ = false;                // guarded
  std::thread thread_;
};

}  // namespace dance
