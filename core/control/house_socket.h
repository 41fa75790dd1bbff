// The house's socket: how programs of this user reach the links and houses of a bus past the bus,
// which every user of the machine can read and write. A message on it is the name of its channel,
// a zero, and the encoded message as on the bus.
//
// Units/frames: as on the bus.
// Ownership:    HouseSocket owns its socket, HouseSender its connections; the poller must
//               outlive them. Sending and receiving allocate nothing.
// Threads:      the poller's.
// Failure:      HouseSocket::open() names what is wrong with the user's folder of sockets. The
//               sender counts the messages that a house that does not read has lost.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/bus/subscription.h"
#include "core/net/local/local_messages.h"

namespace dance {

// True for messages that houses receive over their socket: captures and choices of a guest, which
// go to other houses, how a guest is to be shown, and requests of windows and voices.
bool goes_to_house(Signal signal, Where where);
// Requests, which are sent over the socket only.
bool is_request(Signal signal, Where where);

class HouseSocket {
 public:
  using OnMessage = std::function<void(const Channel& channel, const Arrival& arrival)>;

  // `bus_url`: the LCM URL of the house's programs; the part after '?' is ignored.
  static Result<std::unique_ptr<HouseSocket>> open(std::string_view bus_url, OnMessage on_message,
                                                   Poller& poller);

  const std::string& path() const { return server_->path(); }
  const LocalMessageServer::Counters& counters() const { return server_->counters(); }
  std::uint64_t unknown() const { return unknown_; }  // messages of no channel of houses

 private:
  explicit HouseSocket(OnMessage on_message) : on_message_(std::move(on_message)) {}
  void receive(std::span<const std::uint8_t> message, MonoTime now);

  OnMessage on_message_;
  std::uint64_t unknown_ = 0;
  std::unique_ptr<LocalMessageServer> server_;
};

// Sends to every house of a bus. Houses that start later are found within kSearchPeriod.
class HouseSender {
 public:
  static constexpr std::size_t kMostHouses = 16;
  static constexpr Duration kSearchPeriod = Duration::ms(250);

  HouseSender(std::string_view bus_url, Poller& poller);
  ~HouseSender();
  HouseSender(const HouseSender&) = delete;
  HouseSender& operator=(const HouseSender&) = delete;

  // Excludes this process's own socket from every send().
  void leave_out(std::string path) { left_out_ = std::move(path); }
  void send(const Channel& channel, const AnyMessage& message);
  std::size_t house_count() const { return houses_.size(); }
  std::uint64_t lost() const { return lost_; }

 private:
  struct House {
    std::string path;
    LocalMessageSender sender;
    bool is_gone = false;
  };
  void connect_to_houses();

  Poller& poller_;
  std::string path_;
  std::string left_out_;
  std::vector<House> houses_;
  std::uint64_t lost_ = 0;
  Poller::TimerId timer_;
};

}  // namespace dance
