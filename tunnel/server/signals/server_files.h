// The files of avatars at the server: a bounded cache of what guests of its rooms have chosen, so
// that one upload serves all who want it. Only the file that a guest's retained AvatarFile names is
// fetched and kept, with the size that it says. Chunks are fetched from the guest's house as they
// are asked for, each once, and go out when no record waits for the same receiver. It does not look
// into them: receivers check the hash of the whole.
//
// Units/frames: MonoTime of the server's clock; sessions by index.
// Ownership:    refers to the server's context; owns the cache, within ServerLimits.
// Threads:      none inside; one owner.
// Failure:      foreign, malformed and unasked datagrams are counted; without memory the file is
//               refused.
#pragma once

#include <list>
#include <vector>

#include "tunnel/files/chunk_requests.h"
#include "tunnel/files/chunked_file.h"
#include "tunnel/files/file_pace.h"
#include "tunnel/server/core/server_context.h"
#include "tunnel/wire/wire_files.h"

namespace dance {

class ServerFiles {
 public:
  explicit ServerFiles(ServerContext& server);

  // True when the link has said so for the first time in this session.
  bool on_terms(std::size_t session, wire::Bytes body);
  void on_want(std::size_t session, wire::Bytes body, MonoTime now);
  void on_chunk(std::size_t session, wire::Bytes body, MonoTime now);
  void on_refusal(std::size_t session, wire::Bytes body, MonoTime now);
  // What they hold; from another server of the cluster too, whose guests are fetched from it.
  void take(std::size_t session, const wire::FileWant& want, MonoTime now);
  void take(std::size_t session, const wire::FileChunk& chunk, MonoTime now);
  void take(std::size_t session, const wire::FileRefusal& refusal, MonoTime now);

  // What is due; at the end of a turn.
  void send_due(MonoTime now);
  MonoTime next_deadline() const { return due_; }
  // Files of guests who have left, and of rooms that are empty.
  void forget_absent();

  std::size_t count() const { return files_.size(); }
  std::size_t size_bytes() const { return size_bytes_; }  // as claimed
  std::size_t bytes_of_key(const GuestId& key) const;     // of all its sessions

 private:
  struct File {
    std::size_t room = 0;
    wire::FileName name;
    ChunkedFile chunks;
    ChunkRequests asked;
    MonoTime used;  // a chunk came, or went out
  };
  struct Queued {
    wire::FileName name;
    std::uint16_t index = 0;
    bool operator==(const Queued&) const = default;
  };
  // How much of a file a session may still have.
  struct Served {
    wire::FileName name;
    TokenBucket bytes;
  };
  // Limits for one session, or for one key.
  struct Held {
    std::size_t files = 0, bytes = 0;
  };
  // What one session waits for.
  struct Receiver {
    std::uint64_t epoch = 0;
    double bytes_per_second = 0.0;  // as its link says
    FilePace pace;
    FixedList<Queued, 64> queue;
    std::vector<Served> served;  // one for each slot at most
  };

  // The avatar that this guest's house announced; nullopt = none.
  static std::optional<AvatarFile> chosen_by(const ServerGuest& guest);
  ServerGuest* guest_in(std::size_t room, const wire::Slot& slot);
  File* find(std::size_t room, const wire::FileName& name);
  File* find_or_add(std::size_t room, const wire::FileName& name, std::uint32_t size_bytes,
                    MonoTime now);
  bool is_in_use(const File& file, MonoTime now);
  template <class Matches>
  bool evict(const Matches& matches, MonoTime now);
  const ServerSession* owner_of(const File& file) const;
  template <class Matches>
  Held held_by(const Matches& matches) const;
  bool make_room(std::size_t session, std::uint32_t size_bytes, MonoTime now);
  void forget(std::list<File>::iterator file);
  template <class Message>
  void send(std::size_t session, const Message& message);
  void refuse(std::size_t session, const wire::FileName& name, wire::FileRefusalCause cause);
  void refuse_all(std::size_t room, const wire::FileName& name, wire::FileRefusalCause cause);
  Receiver& receiver(std::size_t session);
  bool may_have(Receiver& receiver, const File& file, MonoTime now) const;
  bool serve(std::size_t session, MonoTime now);
  void ask_owners(MonoTime now);
  void ask_owner(File& file, std::size_t owner, MonoTime now);
  double rate_of(std::size_t session);
  double owner_rate(const File& file);
  void wake(MonoTime now);

  ServerContext& server_;
  std::list<File> files_;
  std::vector<Receiver> receivers_;   // by session
  std::vector<std::size_t> waiting_;  // sessions with a queue; reserved
  FilePace pace_;
  std::size_t size_bytes_ = 0;
  MonoTime due_;
};

}  // namespace dance
