// Where the NATS servers of a cluster are, and how they know us.
//
// Ownership: plain values.
// Threads:   none inside.
// Failure:   none.
#pragma once

#include <string>
#include <vector>

namespace dance {

// What lasts of rooms and guests, and the keys of all servers.
constexpr const char* kClusterBucket = "dance-1";
constexpr const char* kKeysBucket = "dance-keys-1";

struct NatsOptions {
  std::vector<std::string> urls;  // nats://host:port, or tls://host:port
  std::string name = "dance";     // of this client, in what NATS shows
  std::string credentials;        // file of a user's JWT and seed; "" = none
  std::string authorities;        // PEM file of those whose signature a server's certificate bears
  std::string certificate;        // PEM files of our own certificate, for servers that ask for one,
  std::string private_key;        // and of its key
  std::string bucket = kClusterBucket;  // of values
  // What is not written again for so long goes, also what says that a key was erased; 0 = never.
  int lasts_s = 0;
  int replicas = 0;          // of each value; 0 = 3 where three servers are named, else 1
  bool only_values = false;  // no messages: their connection is not made
};

constexpr const char* kTlsIsWanted =
    "tls:// in --cluster, --cluster-authorities or --cluster-certificate asks for it";

// "nats://a:4222,nats://b:4222" → its parts; a part without a scheme gets one.
std::vector<std::string> nats_urls(const std::string& list);
// Whether each connection must be in TLS, whatever a server says before it has shown who it is: a
// URL says so, or an authority or a certificate of ours is given.
bool wants_tls(const NatsOptions& options);
// The URLs as they may be shown: without user and password, printable.
std::string shown_urls(const NatsOptions& options);
// Of a server that does not let us in: which option says who we are, and what may be wrong with it.
std::string cure_of_nats_refusal(const NatsOptions& options);

}  // namespace dance
