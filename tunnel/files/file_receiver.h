// FileReceiver: the avatars' files that this house wants of the others: asks for their chunks, one
// file after the other, as fast as the pace and the path allow, again where one does not come, and
// puts them together. A file whose hash is wrong is not asked for again, unless it began with bytes
// that were brought along: these may be another's, so that it is fetched once from nothing.
//
// Units/frames: MonoTime of one clock.
// Ownership:    owns what has come of each file, within kMostBytes; whole files are handed on.
// Threads:      none inside; one owner.
// Failure:      what was not asked for is false and takes no memory; a file of another size than
//               was said is wrong; no guest gets more than kBytesPerGuest at once and a minute.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "core/base/guest_id.h"
#include "core/base/token_bucket.h"
#include "tunnel/files/chunk_requests.h"
#include "tunnel/files/chunked_file.h"
#include "tunnel/files/file_pace.h"

namespace dance {

struct FileReceiverCounters {
  std::uint64_t chunks_asked = 0;
  std::uint64_t chunks_taken = 0;
  std::uint64_t chunks_again = 0;    // asked for once more, as they did not come in time
  std::uint64_t chunks_foreign = 0;  // not asked for
  std::uint64_t files_whole = 0;
  std::uint64_t files_wrong = 0;  // of another hash or size
  std::uint64_t files_anew = 0;   // wrong with what was brought along: once more without
  std::uint64_t files_refused = 0;
};

// What became of a file that was handed on.
enum class FileVerdict : std::uint8_t {
  kRight,
  kWrong,    // of another hash
  kNotKept,  // right or not, the disk did not take it: nothing is known against it
};

class FileReceiver {
 public:
  static constexpr double kBytesPerGuest = wire::kMaxFileBytes;
  static constexpr std::size_t kMostBytes = std::size_t{64} << 20;
  static constexpr std::size_t kMostBad = 64;

  explicit FileReceiver(double bytes_per_second);

  // What has come of it before may be brought along. One of a guest takes the place of another.
  void want(const GuestId& guest, const FileHash& hash, ChunkedFile begin, MonoTime now);
  void drop(const GuestId& guest);
  bool wants(const GuestId& guest, const FileHash& hash) const;
  // Of the file that was handed on. One that is fetched from nothing now is still wanted.
  void settle(const GuestId& guest, const FileHash& hash, FileVerdict verdict);

  // What to ask for now. `slot_of` is where a guest is; nullopt = not here.
  using SlotOf = std::function<std::optional<wire::Slot>(const GuestId&)>;
  std::optional<wire::FileWant> next(const SlotOf& slot_of, MonoTime now);
  MonoTime next_deadline() const;

  // False for what was not asked for. on_whole is called with the last chunk.
  bool take(const GuestId& from, const wire::FileChunk& chunk, MonoTime now);
  bool refuse(const GuestId& from, const wire::FileRefusal& refusal, MonoTime now);
  // A new session: nothing is under way any more.
  void begin_session();
  void see_round_trip(Duration round_trip, MonoTime now) { pace_.see_round_trip(round_trip, now); }

  std::function<void(const GuestId&, const FileHash&, ChunkedFile&&)> on_whole;
  // So many blocks from the begin are here now: to be kept for after a restart.
  std::function<void(const GuestId&, const FileHash&, const ChunkedFile&, std::size_t block)>
      on_block;
  std::function<void(const GuestId&, const FileHash&, wire::FileRefusalCause)> on_refused;

  const FileReceiverCounters& counters() const { return counters_; }
  const FilePace& pace() const { return pace_; }
  // Of what has come and is not whole.
  std::size_t held_bytes() const;

 private:
  struct Download {
    GuestId guest;
    FileHash hash;
    ChunkedFile file;
    ChunkRequests asked;
    std::vector<bool> was_asked;  // ever: a late one is taken, what was never asked for is not
    bool is_resumed = false;      // began with bytes kept from an earlier transfer
    std::size_t cursor = 0;
    std::size_t blocks_told = 0;
    bool is_whole = false;  // being checked
    MonoTime begun;         // its turn
    MonoTime last_chunk;
    MonoTime rests_until;
  };
  struct Budget {
    TokenBucket bytes{kBytesPerGuest / 60.0, kBytesPerGuest};
    MonoTime used;
  };

  Download* find(const GuestId& guest);
  Download* active(const SlotOf& slot_of, MonoTime now);
  void expire(Download& download, MonoTime now);
  Duration timeout() const;
  bool may_ask(const Download& download, MonoTime now) const;
  bool pay(const GuestId& guest, double bytes, MonoTime now);
  void tell_blocks(Download& download);
  static void begin_anew(Download& download);
  void make_room(const Download& keep);
  bool is_bad(const GuestId& guest, const FileHash& hash) const;
  void remember_bad(const GuestId& guest, const FileHash& hash);

  FilePace pace_;
  std::vector<Download> downloads_;  // the first that can has its turn
  std::map<GuestId, Budget> budgets_;
  std::vector<std::pair<GuestId, FileHash>> bad_;
  MonoTime looked_;  // next() was called last
  Duration mean_wait_ = Duration::ms(500);
  FileReceiverCounters counters_;
};

}  // namespace dance
