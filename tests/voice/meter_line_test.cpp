#include "voice/program/meter_line.h"

#include <gtest/gtest.h>
#include <pty.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <array>

namespace dance {
namespace {

TEST(MeterLine, IsCutByCharactersAndNotWithinOne) {
  EXPECT_EQ(cut_to_columns("alice ▮▮▯▯", 10), "alice ▮▮▯▯");
  EXPECT_EQ(cut_to_columns("alice ▮▮▯▯", 9), "alice ▮▮…");
  EXPECT_EQ(cut_to_columns("alice ▮▮▯▯", 1), "…");
  EXPECT_EQ(cut_to_columns("alice", 0), "");
  EXPECT_EQ(cut_to_columns("", 5), "");
}

class MeterLineOfATerminal : public ::testing::Test {
 protected:
  void SetUp() override { ASSERT_EQ(openpty(&master_, &slave_, nullptr, nullptr, nullptr), 0); }
  void TearDown() override {
    close(master_);
    close(slave_);
  }
  void set_columns(unsigned short columns) {
    const winsize size{24, columns, 0, 0};
    ASSERT_EQ(ioctl(slave_, TIOCSWINSZ, &size), 0);
  }
  std::string written() {
    std::array<char, 4096> bytes{};
    const ssize_t count = read(master_, bytes.data(), bytes.size());
    return count > 0 ? std::string(bytes.data(), static_cast<std::size_t>(count)) : std::string();
  }
  int master_ = -1, slave_ = -1;
};

TEST_F(MeterLineOfATerminal, IsNoWiderThanItAndLeavesBeforeWords) {
  MeterLine line(slave_);
  set_columns(12);
  line.show("alice ▮▮▯▯   bob ▮▮▮▮ 52 ms");
  EXPECT_EQ(written(), "\r\033[Kalice ▮▮▯▯…");
  set_columns(80);
  line.show("alice ▮▮▯▯   bob ▮▮▮▮ 52 ms");
  EXPECT_EQ(written(), "\r\033[Kalice ▮▮▯▯   bob ▮▮▮▮ 52 ms") << "it was made wider";
  line.clear();
  EXPECT_EQ(written(), "\r\033[K");
  line.clear();
  line.show("x");
  EXPECT_EQ(written(), "\r\033[Kx") << "nothing was there to be cleared";
}

}  // namespace
}  // namespace dance
