// HouseInputs decides which captures and requests a house or a link accepts. It accepts those that
// this process publishes and those that this user's programs send over the house's socket. Any user
// can publish on the bus, so captures from there are accepted only for guests that the house file
// or the command line names. Other subscriptions go to the port as they are.
//
// Units/frames: as on the bus.
// Ownership:    refers to port, bus and poller, which must outlive it; owns the socket. Nothing is
//               allocated once each guest has been seen.
// Threads:      the poller's.
// Failure:      problem() is the reason why there is no socket. Refused poses on the bus are
//               counted, and reported if no accepted ones of that guest arrive.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/bus/signal_port.h"
#include "core/control/house_socket.h"

namespace dance {

class HouseInputs final : public SignalPort {
 public:
  struct Options {
    std::string bus_url;
    // Guests whose captures are accepted from the bus.
    std::vector<GuestId> from_bus;
    // Guests whose poses, hands and proportions this process publishes: no others are accepted.
    std::vector<GuestId> hosted;
    // Poses of this guest arrive on the bus only. Called again for each further kReportedEach.
    std::function<void(const GuestId&)> on_refused;
  };
  static constexpr std::uint32_t kReportedEach = 120;

  // `port` has what this process publishes and gets all other subscriptions; `bus` is the bus.
  HouseInputs(SignalPort& port, SignalPort& bus, Options options, Poller& poller);
  ~HouseInputs() override;
  HouseInputs(const HouseInputs&) = delete;
  HouseInputs& operator=(const HouseInputs&) = delete;

  void send(const Channel& channel, const AnyMessage& message) override {
    port_.send(channel, message);
  }
  void add(std::shared_ptr<Subscription> subscription) override;
  const Counters& counters() const override { return counters_; }

  // A message that this process publishes; the port calls it.
  void receive_own(const Channel& channel, const AnyMessage& message, MonoTime now);
  // Path of the socket; "" if there is none.
  std::string socket_path() const { return socket_ ? socket_->path() : ""; }
  // "" = the socket is open.
  const std::string& problem() const { return problem_; }
  std::uint64_t refused() const { return refused_; }

 private:
  class BusGate;
  struct Seen {
    GuestId guest;
    std::uint32_t refused = 0;  // poses in a row that came on the bus only
  };
  bool is_from_bus(Signal signal, const GuestId& guest) const;
  bool is_hosted(Signal signal, const GuestId& guest) const;
  void take_from_socket(const Channel& channel, const Arrival& arrival);
  void note_received(const Channel& channel);
  void note_refused(const Channel& channel);
  Seen* seen_of(const GuestId& guest);

  SignalPort& port_;
  SignalPort& bus_;
  Options options_;
  std::vector<std::shared_ptr<Subscription>> subscriptions_;
  std::vector<Seen> seen_;
  std::uint64_t refused_ = 0;
  Counters counters_;
  std::string problem_;
  std::unique_ptr<HouseSocket> socket_;
};

// Message for the user when poses of a guest are refused, with the cure.
std::string refused_poses_line(const GuestId& guest);
// Message for the user when the socket could not be opened.
std::string no_house_socket_line(const std::string& problem);

}  // namespace dance
