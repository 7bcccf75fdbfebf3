// The corpus of the fuzzers and damaged copies of it, with the ordinary compiler.

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>

#include "fuzz_functions.h"

namespace sightline::fuzz {
namespace {

namespace fs = std::filesystem;

std::string bytes_of(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream out;
  out << in.rdbuf();
  return out.str();
}

TEST(FuzzReplay, TheCorpusAndDamagedCopiesOfItNeitherCrashNorHang) {
  constexpr int kCopies = 50;
  for (const Function& function : functions()) {
    int files = 0;
    for (const auto& entry :
         fs::directory_iterator(fs::path(SIGHTLINE_FUZZ_CORPUS) / function.name)) {
      SCOPED_TRACE(entry.path());
      const std::string whole = bytes_of(entry.path());
      const auto start = std::chrono::steady_clock::now();
      function.run(whole);
      std::mt19937 random(static_cast<unsigned>(++files));
      for (int i = 0; i < kCopies && !whole.empty(); ++i) {
        std::string damaged = whole;
        damaged[random() % damaged.size()] = static_cast<char>(random());
        if (i % 4 == 0) damaged.erase(random() % damaged.size(), random() % 8);
        if (i % 4 == 1)
          damaged.insert(random() % damaged.size(), damaged, 0, random() % 16);
        function.run(damaged);
      }
      EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(10));
    }
    EXPECT_GT(files, 0) << function.name;
  }
}

}  // namespace
}  // namespace sightline::fuzz
