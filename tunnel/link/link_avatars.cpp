#include "tunnel/link/link_avatars.h"

#include <pthread.h>
#include <sys/eventfd.h>
#include <sys/resource.h>
#include <unistd.h>

#include "core/net/mono_clock.h"

namespace dance {
namespace {

constexpr int kNiceness = 15;
// Blocks that wait to be kept for a restart; beyond, they are left out.
constexpr std::size_t kMostWork = 256;
constexpr std::size_t kMostHeard = 256;

bool is_same(const AvatarFile& a, const AvatarFile& b) {
  return a.hash == b.hash && a.size_bytes == b.size_bytes;
}

bool is_vrm(const AvatarFile& file) { return file.name.view().ends_with(".vrm"); }

}  // namespace

LinkAvatars::LinkAvatars(AvatarStore store, Poller& poller, Tell tell)
    : store_(std::move(store)), poller_(poller), tell_(std::move(tell)) {
  wake_fd_ = eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC);
  DANCE_ASSERT(wake_fd_ >= 0);
  poller_.watch(wake_fd_, [this](MonoTime) { take_answers(); });
  thread_ = std::thread([this] { run(); });
}

LinkAvatars::~LinkAvatars() {
  {
    const std::lock_guard lock(mutex_);
    ends_ = true;
  }
  wakes_.notify_all();
  thread_.join();
  poller_.unwatch(wake_fd_);
  close(wake_fd_);
}

void LinkAvatars::run() {
  pthread_setname_np(pthread_self(), "link-avatars");
  setpriority(PRIO_PROCESS, 0, kNiceness);  // of this thread alone
  std::unique_lock lock(mutex_);
  while (true) {
    wakes_.wait(lock, [this] { return ends_ || !work_.empty(); });
    if (ends_) return;
    Work work = std::move(work_.front());
    work_.pop_front();
    is_busy_ = true;
    lock.unlock();
    work();
    work = nullptr;
    lock.lock();
    is_busy_ = false;
    if (work_.empty()) is_idle_.notify_all();
  }
}

void LinkAvatars::in_thread(Work work) {
  {
    const std::lock_guard lock(mutex_);
    work_.push_back(std::move(work));
  }
  wakes_.notify_one();
}

void LinkAvatars::in_poller(Work work) {
  {
    const std::lock_guard lock(mutex_);
    answers_.push_back(std::move(work));
  }
  const std::uint64_t one = 1;
  [[maybe_unused]] const auto written = write(wake_fd_, &one, sizeof(one));
}

void LinkAvatars::take_answers() {
  std::uint64_t times = 0;
  [[maybe_unused]] const auto taken = read(wake_fd_, &times, sizeof(times));
  std::deque<Work> answers;
  {
    const std::lock_guard lock(mutex_);
    answers.swap(answers_);
  }
  for (const Work& answer : answers) answer();
}

void LinkAvatars::wait() {
  {
    std::unique_lock lock(mutex_);
    is_idle_.wait(lock, [this] { return work_.empty() && !is_busy_; });
  }
  take_answers();
}

void LinkAvatars::add_to(LinkHandlers& handlers) {
  handlers.on_file = [this](const GuestId& guest, const FileHash& hash, ChunkedFile&& file) {
    keep(guest, hash, std::move(file));
  };
  handlers.on_file_block = [this](const FileHash& hash, const ChunkedFile& file,
                                  std::size_t block) {
    {
      const std::lock_guard lock(mutex_);
      if (work_.size() >= kMostWork) return;
    }
    const wire::Bytes bytes = file.block(block);
    in_thread([this, hash, offset = block * ChunkedFile::kBlock,
               copy = std::vector<std::uint8_t>(bytes.begin(), bytes.end())] {
      // A full disk costs what was fetched after a restart, and nothing else.
      [[maybe_unused]] const auto added = store_.add_part(hash, offset, copy);
    });
  };
  handlers.on_file_refused = [this](const GuestId& guest, const FileHash&,
                                    wire::FileRefusalCause cause) {
    if (cause == wire::FileRefusalCause::kNoFiles)
      say(std::string(guest.view()) + "'s house sends no files: its avatar stays a mannequin here");
  };
}

void LinkAvatars::choose(const GuestId& guest, const AvatarFile& file, MonoTime now) {
  Own& own = own_[guest];
  if (!is_same(own.file, file)) {
    own = Own();
    own.file = file;
    link_->core().files().offer(guest, FileHash(), nullptr);
  }
  // Each time: the link may not have known this guest before.
  if (own.is_offered || !file.hash.is_set())
    link_->send(guest, file, now);
  else if (!own.is_loading)
    load_own(guest, own);
}

// The bytes first, then the choice is told: whoever hears of it can have them.
void LinkAvatars::load_own(const GuestId& guest, Own& own) {
  own.is_loading = true;
  in_thread([this, guest, file = own.file] {
    auto read = store_.read(file.hash);
    FileBytes bytes;
    if (read && read->size() == static_cast<std::size_t>(file.size_bytes))
      bytes = std::make_shared<const std::vector<std::uint8_t>>(std::move(*read));
    in_poller([this, guest, file, bytes] {
      Own& chosen = own_[guest];
      if (!is_same(chosen.file, file)) return;  // another one meanwhile
      chosen.is_loading = false;
      chosen.is_offered = bytes != nullptr;
      if (bytes) {
        link_->core().files().offer(guest, file.hash, bytes);
        link_->send(guest, file, mono_now());
      } else if (!chosen.is_told) {
        chosen.is_told = true;
        say(std::string(guest.view()) +
            "'s avatar is not among those kept here; choose it again: dance avatar choose " +
            std::string(guest.view()) + " FILE");
      }
    });
  });
}

void LinkAvatars::hear(const GuestId& guest, const AvatarFile& file) {
  if (heard_.size() >= kMostHeard && !heard_.contains(guest)) return;
  heard_.insert_or_assign(guest, file);
  if (file.hash.is_set())
    look_for(guest, file);
  else
    link_->core().files().drop(guest);
}

void LinkAvatars::look_for(const GuestId& guest, const AvatarFile& file) {
  in_thread([this, guest, file] {
    if (!store_.find(file.hash).empty()) return;
    const auto begun = std::make_shared<ChunkedFile>(static_cast<std::uint32_t>(file.size_bytes));
    const std::vector<std::uint8_t> part = store_.part(file.hash);
    const std::size_t whole_blocks = part.size() / ChunkedFile::kBlock * ChunkedFile::kBlock;
    for (std::size_t at = 0; at + wire::kFileChunk <= whole_blocks; at += wire::kFileChunk)
      if (at / wire::kFileChunk + 1 < begun->chunks())
        begun->put(at / wire::kFileChunk, wire::Bytes(part).subspan(at, wire::kFileChunk));
    in_poller([this, guest, file, begun] {
      const auto heard = heard_.find(guest);
      if (heard == heard_.end() || !is_same(heard->second, file)) return;
      const std::size_t here = begun->chunks() - begun->missing();
      link_->fetch_file(guest, file.hash, std::move(*begun), mono_now());
      if (here > 0)
        say(std::string(guest.view()) + "'s avatar is fetched on from " +
            std::to_string(here * wire::kFileChunk / 1000) + " kB");
    });
  });
}

void LinkAvatars::keep(const GuestId& guest, const FileHash& hash, ChunkedFile&& file) {
  const auto heard = heard_.find(guest);
  const bool vrm = heard != heard_.end() && is_vrm(heard->second);
  in_thread([this, guest, hash, vrm, whole = std::make_shared<ChunkedFile>(std::move(file))] {
    AvatarStore::Pieces pieces;
    for (std::size_t i = 0; i < whole->blocks(); ++i) pieces.push_back(whole->block(i));
    store_.forget_part(hash);
    const auto kept = store_.keep_foreign(hash, pieces, vrm);
    in_poller([this, guest, hash, kept] {
      // A disk that cannot take it is not the file's fault, but fetching again would not help.
      link_->core().files().settle(guest, hash, kept.has_value() && *kept);
      const std::string whose = std::string(guest.view()) + "'s avatar ";
      if (!kept)
        say(whose + "cannot be kept: " + kept.error().what);
      else
        say(*kept ? whose + "has arrived" : whose + "came damaged; it is not shown");
    });
  });
}

void LinkAvatars::forget(const GuestId& guest) {
  heard_.erase(guest);
  if (link_ != nullptr) link_->core().files().drop(guest);
}

}  // namespace dance
