// What a house asks for, and what it makes of what comes.
#include "tunnel/files/file_receiver.h"

#include <gtest/gtest.h>

#include <set>

#include "tests/tunnel/files/test_file.h"

namespace dance {
namespace {

// A receiver and an owner who answers after a while, and loses some.
struct Transfer {
  FileReceiver receiver{1e6};
  MonoTime now = MonoTime::from_us(1'000'000);
  std::map<GuestId, TestFile> files;
  std::set<GuestId> silent;
  double loss = 0.0;
  Random random{99};
  std::vector<std::pair<GuestId, std::vector<std::uint8_t>>> whole;
  std::vector<std::size_t> blocks;
  bool is_right = true;
  bool checks_bytes = false;  // instead
  std::size_t asked = 0;
  std::map<GuestId, std::size_t> asked_of;

  Transfer() {
    receiver.on_whole = [this](const GuestId& id, const FileHash& hash, ChunkedFile&& file) {
      std::vector<std::uint8_t> bytes;
      for (std::size_t i = 0; i < file.blocks(); ++i)
        bytes.insert(bytes.end(), file.block(i).begin(), file.block(i).end());
      whole.emplace_back(id, std::move(bytes));
      const bool right = checks_bytes ? whole.back().second == files.at(id).bytes : is_right;
      receiver.settle(id, hash, right ? FileVerdict::kRight : FileVerdict::kWrong);
    };
    receiver.on_block = [this](const GuestId&, const FileHash&, const ChunkedFile&,
                               std::size_t block) { blocks.push_back(block); };
  }
  void want(const char* who, const TestFile& file) {
    files.insert_or_assign(guest(who), file);
    receiver.want(guest(who), file.hash, ChunkedFile(file.size()), now);
  }
  std::optional<wire::Slot> slot_of(const GuestId& id) const {
    std::uint8_t slot = 0;
    for (const auto& [known, file] : files) {
      if (known == id) return wire::Slot{slot, 1};
      ++slot;
    }
    return std::nullopt;
  }
  void run(Duration duration) {
    struct Parcel {
      MonoTime due;
      GuestId from;
      wire::FileName name;
      std::uint16_t index;
    };
    static std::vector<Parcel> parcels;
    parcels.clear();
    for (const MonoTime end = now + duration; now < end; now += Duration::ms(1)) {
      if (const auto want = receiver.next([this](const GuestId& id) { return slot_of(id); }, now)) {
        const auto owner = std::next(files.begin(), want->file.slot.slot)->first;
        for (std::size_t i = 0; i < wire::kMaxFileChunks; ++i) {
          if (!want->has(i)) continue;
          ++asked;
          ++asked_of[owner];
          if (silent.contains(owner) || random.uniform() < loss) continue;
          parcels.push_back(
              {now + Duration::ms(50), owner, want->file, static_cast<std::uint16_t>(i)});
        }
      }
      std::erase_if(parcels, [&](const Parcel& it) {
        if (it.due > now) return false;
        const TestFile& file = files.at(it.from);
        if (file.hash == it.name.hash)
          receiver.take(it.from, {it.name, file.size(), it.index, file.chunk(it.index)}, now);
        return true;
      });
    }
  }
};

TEST(FileReceiver, PutsAFileTogether) {
  Transfer transfer;
  const TestFile file = test_file(200'123);
  transfer.want("alice", file);
  transfer.run(Duration::s(3));
  ASSERT_EQ(transfer.whole.size(), 1u);
  EXPECT_EQ(transfer.whole[0].second, file.bytes);
  EXPECT_EQ(transfer.asked, wire::chunks_of(file.size())) << "nothing was asked for twice";
  EXPECT_EQ(transfer.blocks, (std::vector<std::size_t>{0, 1, 2, 3}));
  EXPECT_FALSE(transfer.receiver.wants(guest("alice"), file.hash));
}

TEST(FileReceiver, AsksAgainForWhatIsLost) {
  for (const double loss : {0.1, 0.2, 0.5}) {
    Transfer transfer;
    transfer.loss = loss;
    const TestFile file = test_file(100'000);
    transfer.want("alice", file);
    transfer.run(Duration::s(120));
    ASSERT_EQ(transfer.whole.size(), 1u) << loss;
    EXPECT_EQ(transfer.whole[0].second, file.bytes);
    EXPECT_GT(transfer.receiver.counters().chunks_again, 0u);
    EXPECT_EQ(transfer.receiver.counters().chunks_taken, wire::chunks_of(file.size()));
  }
}

TEST(FileReceiver, NeverHasMoreUnderWayThanItsWindow) {
  Transfer transfer;
  transfer.silent.insert(guest("alice"));
  transfer.want("alice", test_file(1'000'000));
  transfer.run(Duration::ms(900));
  EXPECT_LE(transfer.asked, ChunkRequests::kMost);
}

TEST(FileReceiver, LetsOthersHaveTheirTurnWhileAHouseIsSilent) {
  Transfer transfer;
  transfer.silent.insert(guest("alice"));
  transfer.want("alice", test_file(500'000, 3));
  const TestFile file = test_file(100'000, 5);
  transfer.want("bob", file);
  transfer.run(Duration::s(20));
  ASSERT_EQ(transfer.whole.size(), 1u);
  EXPECT_EQ(transfer.whole[0].first, guest("bob"));
  EXPECT_EQ(transfer.whole[0].second, file.bytes);
  transfer.silent.clear();
  transfer.run(Duration::s(20));
  EXPECT_EQ(transfer.whole.size(), 2u) << "and comes back to the first";
}

TEST(FileReceiver, TakesUpWhatHadComeBefore) {
  Transfer transfer;
  const TestFile file = test_file(300'000);
  ChunkedFile begun(file.size());
  for (std::size_t i = 0; i < 128; ++i) begun.put(i, file.chunk(i));
  transfer.files.insert_or_assign(guest("alice"), file);
  transfer.receiver.want(guest("alice"), file.hash, std::move(begun), transfer.now);
  transfer.run(Duration::s(3));
  ASSERT_EQ(transfer.whole.size(), 1u);
  EXPECT_EQ(transfer.whole[0].second, file.bytes);
  EXPECT_EQ(transfer.asked, wire::chunks_of(file.size()) - 128);
  EXPECT_EQ(transfer.blocks.front(), 2u);
}

TEST(FileReceiver, FetchesAFileFromNothingWhereWhatWasBroughtAlongWasWrong) {
  Transfer transfer;
  transfer.checks_bytes = true;
  const TestFile file = test_file(300'000), garbage = test_file(300'000, 9);
  ChunkedFile begun(file.size());
  for (std::size_t i = 0; i < 64; ++i) begun.put(i, garbage.chunk(i));
  transfer.files.insert_or_assign(guest("alice"), file);
  transfer.receiver.want(guest("alice"), file.hash, std::move(begun), transfer.now);
  transfer.run(Duration::s(5));
  ASSERT_EQ(transfer.whole.size(), 2u);
  EXPECT_NE(transfer.whole[0].second, file.bytes);
  EXPECT_EQ(transfer.whole[1].second, file.bytes);
  EXPECT_EQ(transfer.receiver.counters().files_anew, 1u);
  EXPECT_EQ(transfer.receiver.counters().files_wrong, 0u);
  EXPECT_EQ(transfer.asked, 2 * wire::chunks_of(file.size()) - 64);
}

TEST(FileReceiver, FetchesFromNothingOnlyOnce) {
  Transfer transfer;
  transfer.is_right = false;
  const TestFile file = test_file(100'000);
  ChunkedFile begun(file.size());
  for (std::size_t i = 0; i < 64; ++i) begun.put(i, file.chunk(i));
  transfer.files.insert_or_assign(guest("alice"), file);
  transfer.receiver.want(guest("alice"), file.hash, std::move(begun), transfer.now);
  transfer.run(Duration::s(5));
  EXPECT_EQ(transfer.whole.size(), 2u);
  EXPECT_EQ(transfer.receiver.counters().files_wrong, 1u);
  EXPECT_FALSE(transfer.receiver.wants(guest("alice"), file.hash));
}

TEST(FileReceiver, HoldsNothingAgainstAFileThatTheDiskDidNotTake) {
  Transfer transfer;
  const TestFile file = test_file(50'000);
  transfer.receiver.on_whole = [&](const GuestId& id, const FileHash& hash, ChunkedFile&&) {
    ++transfer.asked_of[guest("whole")];
    transfer.receiver.settle(id, hash, FileVerdict::kNotKept);
  };
  for (std::size_t i = 1; i <= 2; ++i) {
    transfer.want("alice", file);
    transfer.run(Duration::s(2));
    EXPECT_EQ(transfer.asked_of[guest("whole")], i);
    EXPECT_FALSE(transfer.receiver.wants(guest("alice"), file.hash));
  }
  EXPECT_EQ(transfer.receiver.counters().files_wrong, 0u);
}

TEST(FileReceiver, TakesAFileOfAnotherSizeThanSaidForWrong) {
  Transfer transfer;
  const TestFile file = test_file(50'000);
  transfer.files.insert_or_assign(guest("alice"), file);
  transfer.receiver.want(guest("alice"), file.hash, ChunkedFile(60'000), transfer.now);
  transfer.run(Duration::s(1));
  EXPECT_EQ(transfer.receiver.counters().files_wrong, 1u);
  EXPECT_FALSE(transfer.receiver.wants(guest("alice"), file.hash));
  const std::size_t asked = transfer.asked;
  transfer.receiver.want(guest("alice"), file.hash, ChunkedFile(60'000), transfer.now);
  transfer.run(Duration::s(5));
  EXPECT_EQ(transfer.asked, asked);
}

TEST(FileReceiver, StoresNothingThatItHasNotAskedFor) {
  Transfer transfer;
  const TestFile file = test_file(1'000'000);
  transfer.silent.insert(guest("alice"));
  transfer.want("alice", file);
  const wire::FileName name{{0, 1}, file.hash};
  const auto give = [&](std::uint16_t index) {
    return transfer.receiver.take(guest("alice"), {name, file.size(), index, file.chunk(index)},
                                  transfer.now);
  };
  for (std::uint16_t i = 0; i < 100; ++i) EXPECT_FALSE(give(i));
  EXPECT_EQ(transfer.receiver.counters().chunks_foreign, 100u);
  transfer.run(Duration::ms(100));
  EXPECT_TRUE(give(0));
  EXPECT_FALSE(give(900)) << "beyond the window";
  transfer.run(Duration::s(5));
  EXPECT_GT(transfer.receiver.counters().chunks_again, 0u);
  EXPECT_TRUE(give(1)) << "late, and given up meanwhile";
  EXPECT_EQ(transfer.receiver.counters().chunks_taken, 2u);
}

TEST(FileReceiver, BoundsWhatIsBroughtAlong) {
  Transfer transfer;
  const TestFile file = test_file(10'000'000);
  for (int i = 0; i < 10; ++i) {
    ChunkedFile begun(file.size());
    for (std::size_t at = 0; at < begun.chunks(); at += 2) begun.put(at, file.chunk(at));
    const GuestId who = guest("guest-" + std::to_string(i));
    transfer.files.insert_or_assign(who, file);
    transfer.silent.insert(who);
    transfer.receiver.want(who, file.hash, std::move(begun), transfer.now);
    EXPECT_LE(transfer.receiver.held_bytes(), FileReceiver::kMostBytes);
    EXPECT_TRUE(transfer.receiver.wants(who, file.hash));
  }
  EXPECT_GT(transfer.receiver.held_bytes(), FileReceiver::kMostBytes - 2 * file.size());
  // A turn of each; each turn's file has room to become whole.
  for (int i = 0; i < 60; ++i) {
    transfer.run(Duration::s(1));
    EXPECT_LE(transfer.receiver.held_bytes(), FileReceiver::kMostBytes);
  }
}

TEST(FileReceiver, DoesNotAskAgainForAWrongFile) {
  Transfer transfer;
  transfer.is_right = false;
  const TestFile file = test_file(50'000);
  transfer.want("alice", file);
  transfer.run(Duration::s(2));
  EXPECT_EQ(transfer.receiver.counters().files_wrong, 1u);
  const std::size_t asked = transfer.asked;
  transfer.want("alice", file);
  transfer.run(Duration::s(5));
  EXPECT_EQ(transfer.asked, asked);
  EXPECT_FALSE(transfer.receiver.wants(guest("alice"), file.hash));
  // Of another guest it may be right.
  transfer.is_right = true;
  transfer.want("bob", file);
  transfer.run(Duration::s(2));
  EXPECT_EQ(transfer.whole.back().first, guest("bob"));
}

TEST(FileReceiver, FetchesNoMoreOfAGuestThanTheLimit) {
  Transfer transfer;
  // One file after the other, as fast as they come: 1 MB/s for two minutes.
  const Duration turn = Duration::s(5);
  for (std::uint8_t i = 0; i < 24; ++i) {
    transfer.want("mallory", test_file(4'000'000, static_cast<std::uint8_t>(2 * i + 1)));
    transfer.run(turn);
  }
  const double bytes = static_cast<double>(transfer.asked_of[guest("mallory")]) * 1024.0;
  const double minutes = turn.as_seconds() * 24.0 / 60.0;
  EXPECT_LE(bytes, FileReceiver::kBytesPerGuest * (1.0 + minutes));
  EXPECT_GT(bytes, FileReceiver::kBytesPerGuest * 0.9) << "the limit was reached";
  // Others are not held back by it.
  const TestFile file = test_file(100'000, 201);
  transfer.want("alice", file);
  transfer.run(Duration::s(3));
  ASSERT_FALSE(transfer.whole.empty());
  EXPECT_EQ(transfer.whole.back().second, file.bytes);
}

TEST(FileReceiver, CountsWhatItHasNotAskedFor) {
  Transfer transfer;
  const TestFile file = test_file(50'000), other = test_file(50'000, 9);
  transfer.want("alice", file);
  const wire::FileName name{{0, 1}, file.hash}, foreign{{0, 1}, other.hash};
  auto& receiver = transfer.receiver;
  EXPECT_FALSE(receiver.take(guest("bob"), {name, file.size(), 0, file.chunk(0)}, transfer.now));
  EXPECT_FALSE(
      receiver.take(guest("alice"), {foreign, other.size(), 0, other.chunk(0)}, transfer.now));
  const TestFile longer = test_file(60'000);
  EXPECT_FALSE(
      receiver.take(guest("alice"), {name, longer.size(), 0, longer.chunk(0)}, transfer.now));
  EXPECT_EQ(receiver.counters().chunks_foreign, 3u);
}

TEST(FileReceiver, RestsAfterARefusal) {
  Transfer transfer;
  const TestFile file = test_file(50'000);
  transfer.silent.insert(guest("alice"));
  transfer.want("alice", file);
  transfer.run(Duration::ms(100));
  const std::size_t asked = transfer.asked;
  EXPECT_GT(asked, 0u);
  EXPECT_TRUE(transfer.receiver.refuse(
      guest("alice"), {{{0, 1}, file.hash}, wire::FileRefusalCause::kFull}, transfer.now));
  transfer.run(Duration::s(15));
  EXPECT_EQ(transfer.asked, asked);
  transfer.silent.clear();
  transfer.run(Duration::s(10));
  EXPECT_EQ(transfer.whole.size(), 1u);
}

TEST(FileReceiver, HasADeadlineWheneverThereIsSomethingToDo) {
  FileReceiver receiver(1e5);
  EXPECT_FALSE(receiver.next_deadline().is_set());
  const TestFile file = test_file(50'000);
  MonoTime now = MonoTime::from_us(1'000'000);
  receiver.want(guest("alice"), file.hash, ChunkedFile(file.size()), now);
  const auto slot_of = [](const GuestId&) { return wire::Slot{3, 1}; };
  std::size_t turns = 0, asked = 0;
  // Driven by its deadlines alone.
  for (const MonoTime end = now + Duration::s(10); now < end; ++turns) {
    const MonoTime next = receiver.next_deadline();
    if (!next.is_set()) break;
    now = std::max(now, next);
    if (const auto want = receiver.next(slot_of, now))
      for (std::size_t i = 0; i < 49; ++i)
        if (want->has(i)) {
          ++asked;
          receiver.take(guest("alice"),
                        {want->file, file.size(), static_cast<std::uint16_t>(i), file.chunk(i)},
                        now);
        }
  }
  EXPECT_EQ(asked, 49u);
  EXPECT_LT(turns, 100u) << "it does not spin";
}

}  // namespace
}  // namespace dance
