// A house's link to the server: LinkCore with a sealed session and a socket around it, for a
// process that has a poller. No bus in here: tunnel/link/link_bus.h puts one on it, and a whole
// house in one process needs none.
//
// Units/frames: poses in and out are in this process's clock.
// Ownership:    owns socket and core; the poller, and what the handlers refer to, must outlive it.
// Threads:      the poller's; handlers run there too.
// Failure:      open() tells when there is no way to the address; a server that does not answer is
//               asked again for as long as the link lives.
#pragma once

#include <memory>
#include <vector>

#include "core/base/result.h"
#include "core/bus/messages.h"
#include "core/net/address_watch.h"
#include "core/net/names/name_lookup.h"
#include "core/net/poller.h"
#include "core/net/udp_socket.h"
#include "tunnel/link/failover/server_candidates.h"
#include "tunnel/link/failover/server_choice.h"
#include "tunnel/link/failover/server_probe.h"
#include "tunnel/link/link_core.h"
#include "tunnel/link/link_key.h"
#include "tunnel/seal/seal_client.h"

namespace dance {

class Link {
 public:
  // Token, clock and seed of the options are filled in where they are 0.
  // Addresses of one server: until one has answered they are tried in turn. Where it is one of a
  // cluster the link goes to the nearest, and to another when that one ends. Without an address the
  // link waits until options.look_up has found one.
  static Result<std::unique_ptr<Link>> open(std::vector<Address> server, const LinkKey& key,
                                            LinkOptions options, LinkHandlers handlers,
                                            Poller& poller);
  // Says goodbye.
  ~Link();
  Link(const Link&) = delete;
  Link& operator=(const Link&) = delete;

  // Leave at once, in this turn; dropped and counted where there is no session. A guest that was
  // not announced is, with its first pose.
  // Signal: whatever LinkCore::send() takes.
  template <class Signal>
  void send(const GuestId& guest, const Signal& signal, MonoTime now) {
    core_.send(guest, signal, now);
    rearm();
  }
  // Whose channel it is; where that is not set, the rule or the house's first guest decides.
  void send_channel(std::string_view name, wire::Bytes message, MonoTime now,
                    const GuestId& guest = GuestId());

  // Files of avatars: what the link offers and fetches. fetch_file() as LinkFiles::fetch().
  LinkCore& core() { return core_; }
  const LinkCore& core() const { return core_; }
  void fetch_file(const GuestId& guest, const FileHash& hash, ChunkedFile begin, MonoTime now) {
    core_.files().fetch(guest, hash, std::move(begin), now);
    rearm();
  }

  // As LinkCore does.
  void set_interest(const Interest& interest, MonoTime now);
  void ask_removal(const GuestId& guest, std::int32_t number) {
    core_.ask_removal(guest, number);
    rearm();
  }
  void set_hearing(const Hearing& hearing, MonoTime now) { core_.set_hearing(hearing, now); }

  // The address of the server that the link uses; not set while its name is unknown.
  Address server() const { return server_.empty() ? Address() : server_[tried_]; }
  bool is_connected() const { return core_.is_connected(); }
  LinkState state() const { return core_.state(); }
  const LinkCounters& counters() const { return core_.counters(); }
  const SealClientCounters& seal_counters() const { return seal_.counters(); }
  const ClockMapper& clock() const { return core_.clock(); }
  std::vector<RemoteGuestStats> remote_stats() const { return core_.remote_stats(); }
  std::vector<LocalGuestStats> local_stats() const { return core_.local_stats(); }
  const PathStats& path() const { return core_.path(); }
  std::optional<Music> room_music(MonoTime now) const { return core_.room_music(now); }
  std::optional<RoomSong> room_song(MonoTime now) const { return core_.room_song(now); }
  const GuestId& room_setter(wire::StateKind kind) const { return core_.room_setter(kind); }
  // Since the link began.
  Duration uptime() const;
  // As STATS/link says it.
  Stats stats(MonoTime now) const;

 private:
  // Past the batch: each datagram of a link is due when it is made.
  class DirectSink final : public DatagramSink {
   public:
    explicit DirectSink(UdpSocket& socket) : socket_(socket) {}
    void send(const Address& to, std::span<const std::uint8_t> bytes) override {
      socket_.send_now(to, bytes);
    }

   private:
    UdpSocket& socket_;
  };

  Link(std::vector<Address> server, UdpSocket socket, std::unique_ptr<SealContext> context,
       std::unique_ptr<NameLookup> lookup, const LinkOptions& options, LinkHandlers handlers,
       Poller& poller);
  SealClient::Handlers seal_handlers();
  void on_trouble(SealTrouble trouble, MonoTime now);
  MonoTime tick(MonoTime now);
  MonoTime next_deadline() const;
  void watch_socket();
  void on_readable(MonoTime now);
  void rearm();
  void try_another_socket();
  void on_addresses_changed(MonoTime now);
  bool use_socket_to(std::size_t which);
  // Resolves the server's name again, unless that was done a moment ago.
  void look_up_server(MonoTime now);
  void on_looked_up(MonoTime now);
  void use_addresses(std::vector<Address> addresses, MonoTime now);
  bool has_server_answered() const { return seal_.counters().sessions > sessions_elsewhere_; }
  void on_servers(const wire::ServerList& servers, MonoTime now);
  void choose_server(MonoTime now);
  bool have_answered(const std::vector<Address>& servers) const;
  // Measures the distances of all servers when each may be probed again.
  void plan_probe(MonoTime now);
  void probe_servers(MonoTime now);
  void on_probed(MonoTime now);
  void move_to(const Address& server, MonoTime now);
  static LinkHandlers with_servers(LinkHandlers handlers, Link& link);

  Poller& poller_;
  std::vector<Address> server_;
  std::size_t tried_ = 0;  // index of the address that the socket sends to
  ServerCandidates candidates_;
  ServerChoice choice_;
  ServerProbe probe_;
  MonoTime probe_due_;    // not set: no probe is planned
  int probe_rounds_ = 0;  // since the last plan_probe()
  std::function<void(const Address&)> on_other_server_;
  std::function<void(const Address&)> on_no_answer_;
  std::function<void(SealTrouble)> on_no_entry_;
  SealTrouble told_trouble_ = SealTrouble::kNoAnswer;
  MonoTime told_at_;
  std::uint64_t clock_id_;
  MonoTime begin_;
  std::unique_ptr<AddressWatch> addresses_;  // nullptr: the kernel does not report changes
  std::unique_ptr<NameLookup> lookup_;       // nullptr: the server has no name
  MonoTime next_lookup_;                     // not before then
  std::function<void(const Address&)> on_new_address_;
  std::function<void(const std::string&)> on_unknown_name_;
  std::uint64_t sessions_elsewhere_ = 0;  // begun before the name had other addresses
  UdpSocket socket_;
  DirectSink sink_;
  SealClient seal_;
  LinkCore core_;
  Poller::TimerId timer_;
  int hellos_on_socket_ = 0;
};

}  // namespace dance
