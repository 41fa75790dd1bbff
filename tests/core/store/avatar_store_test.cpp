// The store of avatars: by hash, whole or not at all, bounded, for this user alone.
#include "core/store/avatar_store.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "core/store/sha256.h"

namespace dance {
namespace {

namespace fs = std::filesystem;
using Bytes = std::vector<std::uint8_t>;

const GuestId kAlice = *GuestId::parse("alice"), kMallory = *GuestId::parse("mallory");

Bytes some_bytes(std::size_t size, std::uint8_t seed) {
  Bytes bytes(size);
  for (std::size_t i = 0; i < size; ++i) bytes[i] = static_cast<std::uint8_t>(i * 7 + seed);
  return bytes;
}

class Store : public ::testing::Test {
 protected:
  Store() {
    std::string pattern = (fs::temp_directory_path() / "avatar-store-XXXXXX").string();
    if (mkdtemp(pattern.data()) == nullptr) std::abort();
    root = pattern;
  }
  ~Store() override {
    std::error_code error;
    fs::remove_all(root, error);
  }
  AvatarStore store(std::size_t most = AvatarStore::kMostForeignBytes) const {
    return AvatarStore((root / "data/avatars").string(), (root / "cache/avatars").string(), most);
  }
  // Used so many seconds ago.
  static void age(const std::string& path, std::time_t seconds) {
    const timespec at{time(nullptr) - seconds, 0};
    const timespec times[2] = {at, at};
    ASSERT_EQ(utimensat(AT_FDCWD, path.c_str(), times, 0), 0);
  }
  static mode_t mode_of(const fs::path& path) {
    struct stat status {};
    return stat(path.c_str(), &status) == 0 ? status.st_mode & 0777u : 0u;
  }

  fs::path root;
};

TEST(Sha256, IsThatOfTheStandard) {
  const std::string_view abc = "abc";
  const auto hash = sha256_of({reinterpret_cast<const std::uint8_t*>(abc.data()), abc.size()});
  EXPECT_EQ(hex_of(hash), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(parse_file_hash(hex_of(hash)), hash);
  for (const char* text : {"", "ba78",
                           "BA7816BF8F01CFEA414140DE5DAE2223B00361A396177A9CB410FF61F2"
                           "0015AD"})
    EXPECT_FALSE(parse_file_hash(text)) << text;
}

TEST_F(Store, KeepsOwnFilesForThisUserAlone) {
  const Bytes bytes = some_bytes(5000, 1);
  const fs::path file = root / "me.vrm";
  std::ofstream(file, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(5000));
  const auto kept = AvatarStore::read_file(file.string());
  ASSERT_TRUE(kept) << kept.error().what;
  EXPECT_EQ(kept->hash, sha256_of(bytes));
  ASSERT_TRUE(store().keep_own(*kept, true));
  const std::string path = store().find(kept->hash);
  EXPECT_EQ(path, (root / "data/avatars" / (hex_of(kept->hash) + ".vrm")).string());
  EXPECT_EQ(mode_of(path), 0600u);
  EXPECT_EQ(mode_of(root / "data/avatars"), 0700u);
  EXPECT_EQ(store().read(kept->hash), bytes);
  ASSERT_EQ(store().list().size(), 1u);
  EXPECT_TRUE(store().list()[0].is_own);
}

TEST_F(Store, RefusesWhatCannotTravel) {
  EXPECT_FALSE(AvatarStore::read_file((root / "nothing.vrm").string()));
  EXPECT_FALSE(AvatarStore::read_file(root.string()));
  EXPECT_FALSE(AvatarStore::read_file("/dev/zero"));
  const fs::path large = root / "large.vrm";
  std::ofstream(large).put('x');
  fs::resize_file(large, AvatarStore::kMostFileBytes + 1);
  const auto refused = AvatarStore::read_file(large.string());
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().what.find("at most 16"), std::string::npos) << refused.error().what;
  fs::resize_file(large, AvatarStore::kMostFileBytes);
  EXPECT_TRUE(AvatarStore::read_file(large.string()));
}

TEST_F(Store, KeepsAForeignFileOnlyWithItsHash) {
  const Bytes bytes = some_bytes(3000, 2);
  const AvatarStore::Pieces pieces{std::span(bytes).first(1000), std::span(bytes).subspan(1000)};
  const auto kept = store().keep_foreign(sha256_of(bytes), pieces, false);
  ASSERT_TRUE(kept) << kept.error().what;
  EXPECT_TRUE(*kept);
  EXPECT_EQ(store().read(sha256_of(bytes)), bytes);
  EXPECT_EQ(mode_of(root / "cache/avatars"), 0700u);
  FileHash other;
  other.bytes[0] = 9;
  const auto wrong = store().keep_foreign(other, pieces, false);
  ASSERT_TRUE(wrong);
  EXPECT_FALSE(*wrong);
  EXPECT_EQ(store().find(other), "");
  EXPECT_EQ(store().list().size(), 1u) << "and nothing half written stays";
}

TEST_F(Store, MakesRoomByWhatIsLongestUnused) {
  const AvatarStore bounded = store(10'000);
  std::vector<FileHash> hashes;
  for (std::uint8_t i = 0; i < 3; ++i) {
    const Bytes bytes = some_bytes(3000, i);
    hashes.push_back(sha256_of(bytes));
    ASSERT_TRUE(bounded.keep_foreign(hashes.back(), {bytes}, false));
    age(bounded.find(hashes.back()), 1000 - 100 * i);
  }
  EXPECT_NE(bounded.find(hashes[0]), "");  // used now
  const Bytes own = some_bytes(9000, 40);
  ASSERT_TRUE(bounded.keep_own({sha256_of(own), own}, false));
  const Bytes more = some_bytes(3000, 7);
  ASSERT_TRUE(bounded.keep_foreign(sha256_of(more), {more}, false));
  EXPECT_NE(bounded.find(hashes[0]), "");
  EXPECT_EQ(bounded.find(hashes[1]), "");
  EXPECT_NE(bounded.find(hashes[2]), "");
  EXPECT_NE(bounded.find(sha256_of(more)), "");
  EXPECT_NE(bounded.find(sha256_of(own)), "") << "own ones stay and do not count";
}

TEST_F(Store, RemovesAForeignFileThatIsDamaged) {
  const Bytes bytes = some_bytes(3000, 2);
  ASSERT_TRUE(store().keep_foreign(sha256_of(bytes), {bytes}, false));
  const std::string path = store().find(sha256_of(bytes));
  std::fstream(path, std::ios::in | std::ios::out | std::ios::binary).put('!');
  EXPECT_FALSE(store().read(sha256_of(bytes)));
  EXPECT_EQ(store().find(sha256_of(bytes)), "");
}

TEST_F(Store, LeavesAnOwnFileThatIsDamagedUntilItIsKeptAgain) {
  const Bytes bytes = some_bytes(3000, 2);
  const FileHash hash = sha256_of(bytes);
  ASSERT_TRUE(store().keep_own({hash, bytes}, true));
  const std::string path = store().find(hash);
  std::fstream(path, std::ios::in | std::ios::out | std::ios::binary).put('!');
  EXPECT_FALSE(store().read(hash));
  EXPECT_TRUE(fs::exists(path)) << "it is the user's";
  ASSERT_TRUE(store().keep_foreign(hash, {bytes}, true));
  EXPECT_EQ(store().read(hash), bytes) << "another's copy serves meanwhile";
  ASSERT_TRUE(store().keep_own({hash, bytes}, false));
  fs::remove_all(root / "cache");
  EXPECT_EQ(store().find(hash), path);
  EXPECT_EQ(store().read(hash), bytes);
}

TEST_F(Store, LeavesWhatCannotBeReadWhole) {
  const Bytes bytes = some_bytes(3000, 2);
  ASSERT_TRUE(store().keep_foreign(sha256_of(bytes), {bytes}, false));
  const std::string path = store().find(sha256_of(bytes));
  fs::resize_file(path, AvatarStore::kMostFileBytes + 1);  // more than is read
  EXPECT_FALSE(store().read(sha256_of(bytes)));
  EXPECT_TRUE(fs::exists(path));
}

TEST_F(Store, FollowsNoLinkInTheFoldersOfTheStore) {
  const Bytes bytes = some_bytes(3000, 2);
  const FileHash hash = sha256_of(bytes);
  fs::create_directories(root / "cache/avatars");
  std::ofstream(root / "victim").put('v');
  fs::create_symlink(root / "victim", root / "cache/avatars" / (hex_of(hash) + ".vrm"));
  fs::create_symlink(root / "victim", root / "cache/avatars" / (hex_of(hash) + ".alice.part"));
  EXPECT_EQ(store().find(hash), "");
  EXPECT_FALSE(store().read(hash));
  EXPECT_FALSE(store().add_part(kAlice, hash, 0, bytes));
  EXPECT_TRUE(store().part(kAlice, hash).empty());
  EXPECT_TRUE(store().list().empty());
  EXPECT_EQ(fs::file_size(root / "victim"), 1u);
}

TEST_F(Store, TakesUpAPartAfterARestart) {
  const Bytes bytes = some_bytes(3000, 2);
  const FileHash hash = sha256_of(bytes);
  EXPECT_TRUE(store().part(kAlice, hash).empty());
  ASSERT_TRUE(store().add_part(kAlice, hash, 0, std::span(bytes).first(1000)));
  ASSERT_TRUE(
      store().add_part(kAlice, hash, 2000, std::span(bytes).subspan(2000)));  // a gap: left out
  EXPECT_EQ(store().part(kAlice, hash).size(), 1000u);
  ASSERT_TRUE(store().add_part(kAlice, hash, 1000, std::span(bytes).subspan(1000, 1000)));
  EXPECT_EQ(store().part(kAlice, hash), Bytes(bytes.begin(), bytes.begin() + 2000));
  EXPECT_TRUE(store().list().empty()) << "it is no avatar yet";
  store().forget_part(kAlice, hash);
  EXPECT_TRUE(store().part(kAlice, hash).empty());
}

TEST_F(Store, KeepsTheGuestsPartsOfOneHashApart) {
  const Bytes bytes = some_bytes(2000, 2), garbage = some_bytes(1000, 77);
  const FileHash hash = sha256_of(bytes);
  ASSERT_TRUE(store().add_part(kMallory, hash, 0, garbage));
  EXPECT_TRUE(store().part(kAlice, hash).empty());
  ASSERT_TRUE(store().add_part(kAlice, hash, 0, std::span(bytes).first(1000)));
  store().forget_part(kMallory, hash);
  EXPECT_EQ(store().part(kAlice, hash), Bytes(bytes.begin(), bytes.begin() + 1000));
}

TEST_F(Store, IsWhereTheEnvironmentSays) {
  setenv("XDG_DATA_HOME", "/somewhere/data", 1);
  setenv("XDG_CACHE_HOME", "relative", 1);
  setenv("HOME", "/home/alice", 1);
  const AvatarStore user = AvatarStore::of_user();
  EXPECT_EQ(user.own_folder(), "/somewhere/data/dancegraph/avatars");
  EXPECT_EQ(user.foreign_folder(), "/home/alice/.cache/dancegraph/avatars");
}

}  // namespace
}  // namespace dance
