#include "testing/line/lossy_proxy.h"

#include <algorithm>
#include <cstring>

namespace dance {
namespace {

constexpr std::size_t kMostClients = 64;
constexpr std::size_t kStoreParcels = 8192;
constexpr int kBatchesPerTurn = 8;
constexpr std::size_t kNoClient = SIZE_MAX;

}  // namespace

Result<std::unique_ptr<LossyProxy>> LossyProxy::open(const Address& listen, const Address& target,
                                                     LossyLine line, Poller& poller) {
  DANCE_TRY(UdpSocket socket, UdpSocket::serve(listen));
  return std::unique_ptr<LossyProxy>(
      new LossyProxy(std::move(socket), target, std::move(line), poller));
}

LossyProxy::LossyProxy(UdpSocket listen, const Address& target, LossyLine line, Poller& poller)
    : poller_(poller),
      listen_(std::move(listen)),
      target_(target),
      line_(std::move(line)),
      store_(kStoreParcels) {
  free_.reserve(kStoreParcels);
  heap_.reserve(kStoreParcels);
  for (std::size_t i = kStoreParcels; i > 0; --i) free_.push_back(i - 1);
  poller_.watch(listen_.fd(), [this](MonoTime now) { on_client_side(now); });
  timer_ = poller_.add_timer(MonoTime(), [this](MonoTime now) { return deliver_due(now); });
}

LossyProxy::~LossyProxy() {
  poller_.set_deadline(timer_, MonoTime());
  poller_.unwatch(listen_.fd());
  for (const auto& client : clients_) poller_.unwatch(client->upstream.fd());
}

std::size_t LossyProxy::find_or_add(const Address& from, MonoTime came) {
  for (std::size_t i = 0; i < clients_.size(); ++i)
    if (clients_[i]->address == from) return i;
  if (clients_.size() == kMostClients) {
    ++refused_clients_;
    return kNoClient;
  }
  auto upstream = UdpSocket::connect(target_);
  if (!upstream) {
    ++refused_clients_;
    return kNoClient;
  }
  const std::size_t index = clients_.size();
  clients_.push_back(
      std::make_unique<Client>(Client{from, std::move(*upstream), LossyModel(line_.up, 2 * index),
                                      LossyModel(line_.down, 2 * index + 1)}));
  if (!begin_.is_set()) begin_ = came;
  clients_.back()->up.begin(begin_);
  clients_.back()->down.begin(begin_);
  poller_.watch(clients_.back()->upstream.fd(),
                [this, index](MonoTime now) { on_target_side(index, now); });
  return index;
}

void LossyProxy::on_client_side(MonoTime now) {
  for (int i = 0; i < kBatchesPerTurn; ++i) {
    const auto batch = listen_.receive();
    for (const UdpSocket::Datagram& datagram : batch) {
      const std::size_t client = find_or_add(datagram.from, now);
      if (client != kNoClient) carry(client, Direction::kUp, datagram.bytes, now);
    }
    if (batch.size() < UdpSocket::kBatch) break;
  }
}

void LossyProxy::on_target_side(std::size_t client, MonoTime now) {
  for (int i = 0; i < kBatchesPerTurn; ++i) {
    const auto batch = clients_[client]->upstream.receive();
    for (const UdpSocket::Datagram& datagram : batch)
      carry(client, Direction::kDown, datagram.bytes, now);
    if (batch.size() < UdpSocket::kBatch) break;
  }
}

bool LossyProxy::is_later(std::size_t a, std::size_t b) const {
  return store_[a].due != store_[b].due ? store_[a].due > store_[b].due
                                        : store_[a].order > store_[b].order;
}

void LossyProxy::carry(std::size_t client, Direction direction, std::span<const std::uint8_t> bytes,
                       MonoTime now) {
  if (tap_) tap_(direction, bytes);
  LossyModel& line = direction == Direction::kUp ? clients_[client]->up : clients_[client]->down;
  const LossyModel::Fate fate = line.offer(bytes.size(), now);
  for (const MonoTime due : fate.deliveries()) {
    // Nothing to wait for, and nobody to wait behind: through at once.
    if (due <= now && heap_.empty()) {
      deliver(client, direction, bytes);
      continue;
    }
    if (free_.empty()) {
      ++overflow_[static_cast<std::size_t>(direction)];
      continue;
    }
    const std::size_t place = free_.back();
    free_.pop_back();
    Parcel& parcel = store_[place];
    parcel.due = due;
    parcel.order = order_++;
    parcel.client = client;
    parcel.direction = direction;
    parcel.size = bytes.size();
    std::memcpy(parcel.bytes.data(), bytes.data(), bytes.size());
    heap_.push_back(place);
    std::push_heap(heap_.begin(), heap_.end(),
                   [this](std::size_t a, std::size_t b) { return is_later(a, b); });
    if (heap_.front() == place) poller_.set_deadline(timer_, due);
  }
}

void LossyProxy::deliver(std::size_t client, Direction direction,
                         std::span<const std::uint8_t> bytes) {
  ++delivered_[static_cast<std::size_t>(direction)];
  if (direction == Direction::kUp)
    clients_[client]->upstream.send_now(target_, bytes);
  else
    listen_.send_now(clients_[client]->address, bytes);
}

MonoTime LossyProxy::deliver_due(MonoTime now) {
  while (!heap_.empty() && store_[heap_.front()].due <= now) {
    const std::size_t place = heap_.front();
    std::pop_heap(heap_.begin(), heap_.end(),
                  [this](std::size_t a, std::size_t b) { return is_later(a, b); });
    heap_.pop_back();
    const Parcel& parcel = store_[place];
    deliver(parcel.client, parcel.direction, {parcel.bytes.data(), parcel.size});
    free_.push_back(place);
  }
  return heap_.empty() ? MonoTime() : store_[heap_.front()].due;
}

LossyProxy::Totals LossyProxy::totals(Direction direction) const {
  Totals totals;
  for (const auto& client : clients_) {
    const LossyModel::Counters& c =
        (direction == Direction::kUp ? client->up : client->down).counters();
    totals.line.offered += c.offered;
    totals.line.forwarded += c.forwarded;
    totals.line.lost += c.lost;
    totals.line.queue_dropped += c.queue_dropped;
    totals.line.duplicated += c.duplicated;
    totals.line.reordered += c.reordered;
  }
  totals.delivered = delivered_[static_cast<std::size_t>(direction)];
  totals.overflow = overflow_[static_cast<std::size_t>(direction)];
  return totals;
}

}  // namespace dance
