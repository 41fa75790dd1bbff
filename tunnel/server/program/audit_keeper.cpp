#include "tunnel/server/program/audit_keeper.h"

#include <pthread.h>

#include <utility>

#include "core/base/take_line.h"
#include "core/net/mono_clock.h"
#include "core/program/talk.h"
#include "tunnel/seal/keys/key_files.h"
#include "tunnel/seal/keys/utc_text.h"

namespace dance {
namespace {

std::string text_of(const AuditLog::Lines& lines) {
  std::string text;
  for (const auto& line : lines) (text += *line) += '\n';
  return text;
}

}  // namespace

std::string audit_socket_name(std::uint16_t port) {
  return "server-" + std::to_string(port) + "-log.sock";
}

std::string audit_file(const std::string& key_file, std::uint16_t port) {
  const auto slash = key_file.rfind('/');
  return (slash == std::string::npos ? "" : key_file.substr(0, slash + 1)) + "server-" +
         std::to_string(port) + "-log.jsonl";
}

AuditKeeper::AuditKeeper(std::string path, std::uint16_t port, Poller& poller)
    : path_(std::move(path)), poller_(poller) {
  read();
  written_changes_ = log_.changes();
  auto socket = LocalTextServer::open(
      local_socket_folder() + "/" + audit_socket_name(port),
      // Never empty: an empty answer means a busy server.
      [this](MonoTime) { return text_of(log_.lines()) + "\n"; }, poller_);
  if (socket)
    socket_ = std::move(*socket);
  else
    talk::warn("`dance status --log` cannot reach this server: {}", socket.error().what);
  timer_ = poller_.add_timer(mono_now() + kWriteEvery, [this](MonoTime now) {
    hand_over_to_writer();
    return now + kWriteEvery;
  });
  writer_ = std::thread([this] { write_files(); });
}

AuditKeeper::~AuditKeeper() {
  poller_.remove_timer(timer_);
  hand_over_to_writer();
  {
    const std::lock_guard lock(mutex_);
    ends_ = true;
  }
  wakes_.notify_one();
  writer_.join();
}

void AuditKeeper::add(const Address& from, const AuditEvent& event) {
  log_.add(from, event, utc_now_s());
}

void AuditKeeper::read() {
  const auto text = read_secret(path_);
  if (!text) {
    talk::warn("{}; the audit log is kept in memory only", text.error().what);
    return path_.clear();
  }
  std::size_t unknown = 0;
  std::string_view rest = *text ? std::string_view(**text) : std::string_view();
  while (!rest.empty()) {
    const std::string_view line = take_line(rest);
    if (const auto entry = parse_audit_line(line))
      log_.restore(*entry);
    else
      unknown += line.empty() ? 0 : 1;
  }
  if (unknown > 0) talk::warn("{}: {} lines are no entries of an audit log", path_, unknown);
}

void AuditKeeper::hand_over_to_writer() {
  if (path_.empty() || written_changes_ == log_.changes()) return;
  written_changes_ = log_.changes();
  {
    const std::lock_guard lock(mutex_);
    to_write_ = std::make_unique<const AuditLog::Lines>(log_.lines());
  }
  wakes_.notify_one();
}

void AuditKeeper::write_files() {
  pthread_setname_np(pthread_self(), "audit-log");
  bool was_written = true;
  std::unique_lock lock(mutex_);
  for (;;) {
    wakes_.wait(lock, [this] { return ends_ || to_write_; });
    const auto lines = std::move(to_write_);
    if (!lines) return;
    lock.unlock();
    const auto written = write_secret(path_, text_of(*lines));
    if (!written && was_written) talk::warn("audit log: {}", written.error().what);
    was_written = written.has_value();
    lock.lock();
  }
}

}  // namespace dance
