#include "tunnel/server/signals/server_files.h"

#include <algorithm>
#include <type_traits>

namespace dance {
namespace {

// While chunks wait for their pace, and while they wait for their owner.
constexpr Duration kSendingPeriod = Duration::ms(2);
constexpr Duration kWaitingPeriod = Duration::ms(50);
constexpr Duration kShortestTimeout = Duration::s(1);
// What one session gets of a file: twice its size, and as much as it has each ten minutes, so that
// a path that loses much goes on slowly, and none makes the server send for ever.
constexpr double kShareOfFile = 2.0;
constexpr double kSecondsForAnother = 600.0;
// To one session never two at once; to all together a few.
constexpr double kBurstOfSession = wire::kFileChunkCost;
constexpr double kBurstOfAll = 16.0 * wire::kFileChunkCost;
// To another server of the cluster, and from it: what all of its links want, once.
constexpr double kBetweenServers = 512e3;

}  // namespace

ServerFiles::ServerFiles(ServerContext& server)
    : server_(server),
      receivers_(server.sessions.size()),
      pace_(server.limits.file_bytes_per_second, kBurstOfAll) {
  waiting_.reserve(server.limits.sessions);
}

// To a link as a datagram, to another server through the cluster.
template <class Message>
void ServerFiles::send(std::size_t index, const Message& message) {
  const ServerSession& session = server_.sessions[index];
  if (!session.is_remote()) {
    std::array<std::uint8_t, wire::kMaxPlain> out;
    server_.send(session.peer, {out.data(), wire::build(message, out)});
  } else if constexpr (!std::is_same_v<Message, wire::FileTerms>) {
    if (const ServerGuest* guest = guest_in(session.room, message.file.slot))
      server_.cluster->on_file(server_.remote_receivers[session.remote].server,
                               server_.rooms[session.room], *guest, message);
  }
}

void ServerFiles::wake(MonoTime now) {
  if (!due_.is_set() || now < due_) due_ = now;
}

// What is known of a session; of one before it nothing counts.
ServerFiles::Receiver& ServerFiles::receiver(std::size_t session) {
  Receiver& known = receivers_[session];
  if (known.epoch == server_.sessions[session].epoch) return known;
  known = Receiver();
  known.epoch = server_.sessions[session].epoch;
  if (server_.sessions[session].is_remote())
    known.pace = FilePace(kBetweenServers, kBurstOfSession);
  return known;
}

bool ServerFiles::on_terms(std::size_t session, wire::Bytes body) {
  if (server_.limits.file_bytes == 0) {
    server_.reject(ServerReject::kUnknownType);
    return false;
  }
  const auto terms = wire::parse_file_terms(body);
  if (!terms) {
    server_.reject(ServerReject::kMalformed);
    return false;
  }
  ServerSession& from = server_.sessions[session];
  const bool is_new = !from.knows_files();
  from.files_epoch = from.epoch;
  Receiver& to = receiver(session);
  to.bytes_per_second = terms->bytes_per_second;
  if (is_new)
    to.pace = FilePace(
        std::min(to.bytes_per_second * 1.1, server_.limits.file_bytes_per_second_of_session),
        kBurstOfSession);
  const double most = server_.limits.file_bytes_per_second_of_session;
  send(session, wire::FileTerms{static_cast<std::uint32_t>(most)});
  return is_new;
}

ServerGuest* ServerFiles::guest_in(std::size_t room, const wire::Slot& slot) {
  ServerGuest& guest = server_.rooms[room].guests[slot.slot];
  return server_.rooms[room].in_use && guest.in_use && guest.generation == slot.generation
             ? &guest
             : nullptr;
}

ServerFiles::File* ServerFiles::find(std::size_t room, const wire::FileName& name) {
  for (File& file : files_)
    if (file.room == room && file.name == name) return &file;
  return nullptr;
}

void ServerFiles::refuse(std::size_t session, const wire::FileName& name,
                         wire::FileRefusalCause cause) {
  ++server_.counters.file_refusals;
  send(session, wire::FileRefusal{name, cause});
}

void ServerFiles::refuse_all(std::size_t room, const wire::FileName& name,
                             wire::FileRefusalCause cause) {
  for (const std::size_t session : waiting_) {
    if (server_.sessions[session].room != room) continue;
    auto& queue = receiver(session).queue;
    const std::size_t before = queue.size();
    for (std::size_t i = queue.size(); i-- > 0;)
      if (queue[i].name == name) queue.erase_at(i);
    if (queue.size() < before) refuse(session, name, cause);
  }
}

void ServerFiles::on_want(std::size_t session, wire::Bytes body, MonoTime now) {
  const auto want = wire::parse_file_want(body);
  if (!want) return server_.reject(ServerReject::kMalformed);
  if (!server_.sessions[session].knows_files()) return server_.reject(ServerReject::kForeignSlot);
  take(session, *want, now);
}

void ServerFiles::take(std::size_t session, const wire::FileWant& want, MonoTime now) {
  const ServerSession& from = server_.sessions[session];
  const ServerGuest* guest = guest_in(from.room, want.file.slot);
  // One server does not ask another for what a third one has.
  if (guest == nullptr || guest->owner == session ||
      (from.is_remote() && !server_.is_local(*guest)))
    return server_.reject(ServerReject::kForeignSlot);
  if (server_.limits.file_bytes == 0 || rate_of(guest->owner) <= 0.0)
    return refuse(session, want.file, wire::FileRefusalCause::kNoFiles);
  const auto chosen = chosen_by(*guest);
  if (!chosen || chosen->hash != want.file.hash)
    return refuse(session, want.file, wire::FileRefusalCause::kNotOffered);
  const File* file =
      find_or_add(from.room, want.file, static_cast<std::uint32_t>(chosen->size_bytes), now);
  if (file == nullptr) return refuse(session, want.file, wire::FileRefusalCause::kFull);
  Receiver& to = receiver(session);
  for (std::size_t i = 0; i < wire::kChunksPerWant; ++i) {
    const Queued queued{want.file, static_cast<std::uint16_t>(want.first + i)};
    if (!want.has(queued.index) || queued.index >= file->chunks.chunks()) continue;
    // What does not fit is asked for again.
    if (!to.queue.contains(queued) && !to.queue.try_push(queued)) break;
  }
  if (!to.queue.empty() && std::ranges::find(waiting_, session) == waiting_.end())
    waiting_.push_back(session);
  wake(now);
}

void ServerFiles::on_chunk(std::size_t session, wire::Bytes body, MonoTime now) {
  const auto chunk = wire::parse_file_chunk(body);
  if (!chunk) return server_.reject(ServerReject::kMalformed);
  take(session, *chunk, now);
}

void ServerFiles::take(std::size_t session, const wire::FileChunk& chunk, MonoTime now) {
  const ServerGuest* guest = server_.guest_of(session, chunk.file.slot.slot);
  if (guest == nullptr || guest->generation != chunk.file.slot.generation)
    return server_.reject(ServerReject::kForeignSlot);
  const std::size_t room = server_.sessions[session].room;
  File* file = find(room, chunk.file);
  if (file == nullptr || !file->asked.take(chunk.index).is_set())
    return server_.reject(ServerReject::kFileNotAsked);
  if (file->chunks.size_bytes() != chunk.size_bytes) {
    // Not the file that the guest has said: it will never be whole.
    file->asked.clear();
    refuse_all(room, chunk.file, wire::FileRefusalCause::kNotOffered);
    return server_.reject(ServerReject::kFileNotAsked);
  }
  if (file->chunks.put(chunk.index, chunk.data)) ++server_.counters.file_chunks_in;
  file->used = now;
  wake(now);
}

void ServerFiles::on_refusal(std::size_t session, wire::Bytes body, MonoTime now) {
  const auto refusal = wire::parse_file_refusal(body);
  if (!refusal) return server_.reject(ServerReject::kMalformed);
  take(session, *refusal, now);
}

void ServerFiles::take(std::size_t session, const wire::FileRefusal& refusal, MonoTime now) {
  const ServerGuest* guest = server_.guest_of(session, refusal.file.slot.slot);
  const std::size_t room = server_.sessions[session].room;
  File* file = find(room, refusal.file);
  if (guest == nullptr || guest->generation != refusal.file.slot.generation || file == nullptr)
    return server_.reject(ServerReject::kForeignSlot);
  file->asked.clear();
  refuse_all(room, refusal.file, refusal.cause);
  wake(now);
}

bool ServerFiles::may_have(Receiver& to, const File& file, MonoTime now) const {
  const auto of_slot = [&](const Served& it) { return it.name.slot.slot == file.name.slot.slot; };
  auto served = std::ranges::find_if(to.served, of_slot);
  if (served == to.served.end()) served = to.served.insert(served, Served());
  if (served->name != file.name) {
    const double size = std::max<double>(file.chunks.size_bytes(), wire::kFileChunk);
    *served = {file.name, TokenBucket(size / kSecondsForAnother, kShareOfFile * size)};
  }
  return served->bytes.take(wire::kFileChunk, now);
}

// One chunk to that session, if one is here and the pace allows. True when something went.
bool ServerFiles::serve(std::size_t session, MonoTime now) {
  ServerSession& to = server_.sessions[session];
  Receiver& waits = receiver(session);
  // While records wait for this receiver, chunks do.
  if (!to.stream.bundle.is_empty()) return false;
  if (to.is_remote() && !server_.cluster->is_clear()) return false;
  for (std::size_t i = 0; i < waits.queue.size(); ++i) {
    const Queued queued = waits.queue[i];
    File* file = find(to.room, queued.name);
    if (file == nullptr || queued.index >= file->chunks.chunks()) {
      waits.queue.erase_at(i--);
      continue;
    }
    if (!file->chunks.has(queued.index)) continue;
    // Both first: what one of them gives must not be lost where the other has nothing.
    if (!waits.pace.has(wire::kFileChunkCost, now) || !pace_.has(wire::kFileChunkCost, now))
      return false;
    if (!may_have(waits, *file, now)) {
      for (std::size_t j = waits.queue.size(); j-- > 0;)
        if (waits.queue[j].name == queued.name) waits.queue.erase_at(j);
      refuse(session, queued.name, wire::FileRefusalCause::kFull);
      return false;
    }
    waits.pace.take(wire::kFileChunkCost, now);
    pace_.take(wire::kFileChunkCost, now);
    waits.queue.erase_at(i);
    file->used = now;
    ++server_.counters.file_chunks_out;
    send(session, wire::FileChunk{file->name, file->chunks.size_bytes(), queued.index,
                                  file->chunks.chunk(queued.index)});
    return true;
  }
  return false;
}

// At which a session sends what it is asked for; 0 = no files.
double ServerFiles::rate_of(std::size_t session) {
  const ServerSession& of = server_.sessions[session];
  if (of.is_remote()) return kBetweenServers;
  return of.knows_files() ? receiver(session).bytes_per_second : 0.0;
}

double ServerFiles::owner_rate(const File& file) {
  const ServerGuest* guest = guest_in(file.room, file.name.slot);
  return guest != nullptr ? rate_of(guest->owner) : 0.0;
}

// Each chunk that somebody waits for and that is not here, once.
void ServerFiles::ask_owners(MonoTime now) {
  for (File& file : files_) {
    const double rate = owner_rate(file);
    if (file.chunks.is_whole() || rate <= 0.0) continue;
    const Duration timeout =
        kShortestTimeout + Duration::seconds(2.0 * ChunkRequests::kMost * wire::kFileChunk / rate);
    file.asked.expire(now - timeout);
    ask_owner(file, guest_in(file.room, file.name.slot)->owner, now);
  }
}

void ServerFiles::ask_owner(File& file, std::size_t owner, MonoTime now) {
  wire::FileWant want{file.name, 0, 0};
  const auto flush = [&] {
    if (want.chunks != 0) send(owner, want);
    want.chunks = 0;
  };
  for (const std::size_t session : waiting_) {
    if (server_.sessions[session].room != file.room) continue;
    for (const Queued& queued : receiver(session).queue) {
      // The name first: an index of another file may be beyond this one's end, and so may one that
      // was queued before the guest said another size.
      if (queued.name != file.name || queued.index >= file.chunks.chunks()) continue;
      if (file.chunks.has(queued.index) || file.asked.has(queued.index)) continue;
      if (!file.asked.add(queued.index, now)) break;
      const bool fits = want.chunks != 0 && queued.index >= want.first &&
                        queued.index - want.first < static_cast<int>(wire::kChunksPerWant);
      if (!fits) {
        flush();
        want.first = queued.index;
      }
      want.chunks |= 1u << (queued.index - want.first);
    }
  }
  flush();
}

void ServerFiles::send_due(MonoTime now) {
  if (!due_.is_set() || now < due_) return;
  std::erase_if(waiting_, [&](std::size_t session) {
    return !server_.sessions[session].in_use || receiver(session).queue.empty();
  });
  ask_owners(now);
  bool has_sent = false;
  for (const std::size_t session : waiting_) has_sent = serve(session, now) || has_sent;
  // Who was first is last the next time: all have their share.
  if (!waiting_.empty()) std::rotate(waiting_.begin(), waiting_.begin() + 1, waiting_.end());
  due_ = waiting_.empty() ? MonoTime() : now + (has_sent ? kSendingPeriod : kWaitingPeriod);
  for (const std::size_t session : waiting_) {
    const MonoTime ready = receiver(session).pace.ready_at(wire::kFileChunkCost);
    if (ready.is_set() && ready > now && ready < due_) due_ = ready;
  }
}

void ServerFiles::forget_absent() {
  for (auto it = files_.begin(); it != files_.end();) {
    const auto file = it++;
    if (guest_in(file->room, file->name.slot) == nullptr) forget(file);
  }
}

}  // namespace dance
