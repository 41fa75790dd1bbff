// The way of voices through the server: checked against their session and their budget, and sent to
// those in the room who want them, undecoded, in the turn in which they come and behind the poses
// of that turn. Nothing of it is acknowledged, kept or sent again, and no pose is told of it.
//
// Units/frames: MonoTime of the server's clock; sessions by index.
// Ownership:    refers to the server's context. Never allocates.
// Threads:      none inside; one owner.
// Failure:      what a datagram does not do right is counted by cause; a flood costs its sender
//               alone.
#pragma once

#include "tunnel/server/core/server_context.h"

namespace dance {

class ServerVoice {
 public:
  explicit ServerVoice(ServerContext& server) : server_(server) {}

  void on_voices(std::size_t session, wire::Bytes body, MonoTime received, MonoTime now);
  // From another server of the cluster, with the slot that its guest has here.
  void on_remote_voice(std::size_t session, const wire::VoiceRecord& record, MonoTime now);
  // What is due; at the end of a turn, behind the poses.
  void send_due(MonoTime now);
  MonoTime next_deadline() const;

 private:
  void on_voice(std::size_t session, const wire::VoiceRecord& record, MonoTime received,
                MonoTime now);
  void take(std::size_t session, ServerGuest& guest, const wire::VoiceRecord& record, MonoTime now);
  bool wants(const ServerSession& receiver, std::size_t index, std::uint8_t slot) const;
  void offer(std::size_t to, const wire::VoiceRecord& record, MonoTime now);
  bool flush(std::size_t to, MonoTime now);
  void send(ServerSession& to, wire::Bytes datagram);

  ServerContext& server_;
};

}  // namespace dance
