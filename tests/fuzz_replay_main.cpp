// Runs one fuzz target without libFuzzer: every file of the given corpus directories, and damaged
// copies of them (prefixes, bit flips, extreme bytes, removed and repeated pieces, splices of two
// files, changed fields). The seed is fixed, so that a failure comes back. Every file runs whole;
// its damage has a share of the time, and inputs beyond that share are counted and left out.
//
// Failure: exit 1 where a directory is missing or holds no file; a target that fails aborts with
//          the input's name.
#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/base/random.h"
#include "tests/field_mutation.h"
#include "tests/fuzz_target.h"

namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr std::uint64_t kSeed = 20'240'229;
// Work per file and kind of damage: small inputs are damaged everywhere, large ones at evenly
// spaced places. libFuzzer goes further under the sanitizers.
constexpr std::size_t kWork_bytes = 2u << 20;
constexpr std::size_t kMostRuns = 256;
constexpr std::size_t kFewestRuns = 16;
constexpr std::chrono::duration<double> kDamage{8.0};
constexpr std::uint8_t kExtremes[] = {0x00, 0xff, 0x7f, 0x80};

std::size_t runs_for(std::size_t size_bytes) {
  return std::clamp(kWork_bytes / (size_bytes + 1), kFewestRuns, kMostRuns);
}

struct File {
  std::string name;
  Bytes bytes;
};

class Replay {
 public:
  Replay(dance::FuzzTarget::Run target, std::size_t files)
      : target_(target),
        share_(std::chrono::duration_cast<Clock::duration>(kDamage / static_cast<double>(files))) {}

  // The target gets a block of exactly the input's size, so that a sanitizer sees a read beyond its
  // end.
  void run(std::span<const std::uint8_t> input) {
    const std::unique_ptr<std::uint8_t[]> exact(new std::uint8_t[input.size()]);
    if (!input.empty()) std::memcpy(exact.get(), input.data(), input.size());
    target_(exact.get(), input.size());
    ++inputs_;
  }

  void run_damaged(const File& file) {
    until_ = Clock::now() + share_;
    run_prefixes(file.bytes);
    run_bit_flips(file.bytes);
    run_extreme_bytes(file.bytes);
    run_cut_and_repeated(file.bytes);
    // A share of its own: fields are what the other kinds of damage seldom reach.
    until_ = Clock::now() + share_ / 2;
    const std::size_t runs = runs_for(file.bytes.size());
    for (std::size_t i = 0; i < runs; ++i)
      run_in_time(dance::with_field_mutated(file.bytes, random_));
  }

  void run_spliced(const File& head, const File& tail) {
    until_ = Clock::now() + share_ / 8;
    const std::size_t runs = std::min<std::size_t>(16, runs_for(head.bytes.size()));
    for (std::size_t i = 0; i < runs; ++i) {
      Bytes input(head.bytes.begin(), head.bytes.begin() + place_in(head.bytes));
      input.insert(input.end(), tail.bytes.begin() + place_in(tail.bytes), tail.bytes.end());
      run_in_time(input);
    }
  }

  std::size_t inputs() const { return inputs_; }
  std::size_t left_out() const { return left_out_; }

 private:
  using Clock = std::chrono::steady_clock;

  void run_in_time(std::span<const std::uint8_t> input) {
    if (Clock::now() < until_)
      run(input);
    else
      ++left_out_;
  }
  std::ptrdiff_t place_in(const Bytes& bytes) {
    return static_cast<std::ptrdiff_t>(random_.below(bytes.size() + 1));
  }

  void run_prefixes(const Bytes& bytes) {
    const std::size_t step = std::max<std::size_t>(1, bytes.size() / runs_for(bytes.size()));
    for (std::size_t size = 0; size < bytes.size(); size += step)
      run_in_time(std::span(bytes).first(size));
  }

  void run_bit_flips(const Bytes& bytes) {
    Bytes input = bytes;
    const std::size_t bits = bytes.size() * 8;
    // An odd stride visits every bit position of a byte, not only the lowest.
    const std::size_t step = std::max<std::size_t>(1, bits / runs_for(bytes.size())) | 1;
    for (std::size_t bit = 0; bit < bits; bit += step) {
      const auto mask = static_cast<std::uint8_t>(1u << (bit % 8));
      input[bit / 8] ^= mask;
      run_in_time(input);
      input[bit / 8] ^= mask;
    }
  }

  // One byte, and a field of four: counts and lengths at 0, -1 and the largest.
  void run_extreme_bytes(const Bytes& bytes) {
    Bytes input = bytes;
    const std::size_t runs = std::max<std::size_t>(1, runs_for(bytes.size()) / 4);
    const std::size_t step = std::max<std::size_t>(1, bytes.size() / runs);
    for (std::size_t at = 0; at < bytes.size(); at += step) {
      const std::size_t field = std::min<std::size_t>(4, bytes.size() - at);
      for (const std::uint8_t extreme : kExtremes) {
        input[at] = extreme;
        run_in_time(input);
        std::fill_n(input.begin() + static_cast<std::ptrdiff_t>(at), field, extreme);
        run_in_time(input);
        std::copy_n(bytes.begin() + static_cast<std::ptrdiff_t>(at), field,
                    input.begin() + static_cast<std::ptrdiff_t>(at));
      }
    }
  }

  void run_cut_and_repeated(const Bytes& bytes) {
    const std::size_t runs = std::min<std::size_t>(64, runs_for(bytes.size()));
    for (std::size_t i = 0; i < runs; ++i) {
      auto from = place_in(bytes), to = place_in(bytes);
      if (from > to) std::swap(from, to);
      Bytes cut(bytes.begin(), bytes.begin() + from);
      cut.insert(cut.end(), bytes.begin() + to, bytes.end());
      run_in_time(cut);
      Bytes repeated(bytes.begin(), bytes.begin() + to);
      repeated.insert(repeated.end(), bytes.begin() + from, bytes.end());
      run_in_time(repeated);
    }
  }

  dance::FuzzTarget::Run target_;
  dance::Random random_{kSeed};
  Clock::duration share_;
  Clock::time_point until_;
  std::size_t inputs_ = 0, left_out_ = 0;
};

bool read_corpus(const std::filesystem::path& directory, std::vector<File>& files) {
  std::error_code error;
  std::filesystem::recursive_directory_iterator entries(directory, error);
  if (error) {
    std::fprintf(stderr, "%s: no corpus: %s\n", directory.c_str(), error.message().c_str());
    return false;
  }
  const std::size_t before = files.size();
  for (const auto& entry : entries) {
    if (!entry.is_regular_file()) continue;
    std::ifstream stream(entry.path(), std::ios::binary);
    files.push_back({entry.path().string(), Bytes(std::istreambuf_iterator<char>(stream),
                                                  std::istreambuf_iterator<char>())});
  }
  if (files.size() == before) {
    std::fprintf(stderr, "%s: the corpus holds no file\n", directory.c_str());
    return false;
  }
  return true;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) {
    std::fprintf(stderr, "%s: give a fuzz target and at least one corpus directory\n", argv[0]);
    return 2;
  }
  const dance::FuzzTarget::Run target = dance::FuzzTarget::find(argv[1]);
  std::vector<File> files;
  for (int i = 2; i < argc; ++i)
    if (!read_corpus(argv[i], files)) return 1;
  // The order of a directory is the file system's; the order of a run must not be.
  std::sort(files.begin(), files.end(),
            [](const File& a, const File& b) { return a.name < b.name; });

  Replay replay(target, files.size());
  replay.run({});
  // Said before the run, so that the last line in front of a crash names the file.
  for (const File& file : files) {
    std::fprintf(stderr, "%s (%zu bytes)\n", file.name.c_str(), file.bytes.size());
    replay.run(file.bytes);
  }
  for (const File& file : files) {
    std::fprintf(stderr, "damage of %s\n", file.name.c_str());
    replay.run_damaged(file);
  }
  for (std::size_t i = 0; i < files.size(); ++i) {
    replay.run_spliced(files[i], files[(i + 1) % files.size()]);
    replay.run_spliced(files[(i + 1) % files.size()], files[i]);
  }
  std::printf("%zu inputs from %zu files, seed %llu; %zu left out for time\n", replay.inputs(),
              files.size(), static_cast<unsigned long long>(kSeed), replay.left_out());
  return 0;
}
