#include "formats/mcap/mcap_by_time.h"

#include <fcntl.h>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <string>
#include <tuple>

namespace dance {
namespace {

constexpr const char* kSortCure = "sort it by log time first, with mcap sort";

bool is_in_order(McapReader& reader, McapRank rank) {
  std::uint64_t newest_ns = 0;
  while (const auto message = reader.next()) {
    if (!rank(*message)) continue;
    if (message->log_ns < newest_ns) return false;
    newest_ns = message->log_ns;
  }
  return true;
}

// Messages on a disk, and in memory what orders them.
class SortedMessages {
 public:
  Result<void> add(const McapMessage& message, std::uint8_t rank) {
    if (!file_) file_.reset(std::tmpfile());
    // A program that this one starts would keep the disk's space.
    if (file_) fcntl(fileno(file_.get()), F_SETFD, FD_CLOEXEC);
    if (!file_) return fail(std::string("no temporary file to sort it in; ") + kSortCure);
    if (entries_.size() >= kMostSorted_messages || bytes_ + message.data.size() > kMostSorted_bytes)
      return fail(std::string("too much of it is not in the order of its times; ") + kSortCure);
    const std::size_t channel = channel_of(message);
    Channel& of = channels_[channel];
    // Counts the messages of a channel that have the same time.
    of.repeats = of.has_any && of.last_ns == message.log_ns ? of.repeats + 1 : 0;
    of.has_any = true;
    of.last_ns = message.log_ns;
    entries_.push_back({message.log_ns, of.repeats, rank, static_cast<std::uint16_t>(channel),
                        message.sequence, message.publish_ns, bytes_,
                        static_cast<std::uint32_t>(message.data.size())});
    if (std::fwrite(message.data.data(), 1, message.data.size(), file_.get()) !=
        message.data.size())
      return no_room();
    bytes_ += message.data.size();
    return {};
  }

  Result<void> pass_on(const std::function<void(const McapMessage&)>& take) {
    if (entries_.empty()) return {};
    if (std::fflush(file_.get()) != 0) return no_room();
    std::stable_sort(entries_.begin(), entries_.end(), [](const Entry& a, const Entry& b) {
      return std::tie(a.log_ns, a.repeat, a.rank) < std::tie(b.log_ns, b.repeat, b.rank);
    });
    std::string data;
    for (const Entry& entry : entries_) {
      data.resize(entry.size);
      if (fseeko(file_.get(), static_cast<off_t>(entry.at), SEEK_SET) != 0 ||
          std::fread(data.data(), 1, data.size(), file_.get()) != data.size())
        return fail("the temporary file that it is sorted in cannot be read");
      const Channel& channel = channels_[entry.channel];
      take({channel.schema, channel.topic, channel.encoding, entry.sequence, entry.log_ns,
            entry.publish_ns, data});
    }
    return {};
  }

 private:
  struct Channel {
    std::string schema, topic, encoding;
    bool has_any = false;
    std::uint64_t last_ns = 0;
    std::uint32_t repeats = 0;
  };
  struct Entry {
    std::uint64_t log_ns;
    std::uint32_t repeat;
    std::uint8_t rank;
    std::uint16_t channel;
    std::uint32_t sequence;
    std::uint64_t publish_ns;
    std::uint64_t at;
    std::uint32_t size;
  };
  struct CloseFile {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };

  static tl::unexpected<Error> no_room() {
    return fail(std::string("no room in the temporary folder to sort it; free some, or ") +
                kSortCure);
  }

  std::size_t channel_of(const McapMessage& message) {
    const auto found = std::find_if(channels_.begin(), channels_.end(), [&](const Channel& each) {
      return each.topic == message.topic && each.schema == message.schema &&
             each.encoding == message.encoding;
    });
    if (found != channels_.end()) return static_cast<std::size_t>(found - channels_.begin());
    channels_.push_back(
        {std::string(message.schema), std::string(message.topic), std::string(message.encoding)});
    return channels_.size() - 1;
  }

  std::unique_ptr<std::FILE, CloseFile> file_;
  std::uint64_t bytes_ = 0;
  std::vector<Channel> channels_;  // the reader bounds them
  std::vector<Entry> entries_;
};

}  // namespace

Result<bool> read_by_time(McapReader& reader, McapRank rank,
                          const std::function<void(const McapMessage&)>& take) {
  const bool in_order = !reader.can_rewind() || is_in_order(reader, rank);
  if (reader.can_rewind())
    if (auto begun = reader.rewind(); !begun) return tl::make_unexpected(begun.error());
  SortedMessages sorted;
  while (const auto message = reader.next()) {
    const auto its_rank = rank(*message);
    if (!its_rank) continue;
    if (in_order)
      take(*message);
    else if (auto added = sorted.add(*message, *its_rank); !added)
      return tl::make_unexpected(added.error());
  }
  if (auto passed = sorted.pass_on(take); !passed) return tl::make_unexpected(passed.error());
  return !in_order;
}

}  // namespace dance
