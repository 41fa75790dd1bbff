// ClusterSender: what one server says to the others. Messages of one subject that follow one
// another go as one bundle.
//
// Units/frames: subjects and messages as in cluster_names.h and cluster_format.h; bytes of
//               messages, without NATS's own.
// Ownership:    refers to the bus, which must outlive it; never allocates.
// Threads:      none inside; one owner.
// Failure:      what the bus cannot send is lost and counted there. What has not been flushed is
//               not sent.
#pragma once

#include "tunnel/cluster/cluster_bundle.h"
#include "tunnel/cluster/cluster_bus.h"
#include "tunnel/cluster/cluster_names.h"

namespace dance::cluster {

class ClusterSender {
 public:
  explicit ClusterSender(ClusterBus& bus) : bus_(bus) {}

  void send(const Text& subject, const Message& message);
  void flush();
  std::uint64_t messages() const { return messages_; }  // a bundle is one
  std::uint64_t bytes() const { return bytes_; }

 private:
  ClusterBus& bus_;
  Text subject_;  // of what has gathered
  BundleWriter bundle_;
  std::uint64_t messages_ = 0, bytes_ = 0;
};

}  // namespace dance::cluster
