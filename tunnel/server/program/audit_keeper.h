// Keeps the server's audit log: in memory, in a file that only the server's user can read, and on a
// socket for `dance status --log`.
//
// Threads:   the poller's. The file is written by a thread of its own, because poses do not wait
//            for a disk.
// Ownership: the poller must outlive it.
// Failure:   a file or socket that cannot be used is reported once, and the log goes on without it.
//            A crash loses at most the last kWriteEvery of the file.
#pragma once

#include <condition_variable>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "core/net/local_socket.h"
#include "core/net/poller.h"
#include "tunnel/server/program/audit_log.h"

namespace dance {

// File name of the log's socket in local_socket_folder().
std::string audit_socket_name(std::uint16_t port);
// The log's file lies beside the server's file of keys: that folder is private already.
std::string audit_file(const std::string& key_file, std::uint16_t port);

class AuditKeeper {
 public:
  static constexpr Duration kWriteEvery = Duration::s(10);

  // Continues the log in `path`.
  AuditKeeper(std::string path, std::uint16_t port, Poller& poller);
  // Writes what is not on disk yet.
  ~AuditKeeper();
  AuditKeeper(const AuditKeeper&) = delete;
  AuditKeeper& operator=(const AuditKeeper&) = delete;

  void add(const Address& from, const AuditEvent& event);

 private:
  void read();
  void hand_over_to_writer();
  void write_files();

  std::string path_;  // "" = memory only
  Poller& poller_;
  AuditLog log_;
  std::uint64_t written_changes_ = 0;
  std::unique_ptr<LocalTextServer> socket_;
  Poller::TimerId timer_;
  std::mutex mutex_;
  std::condition_variable wakes_;
  std::unique_ptr<const AuditLog::Lines> to_write_;  // guarded
  bool ends_ = false;                                // guarded
  std::thread writer_;
};

}  // namespace dance
