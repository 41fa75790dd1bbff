#include "tunnel/cluster/cluster_sender.h"

#include "core/base/assert.h"

namespace dance::cluster {

void ClusterSender::send(const Text& subject, const Message& message) {
  if (subject == subject_ && bundle_.try_add(message)) return;
  flush();
  subject_ = subject;
  const bool added = bundle_.try_add(message);
  DANCE_ASSERT(added);
}

void ClusterSender::flush() {
  if (bundle_.is_empty()) return;
  ++messages_;
  bytes_ += bundle_.bytes().size();
  bus_.publish(subject_.view(), bundle_.bytes());
  bundle_.clear();
}

}  // namespace dance::cluster
