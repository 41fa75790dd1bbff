// Servers of a cluster without NATS and without waiting: each with its houses in a SimulatedTunnel,
// and between them messages and lasting values that arrive when the test's time says so. A server
// can be killed, and cut off from the others.
//
// Units/frames: all servers have one clock here; tests of SessionClock are elsewhere.
// Ownership:    owns everything.
// Threads:      none.
// Failure:      none.
#pragma once

#include <deque>
#include <map>
#include <set>

#include "tests/tunnel/simulated_tunnel.h"
#include "tunnel/cluster/cluster_node.h"

namespace dance {

class SimulatedCluster {
 public:
  static ServerLimits limits() {
    ServerLimits limits;
    limits.remote_servers = 64;
    limits.repeats = false;
    return limits;
  }

  class Site final : public ClusterBus {
   public:
    Site(SimulatedCluster& cluster, std::size_t number)
        : tunnel(limits(), 100 + number), cluster_(cluster), number_(number) {
      start();
    }
    void start() {
      subjects.clear();
      watched.clear();
      arrivals.clear();
      ClusterNode::Options options;
      options.id = 1000 * ++starts + number_ + 1;
      options.born_us = cluster_.now().since_zero_us() + static_cast<std::int64_t>(number_);
      node = std::make_unique<ClusterNode>(options, *this);
      node->attach(tunnel.server());
    }
    // As by SIGKILL: what it has said so far is said.
    void crash() {
      node.reset();
      tunnel.stop_server();
      subjects.clear();
      watched.clear();
    }
    void restart() {
      tunnel.start_server();
      start();
    }
    SimulatedTunnel::House& add(const std::string& name, const std::string& room = "salsa") {
      // Full rooms need a key without a limit of its own.
      return tunnel.add_house(
          room, name.empty() ? std::vector<std::string>{} : std::vector<std::string>{name}, {},
          {.any_name = true, .is_local = true});
    }

    void set_handlers(Handlers handlers) override { handlers_ = std::move(handlers); }
    void publish(std::string_view subject, Bytes message) override {
      ++published[std::string(subject.substr(0, subject.find('.', 8)))];
      cluster_.publish(*this, subject, message);
    }
    void listen(std::string_view subject) override { subjects.insert(std::string(subject)); }
    void end_listen(std::string_view subject) override { subjects.erase(std::string(subject)); }
    void put(std::string_view key, Bytes value) override {
      cluster_.write(*this, std::string(key),
                     std::vector<std::uint8_t>(value.begin(), value.end()));
    }
    void erase(std::string_view key) override { cluster_.write(*this, std::string(key), {}); }
    void watch(std::string_view keys) override {
      watched.insert(prefix_of(keys));
      cluster_.read_all(*this, prefix_of(keys));
    }
    void end_watch(std::string_view keys) override { watched.erase(prefix_of(keys)); }

    struct Arrival {
      MonoTime due;
      bool is_value = false;
      std::string name;
      std::optional<std::vector<std::uint8_t>> bytes;
      bool is_last = true;
    };
    void deliver(MonoTime now) {
      for (std::size_t i = 0; i < arrivals.size();) {
        if (arrivals[i].due > now || (arrivals[i].is_value && is_cut)) {
          ++i;
          continue;
        }
        const Arrival arrival = std::move(arrivals[i]);
        arrivals.erase(arrivals.begin() + static_cast<std::ptrdiff_t>(i));
        if (!node) continue;
        if (!arrival.is_value)
          handlers_.on_message(arrival.name, *arrival.bytes, now);
        else if (arrival.bytes)
          handlers_.on_value(arrival.name, Bytes(*arrival.bytes), now);
        else
          handlers_.on_value(arrival.name, std::nullopt, now);
        if (arrival.is_value && arrival.is_last) handlers_.on_all_read(arrival.name, now);
      }
    }
    bool listens_to(const std::string& subject) const { return subjects.contains(subject); }
    bool watches(const std::string& key) const {
      return std::any_of(watched.begin(), watched.end(),
                         [&](const std::string& prefix) { return key.starts_with(prefix); });
    }
    void come_back(MonoTime now) { handlers_.on_back(now); }

    SimulatedTunnel tunnel;
    std::unique_ptr<ClusterNode> node;
    std::set<std::string> subjects, watched;
    std::deque<Arrival> arrivals;
    std::map<std::string, int> published;  // by kind of subject
    bool is_cut = false;
    std::uint64_t starts = 0;

   private:
    static std::string prefix_of(std::string_view keys) {
      return std::string(keys.substr(0, keys.size() - 1));  // without '>'
    }
    SimulatedCluster& cluster_;
    std::size_t number_;
    Handlers handlers_;
  };

  explicit SimulatedCluster(std::size_t servers) {
    for (std::size_t i = 0; i < servers; ++i) sites_.push_back(std::make_unique<Site>(*this, i));
    run(Duration::ms(1300));
  }
  Site& operator[](std::size_t i) { return *sites_[i]; }
  MonoTime now() const { return now_; }

  void run(Duration duration, const std::function<void()>& each_ms = {}) {
    for (const MonoTime end = now_ + duration; now_ < end;) {
      now_ += Duration::ms(1);
      write_what_is_due();
      for (auto& site : sites_) {
        site->deliver(now_);
        site->tunnel.run(Duration::ms(1));
        if (!site->node) continue;
        site->node->tick(now_);
        site->node->end_turn(now_);
      }
      if (each_ms) each_ms();
    }
  }
  // Those dance, each 16 ms.
  using Dancer = std::pair<SimulatedTunnel::House*, std::string>;
  void dance(Duration duration, const std::vector<Dancer>& dancers) {
    run(duration, [&] {
      if (now_.since_zero_us() / 1000 % 16 != 0) return;
      for (const auto& [house, name] : dancers)
        for (auto& site : sites_)
          if (site->tunnel.has(*house)) site->tunnel.dance(*house, guest(name));
    });
  }

  // Messages are lost while a server is cut off; values wait.
  void cut(std::size_t site) { sites_[site]->is_cut = true; }
  void join(std::size_t site) {
    sites_[site]->is_cut = false;
    auto waiting = std::move(waiting_);
    waiting_.clear();
    for (Write& it : waiting) write(*it.from, it.key, std::move(it.bytes));
  }
  // Of each of its keys the newest value, each at any time until then, unless it is written again.
  void join(std::size_t site, Duration longest, Random& random) {
    sites_[site]->is_cut = false;
    for (Write& it : waiting_)
      if (it.from == sites_[site].get())
        it.due = now_ + Duration::ns(static_cast<std::int64_t>(
                            static_cast<double>(longest.count_ns()) * random.uniform()));
  }

  std::map<std::string, std::vector<std::uint8_t>> values;
  Duration delay = Duration::ms(2);

 private:
  friend class Site;
  struct Write {
    Site* from;
    std::string key;
    std::optional<std::vector<std::uint8_t>> bytes;
    MonoTime due;  // not set: when its site is no longer cut off
  };
  void publish(Site& from, std::string_view subject, ClusterBus::Bytes message) {
    if (from.is_cut) return;
    for (auto& site : sites_)
      if (site.get() != &from && !site->is_cut && site->node &&
          site->listens_to(std::string(subject)))
        site->arrivals.push_back({now_ + delay, false, std::string(subject),
                                  std::vector<std::uint8_t>(message.begin(), message.end())});
  }
  void write(Site& from, const std::string& key, std::optional<std::vector<std::uint8_t>> bytes) {
    std::erase_if(waiting_, [&](const Write& it) { return it.from == &from && it.key == key; });
    if (from.is_cut) {
      waiting_.push_back({&from, key, std::move(bytes), MonoTime()});
      return;
    }
    values.erase(key);
    written_.erase(key);
    if (bytes) {
      values[key] = *bytes;
      written_[key] = ++writes_;
    }
    for (auto& site : sites_)
      if (site->node && site->watches(key))
        site->arrivals.push_back({now_ + delay, true, key, bytes});
  }
  void write_what_is_due() {
    const auto is_due = [this](const Write& it) { return it.due.is_set() && it.due <= now_; };
    std::vector<Write> due;
    std::copy_if(waiting_.begin(), waiting_.end(), std::back_inserter(due), is_due);
    std::erase_if(waiting_, is_due);
    for (Write& it : due) write(*it.from, it.key, std::move(it.bytes));
  }
  void read_all(Site& to, const std::string& prefix) {
    std::map<std::uint64_t, std::string> in_order;
    for (const auto& [key, number] : written_)
      if (key.starts_with(prefix)) in_order[number] = key;
    for (const auto& [number, key] : in_order)
      to.arrivals.push_back(
          {now_ + delay, true, key, values.at(key), number == in_order.rbegin()->first});
  }

  MonoTime now_ = MonoTime::from_us(5'000'000'000);
  std::map<std::string, std::uint64_t> written_;  // when, by key
  std::uint64_t writes_ = 0;
  std::vector<std::unique_ptr<Site>> sites_;
  std::vector<Write> waiting_;
};

}  // namespace dance
