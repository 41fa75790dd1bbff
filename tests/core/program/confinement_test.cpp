#include "core/program/confinement.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <stdexcept>
#include <vector>

#include "formats/media/confined_decoders.h"
#include "tests/apps/run_program.h"

namespace dance {
namespace {

// 2: a filter of system calls is active (proc(5)).
bool is_confined() {
  return text_of("/proc/thread-self/status").find("Seccomp:\t2") != std::string::npos;
}

bool must_confine() {
#if defined(DANCE_HAVE_SECCOMP) && !defined(DANCE_SANITIZED)
  return prctl(PR_GET_SECCOMP) >= 0;  // false on a kernel without seccomp
#else
  return false;
#endif
}

// True if the filter refused the system call.
bool is_denied(long result) { return result < 0 && errno == EPERM; }

class ConfinementTest : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!must_confine()) GTEST_SKIP() << "this build or kernel has no seccomp";
  }
};

TEST_F(ConfinementTest, DeniesProgramsSocketsWritingAndCode) {
  const TestFolder folder("confinement");
  const std::string path = folder.path("written");
  const auto denied = run_confined([&]() -> Result<std::vector<bool>> {
    std::vector<bool> calls;
    calls.push_back(is_denied(socket(AF_INET, SOCK_DGRAM, 0)));
    calls.push_back(is_denied(socket(AF_UNIX, SOCK_STREAM, 0)));
    calls.push_back(is_denied(open(path.c_str(), O_WRONLY | O_CREAT, 0600)));
    calls.push_back(is_denied(open("/proc/self/mem", O_RDWR)));
    calls.push_back(is_denied(unlink(path.c_str())));
    calls.push_back(is_denied(fcntl(STDERR_FILENO, F_SETOWN, getppid())));
    calls.push_back(is_denied(setpriority(PRIO_PROCESS, static_cast<id_t>(getppid()), 19)));
    calls.push_back(is_denied(execl("/bin/true", "true", nullptr)));
    void* const code =
        mmap(nullptr, 4096, PROT_READ | PROT_EXEC, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    calls.push_back(code == MAP_FAILED && errno == EPERM);
    return calls;
  });
  ASSERT_TRUE(denied) << denied.error().what;
  EXPECT_EQ(*denied, std::vector<bool>(denied->size(), true));
  EXPECT_FALSE(std::filesystem::exists(path));
}

TEST_F(ConfinementTest, AllowsMemoryFilesAndThreads) {
  const auto confined = run_confined([]() -> Result<int> {
    const std::vector<char> memory(64 << 20, 1);
    if (text_of("/proc/self/status").empty()) return fail("a file could not be read");
    bool is_thread_confined = false;
    std::thread([&] { is_thread_confined = is_confined(); }).join();
    if (!is_thread_confined) return fail("a thread that it starts is not confined");
    return memory.back();
  });
  EXPECT_TRUE(confined) << confined.error().what;
}

TEST_F(ConfinementTest, ReportsThatAThreadIsConfined) {
  bool is_on = false;
  std::thread([&] { is_on = confine_thread(); }).join();
  EXPECT_TRUE(is_on);
}

TEST_F(ConfinementTest, LeavesOtherThreadsFree) {
  ASSERT_TRUE(run_confined([] { return Result<bool>(is_confined()); }).value_or(false));
  EXPECT_FALSE(is_confined());
  const int fd = socket(AF_INET, SOCK_DGRAM, 0);
  EXPECT_GE(fd, 0);
  close(fd);
}

TEST(ConfinedThread, TurnsExceptionsIntoErrors) {
  const auto failed =
      run_confined([]() -> Result<int> { throw std::runtime_error("a reader's bug"); });
  ASSERT_FALSE(failed);
  EXPECT_EQ(failed.error().what,
            "damaged in a way that its reader cannot name; copy it again, or export it again");
  const auto too_large = run_confined([]() -> Result<int> { throw std::bad_alloc(); });
  ASSERT_FALSE(too_large);
  EXPECT_EQ(too_large.error().what,
            "needs more memory than there is; end other programs, or make it smaller");
}

TEST(ConfinedThread, RunsAllCallsOnOneThread) {
  ConfinedThread thread;
  const auto id = [] { return Result<std::thread::id>(std::this_thread::get_id()); };
  const auto first = thread.call(id), second = thread.call(id);
  EXPECT_EQ(*first, *second);
  EXPECT_NE(*first, std::this_thread::get_id());
}

// Reports as its only sample whether it is confined.
class ReportingAudio final : public AudioDecoder {
 public:
  AudioFormat format() const override { return {48000, 1, 1}; }
  Result<std::size_t> read(std::span<float> samples) override {
    samples[0] = is_confined() ? 1.0f : 0.0f;
    return 1;
  }
  Result<void> seek(std::int64_t) override { return fail("cannot seek"); }
};

TEST_F(ConfinementTest, HoldsForDecodersOfMusic) {
  auto audio = open_confined(
      []() -> Result<std::unique_ptr<AudioDecoder>> { return std::make_unique<ReportingAudio>(); });
  ASSERT_TRUE(audio) << audio.error().what;
  float sample = 0.0f;
  ASSERT_TRUE((*audio)->read({&sample, 1}));
  EXPECT_EQ(sample, 1.0f);
  EXPECT_EQ((*audio)->seek(0).error().what, "cannot seek");
}

TEST(ConfinedDecoders, PassErrorsOfOpeningOn) {
  const auto audio = open_confined(
      []() -> Result<std::unique_ptr<AudioDecoder>> { return fail("no file of music"); });
  ASSERT_FALSE(audio);
  EXPECT_EQ(audio.error().what, "no file of music");
}

}  // namespace
}  // namespace dance
