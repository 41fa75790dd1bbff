#include "tunnel/link/signals/link_files.h"

namespace dance {
namespace {

// Of a server before these records each costs a rejected datagram.
constexpr int kTriesOfTerms = 6;

}  // namespace

LinkFiles::LinkFiles(LinkContext& link)
    : link_(link),
      receiver_(link.options.file_bytes_per_second),
      sender_(link.options.file_bytes_per_second),
      slot_of_([this](const GuestId& guest) { return slot_of(guest); }) {
  receiver_.on_whole = [this](const GuestId& guest, const FileHash& hash, ChunkedFile&& file) {
    if (link_.handlers.on_file) link_.handlers.on_file(guest, hash, std::move(file));
  };
  receiver_.on_block = [this](const GuestId& guest, const FileHash& hash, const ChunkedFile& file,
                              std::size_t block) {
    if (link_.handlers.on_file_block) link_.handlers.on_file_block(guest, hash, file, block);
  };
  receiver_.on_refused = [this](const GuestId& guest, const FileHash& hash,
                                wire::FileRefusalCause cause) {
    if (link_.handlers.on_file_refused) link_.handlers.on_file_refused(guest, hash, cause);
  };
}

template <class Message>
void LinkFiles::send(const Message& message) {
  std::array<std::uint8_t, wire::kMaxPlain> out;
  link_.send({out.data(), wire::build(message, out)});
}

void LinkFiles::offer(const GuestId& guest, const FileHash& hash, FileBytes bytes) {
  sender_.offer(guest, hash, std::move(bytes));
}

void LinkFiles::fetch(const GuestId& guest, const FileHash& hash, ChunkedFile begin, MonoTime now) {
  if (link_.options.file_bytes_per_second > 0.0) receiver_.want(guest, hash, std::move(begin), now);
}

void LinkFiles::begin_session() {
  tries_left_ = kTriesOfTerms;
  link_.server_knows_files = server_takes_files_ = false;
  receiver_.begin_session();
  sender_.begin_session();
}

void LinkFiles::say_terms() {
  if (link_.server_knows_files || tries_left_ == 0) return;
  --tries_left_;
  send(wire::FileTerms{static_cast<std::uint32_t>(link_.options.file_bytes_per_second)});
}

bool LinkFiles::receive(const wire::Opening& opening, MonoTime now) {
  if (opening.type == wire::Type::kFileTerms) return on_terms(opening.body);
  if (!link_.server_knows_files) return false;
  if (opening.type == wire::Type::kFileWant) return on_want(opening.body, now);
  if (opening.type == wire::Type::kFileChunk) return on_chunk(opening.body, now);
  return on_refusal(opening.body, now);
}

bool LinkFiles::on_terms(wire::Bytes body) {
  const auto terms = wire::parse_file_terms(body);
  if (!terms) return false;
  link_.server_knows_files = true;
  server_takes_files_ = terms->bytes_per_second > 0;
  return true;
}

bool LinkFiles::on_want(wire::Bytes body, MonoTime now) {
  const auto want = wire::parse_file_want(body);
  if (!want) return false;
  const LocalGuest* guest = link_.locals.find_slot(want->file.slot.slot);
  if (guest == nullptr || guest->slot != want->file.slot) return false;
  if (sender_.want(guest->id, *want, now)) return true;
  send(wire::FileRefusal{want->file, link_.options.file_bytes_per_second > 0.0
                                         ? wire::FileRefusalCause::kNotOffered
                                         : wire::FileRefusalCause::kNoFiles});
  return true;
}

const GuestId* LinkFiles::remote_in(const wire::Slot& slot) const {
  const RemoteGuest& remote = link_.remotes[slot.slot];
  return remote.in_use && !remote.is_ours && remote.generation == slot.generation ? &remote.id
                                                                                  : nullptr;
}

std::optional<wire::Slot> LinkFiles::slot_of(const GuestId& guest) const {
  for (const RemoteGuest& remote : link_.remotes)
    if (remote.in_use && !remote.is_ours && remote.id == guest)
      return wire::Slot{link_.remotes.slot_of(remote), remote.generation};
  return std::nullopt;
}

bool LinkFiles::on_chunk(wire::Bytes body, MonoTime now) {
  const auto chunk = wire::parse_file_chunk(body);
  if (!chunk) return false;
  const GuestId* from = remote_in(chunk->file.slot);
  return from != nullptr && receiver_.take(*from, *chunk, now);
}

bool LinkFiles::on_refusal(wire::Bytes body, MonoTime now) {
  const auto refusal = wire::parse_file_refusal(body);
  if (!refusal) return false;
  const GuestId* from = remote_in(refusal->file.slot);
  return from != nullptr && receiver_.refuse(*from, *refusal, now);
}

void LinkFiles::see_round_trip(Duration round_trip, MonoTime now) {
  receiver_.see_round_trip(round_trip, now);
  sender_.see_round_trip(round_trip, now);
}

bool LinkFiles::may_send() const {
  return link_.is_connected() && server_takes_files_ && link_.stream.bundle.is_empty();
}

// One of each at most: the rest waits for the next turn, so that a pose is before it.
void LinkFiles::send_due(MonoTime now) {
  if (!may_send()) return;
  if (const auto chunk = sender_.next(now)) send(*chunk);
  if (const auto want = receiver_.next(slot_of_, now)) send(*want);
}

// While records wait, their own deadline comes first.
MonoTime LinkFiles::next_deadline() const {
  if (!may_send()) return MonoTime();
  return earlier(sender_.next_deadline(), receiver_.next_deadline());
}

}  // namespace dance
