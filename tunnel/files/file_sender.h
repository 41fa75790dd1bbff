// FileSender: the avatars' files of this house's guests, as chunks on request, at a pace beside
// which poses never wait.
//
// Units/frames: MonoTime of one clock.
// Ownership:    shares the files' bytes; the queue is of fixed size.
// Threads:      none inside; one owner.
// Failure:      what is not offered is refused; what does not fit into the queue is asked for again
//               by who wants it.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "core/base/fixed_list.h"
#include "core/base/guest_id.h"
#include "tunnel/files/file_pace.h"
#include "tunnel/wire/wire_files.h"

namespace dance {

using FileBytes = std::shared_ptr<const std::vector<std::uint8_t>>;

struct FileSenderCounters {
  std::uint64_t chunks_sent = 0;
  std::uint64_t chunks_again = 0;  // of them: sent before, a short while ago
  std::uint64_t bytes_sent = 0;
  std::uint64_t not_offered = 0;
  std::uint64_t queue_full = 0;
};

class FileSender {
 public:
  explicit FileSender(double bytes_per_second);

  // nullptr takes it back.
  void offer(const GuestId& guest, const FileHash& hash, FileBytes bytes);
  bool offers(const GuestId& guest, const FileHash& hash) const;
  // False where that guest offers no such file.
  bool want(const GuestId& guest, const wire::FileWant& want, MonoTime now);
  // The next chunk that is due.
  std::optional<wire::FileChunk> next(MonoTime now);
  MonoTime next_deadline() const;
  void begin_session() { queue_.clear(); }
  void see_round_trip(Duration round_trip, MonoTime now) { pace_.see_round_trip(round_trip, now); }

  const FileSenderCounters& counters() const { return counters_; }
  const FilePace& pace() const { return pace_; }

 private:
  static constexpr std::size_t kQueue = 128;
  static constexpr std::size_t kRemembered = 256;
  struct Offer {
    GuestId guest;
    FileHash hash;
    FileBytes bytes;
  };
  struct Queued {
    wire::FileName file;
    std::uint16_t index = 0;
    bool operator==(const Queued&) const = default;
  };
  struct Sent {
    Queued what;
    MonoTime at;
  };

  const Offer* find(const FileHash& hash) const;
  void note_sent(const Queued& what, MonoTime now);

  FilePace pace_;
  std::vector<Offer> offers_;
  FixedList<Queued, kQueue> queue_;
  std::array<Sent, kRemembered> sent_{};
  std::size_t sent_at_ = 0;
  FileSenderCounters counters_;
};

}  // namespace dance
