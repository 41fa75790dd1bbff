#include "tunnel/link/link_avatars.h"

#include <pthread.h>
#include <sys/resource.h>
#include <unistd.h>

#include <chrono>

#include "core/net/mono_clock.h"

namespace dance {
namespace {

constexpr int kNiceness = 15;
// Blocks that wait to be kept for a restart; beyond, they are left out.
constexpr std::size_t kMostWork = 256;
constexpr std::size_t kMostHeard = 256;
constexpr std::size_t kMostTold = 256;
constexpr Duration kBetweenLooks = Duration::s(1);

bool is_same(const AvatarFile& a, const AvatarFile& b) {
  return a.hash == b.hash && a.size_bytes == b.size_bytes;
}

bool is_vrm(const AvatarFile& file) { return file.name.view().ends_with(".vrm"); }

}  // namespace

LinkAvatars::LinkAvatars(AvatarStore store, WakeEvent wake, Poller& poller, Tell tell)
    : store_(std::move(store)), poller_(poller), tell_(std::move(tell)), wake_(std::move(wake)) {
  poller_.watch(wake_.fd(), [this](MonoTime) { take_answers(); });
  thread_ = std::thread([this] { run(); });
}

LinkAvatars::~LinkAvatars() {
  {
    const std::lock_guard lock(mutex_);
    ends_ = true;
  }
  wakes_.notify_all();
  thread_.join();
  poller_.unwatch(wake_.fd());
}

void LinkAvatars::run() {
  pthread_setname_np(pthread_self(), "link-avatars");
  setpriority(PRIO_PROCESS, 0, kNiceness);  // of this thread alone
  std::unique_lock lock(mutex_);
  while (Work work = next_work(lock)) {
    is_busy_ = true;
    lock.unlock();
    work();
    work = nullptr;
    lock.lock();
    is_busy_ = false;
    is_idle_.notify_all();
  }
}

// Waits for it; nothing at the end.
LinkAvatars::Work LinkAvatars::next_work(std::unique_lock<std::mutex>& lock) {
  while (!ends_) {
    if (!work_.empty()) {
      Work work = std::move(work_.front());
      work_.pop_front();
      return work;
    }
    const auto first =
        std::ranges::min_element(looks_, {}, [](const auto& it) { return it.second.due; });
    if (first == looks_.end()) {
      wakes_.wait(lock);
      continue;
    }
    const MonoTime now = mono_now();
    if (first->second.due > now) {
      wakes_.wait_for(lock, std::chrono::nanoseconds((first->second.due - now).count_ns()));
      continue;
    }
    const auto [guest, look] = *first;
    looks_.erase(first);
    looked_[guest] = now;
    ++looks_done_;
    return [this, guest = guest, file = look.file] { look_for(guest, file); };
  }
  return nullptr;
}

void LinkAvatars::look_soon(const GuestId& guest, const AvatarFile& file) {
  {
    const std::lock_guard lock(mutex_);
    const MonoTime now = mono_now();
    std::erase_if(looked_, [&](const auto& it) { return now - it.second > kBetweenLooks; });
    const auto last = looked_.find(guest);
    looks_[guest] = {file, last == looked_.end() ? now : last->second + kBetweenLooks};
  }
  wakes_.notify_one();
}

void LinkAvatars::stop_watching(const GuestId& guest) {
  const std::lock_guard lock(mutex_);
  looks_.erase(guest);
  is_idle_.notify_all();
}

std::uint64_t LinkAvatars::looks() const {
  const std::lock_guard lock(mutex_);
  return looks_done_;
}

void LinkAvatars::say_once(const Told& what, const std::string& line) {
  if (std::ranges::find(told_, what) != told_.end()) return;
  if (told_.size() == kMostTold) told_.pop_front();
  told_.push_back(what);
  say(line);
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
  wake_.signal();
}

void LinkAvatars::take_answers() {
  wake_.clear();
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
    is_idle_.wait(lock, [this] { return work_.empty() && looks_.empty() && !is_busy_; });
  }
  take_answers();
}

void LinkAvatars::add_to(LinkHandlers& handlers) {
  handlers.on_file = [this](const GuestId& guest, const FileHash& hash, ChunkedFile&& file) {
    keep(guest, hash, std::move(file));
  };
  handlers.on_file_block = [this](const GuestId& guest, const FileHash& hash,
                                  const ChunkedFile& file, std::size_t block) {
    {
      const std::lock_guard lock(mutex_);
      if (work_.size() >= kMostWork) return;
    }
    const wire::Bytes bytes = file.block(block);
    in_thread([this, guest, hash, offset = block * ChunkedFile::kBlock,
               copy = std::vector<std::uint8_t>(bytes.begin(), bytes.end())] {
      // A full disk costs what was fetched after a restart, and nothing else.
      [[maybe_unused]] const auto added = store_.add_part(guest, hash, offset, copy);
    });
  };
  handlers.on_file_refused = [this](const GuestId& guest, const FileHash&,
                                    wire::FileRefusalCause cause) {
    if (cause == wire::FileRefusalCause::kNoFiles)
      say_once(
          {guest, FileHash(), Said::kNoFiles},
          std::string(guest.view()) + "'s house sends no files: its avatar stays a mannequin here");
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

// The bytes first, then the choice is told: a display that hears of it can have them.
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
    look_soon(guest, file);
  else
    drop(guest);
}

void LinkAvatars::drop(const GuestId& guest) {
  stop_watching(guest);
  if (link_ != nullptr) link_->core().files().drop(guest);
}

// In the thread.
void LinkAvatars::look_for(const GuestId& guest, const AvatarFile& file) {
  if (!store_.find(file.hash).empty()) return;
  const auto begun = std::make_shared<ChunkedFile>(static_cast<std::uint32_t>(file.size_bytes));
  const std::vector<std::uint8_t> part = store_.part(guest, file.hash);
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
      say_once({guest, file.hash, Said::kResumed},
               std::string(guest.view()) + "'s avatar is fetched on from " +
                   std::to_string(here * wire::kFileChunk / 1000) + " kB");
  });
}

void LinkAvatars::keep(const GuestId& guest, const FileHash& hash, ChunkedFile&& file) {
  const auto heard = heard_.find(guest);
  const bool vrm = heard != heard_.end() && is_vrm(heard->second);
  in_thread([this, guest, hash, vrm, whole = std::make_shared<ChunkedFile>(std::move(file))] {
    AvatarStore::Pieces pieces;
    for (std::size_t i = 0; i < whole->blocks(); ++i) pieces.push_back(whole->block(i));
    store_.forget_part(guest, hash);
    const auto kept = store_.keep_foreign(hash, pieces, vrm);
    in_poller([this, guest, hash, kept] { settle(guest, hash, kept); });
  });
}

void LinkAvatars::settle(const GuestId& guest, const FileHash& hash, const Result<bool>& kept) {
  LinkFiles& files = link_->core().files();
  const std::string whose = std::string(guest.view()) + "'s avatar ";
  if (!kept) {
    // Not the file's fault; it is fetched again when the guest is heard of anew.
    files.settle(guest, hash, FileVerdict::kNotKept);
    return say_once({guest, hash, Said::kNotKept}, whose + "cannot be kept: " + kept.error().what);
  }
  files.settle(guest, hash, *kept ? FileVerdict::kRight : FileVerdict::kWrong);
  if (*kept)
    say_once({guest, hash, Said::kArrived}, whose + "has arrived");
  else if (files.fetches(guest, hash))
    say_once({guest, hash, Said::kAgain},
             whose + "is wrong with what was kept of it before; it is fetched from the begin");
  else
    say_once({guest, hash, Said::kDamaged}, whose + "came damaged; it is not shown");
}

void LinkAvatars::forget(const GuestId& guest) {
  heard_.erase(guest);
  drop(guest);
}

}  // namespace dance
