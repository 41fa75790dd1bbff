// How links come to sessions, and sessions to their end: hellos are welcomed or refused, guests get
// their slots, rooms open and close.
//
// Units/frames: MonoTime of the server's clock; sessions and rooms by index.
// Ownership:    refers to the server's context and parts.
// Threads:      none inside; one owner.
// Failure:      a hello that cannot be met is refused with its cause, and counted.
#pragma once

#include <functional>

#include "tunnel/server/core/server_slots.h"
#include "tunnel/server/signals/server_interest.h"

namespace dance {

class ServerAdmission {
 public:
  using RandomU64 = std::function<std::uint64_t()>;

  ServerAdmission(ServerContext& server, ServerSlots& slots, ServerFeedback& feedback,
                  ServerInterest& interest, RandomU64 random);

  void on_hello(PeerId from, const Access& access, wire::Bytes body, MonoTime received,
                MonoTime now);
  void drop(std::size_t session);
  // Tells a peer that a host has removed its guests; the nonce is that of its hello, or 0.
  void send_removal_notice(PeerId to, std::uint64_t nonce, Duration for_how_long);

  // For ServerRemotes: another server of the cluster in a room, as a session; nothing where there
  // is no place for it.
  std::optional<std::size_t> open_remote(std::size_t room, ServerId server, MonoTime now);
  std::optional<std::size_t> find_room(const wire::RoomName& name) const;

  // Names of those who have a key of their own: a key for all does not open them.
  void set_reserved(std::function<bool(const GuestId&)> is_reserved) {
    is_reserved_ = std::move(is_reserved);
  }

 private:
  struct Objection {
    wire::Refusal cause;
    GuestId guest;
    Duration removed_for = {};
  };
  std::optional<Objection> objection_to(const wire::Hello& hello, const Access& access,
                                        std::optional<std::size_t> existing,
                                        std::optional<std::size_t> room, MonoTime now) const;
  std::optional<wire::Refusal> full_for_listener(const Access& access,
                                                 std::optional<std::size_t> existing,
                                                 const ServerRoom& room) const;
  std::optional<Objection> objection_to_guests(const wire::Hello& hello, const Access& access,
                                               std::optional<std::size_t> existing,
                                               const ServerRoom* room, MonoTime now) const;
  bool may_take_over(const ServerGuest& guest, std::uint64_t link_token, MonoTime now) const;
  void welcome(std::size_t session, const wire::Hello& hello, MonoTime received, MonoTime now);
  void refuse(PeerId to, const GuestId& key, const wire::RoomName& room, std::uint64_t nonce,
              wire::Refusal cause, const GuestId& guest);
  void audit_refusal(PeerId to, const GuestId& key, const wire::RoomName& room,
                     wire::Refusal cause);
  std::optional<std::size_t> find_token(std::uint64_t token, const GuestId& key) const;
  std::size_t open_room(const Access& access, const wire::Hello& hello, MonoTime now);
  std::size_t open_session(PeerId peer, const Access& access, const wire::Hello& hello,
                           std::size_t room);
  std::uint64_t new_epoch();
  void move_session(std::size_t session, PeerId to);
  void settle_access(std::size_t session, const Access& access);
  bool settle_guests(std::size_t session, const wire::Hello& hello);
  void bring_guest(std::size_t session, const GuestId& id, std::uint64_t link_token);
  void close_room(std::size_t room);
  void count_hosts(ServerRoom& room, int change);

  ServerContext& server_;
  ServerSlots& slots_;
  ServerFeedback& feedback_;
  ServerInterest& interest_;
  RandomU64 random_;
  std::function<bool(const GuestId&)> is_reserved_;
  std::array<TokenBucket, 256> hellos_;  // by key: names that fall on one place share it
};

}  // namespace dance
