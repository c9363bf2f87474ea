// Every fuzz target without a fuzzer, on what it begins with, cut short and with bytes turned: so that the
// targets compile and hold on every machine that runs the tests. Usage: fuzz_replay FOLDER..., of
// TARGET/NAME.
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <random>
#include <string>
#include <vector>

using Target = int(const unsigned char*, std::size_t);
#define X(name) extern "C" Target fuzz_##name;
MADORI_FUZZ_TARGETS
#undef X

namespace {

using Bytes = std::vector<unsigned char>;

const std::map<std::string, Target*> kTargets{
#define X(name) {#name, fuzz_##name},
    MADORI_FUZZ_TARGETS
#undef X
};

void run(Target* target, const Bytes& seed, std::mt19937& random) {
  target(seed.data(), seed.size());
  for (int i = 0; i < 4; ++i) {
    const std::size_t cut = random() % seed.size();
    target(seed.data(), cut);
    Bytes turned = seed;
    for (int bytes = 0; bytes <= i; ++bytes) {
      unsigned char& byte = turned[random() % seed.size()];
      byte = static_cast<unsigned char>(byte ^ (1U << random() % 8));
    }
    target(turned.data(), turned.size());
  }
}

}  // namespace

int main(int count, char** words) {
  std::map<std::string, int> seeds;
  std::mt19937 random(1);
  for (int i = 1; i < count; ++i)
    for (const auto& entry : std::filesystem::recursive_directory_iterator(words[i])) {
      if (!entry.is_regular_file()) continue;
      const std::string name = entry.path().parent_path().filename();
      std::ifstream in(entry.path(), std::ios::binary);
      const Bytes seed(std::istreambuf_iterator<char>(in), {});
      std::fprintf(stderr, "%s\n", entry.path().c_str());  // the last one named is the one that failed
      run(kTargets.at(name), seed, random);
      ++seeds[name];
    }
  for (const auto& [name, target] : kTargets)
    if (seeds[name] == 0) return std::fprintf(stderr, "%s has no seed\n", name.c_str()), 1;
  return 0;
}
