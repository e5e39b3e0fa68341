// Feeds random mutations of seed files to LLVMFuzzerTestOneInput() for a time.
//
//   fuzz_NAME SECONDS [FOLDER_WITH_SEEDS] [RANDOM_SEED]
//
// An input that brings the process down is left in finding_NAME.bin in the current folder; given in place of
// SECONDS, such a file is fed once.

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

#include "fuzz_target.h"

namespace {

using Input = std::vector<std::uint8_t>;

constexpr std::size_t kMaxInputBytes = 1U << 14U;
constexpr unsigned kTimeoutS = 60;  // for one input; what takes longer does not end

Input current;
std::string finding;

void saveFinding() {
  if (std::FILE* file = std::fopen(finding.c_str(), "wb")) {
    std::fwrite(current.data(), 1, current.size(), file);
    std::fclose(file);
    std::fprintf(stderr, "the input is in %s\n", finding.c_str());
  }
}

Input contentOf(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

class Mutator {
 public:
  Mutator(std::vector<Input> seeds, unsigned seed) : seeds_(std::move(seeds)), random_(seed) {}

  Input next() {
    Input input = seeds_[below(seeds_.size())];
    // Where nothing is known of the form, bytes of any length.
    if (input.empty() && below(2) == 0) {
      input.resize(below(kMaxInputBytes >> below(8)));
      for (std::uint8_t& byte : input) byte = static_cast<std::uint8_t>(random_());
    }
    for (std::size_t i = 1 + below(8); i > 0; --i) mutate(input);
    if (input.size() > kMaxInputBytes) input.resize(kMaxInputBytes);
    return input;
  }

 private:
  std::size_t below(std::size_t limit) {
    return std::uniform_int_distribution<std::size_t>(0, limit - 1)(random_);
  }

  void mutate(Input& input) {
    static const std::vector<std::string> kWords = {
        "nan", "-inf", "1e999", "-1", "0",    "4294967296", "1e-320", "[",  "]",  "{",  ":",    "- ",
        "\n",  " ",    ",",     "#",  "null", "~",          "&a",     "*a", "\t", "\"", "0x7f", "."};
    const std::size_t at = below(input.size() + 1);
    const auto position = input.begin() + static_cast<std::ptrdiff_t>(at);
    const std::size_t run = input.size() > at ? 1 + below(std::min<std::size_t>(input.size() - at, 64)) : 0;
    switch (below(6)) {
      case 0:
        if (run > 0) *position ^= static_cast<std::uint8_t>(1U << below(8));
        break;
      case 1:
        if (run > 0) *position = static_cast<std::uint8_t>(below(256));
        break;
      case 2:
        input.erase(position, position + static_cast<std::ptrdiff_t>(run));
        break;
      case 3: {
        const std::string& word = kWords[below(kWords.size())];
        input.insert(position, word.begin(), word.end());
        break;
      }
      case 4: {
        const Input copy(position, position + static_cast<std::ptrdiff_t>(run));
        input.insert(input.begin() + static_cast<std::ptrdiff_t>(below(input.size() + 1)), copy.begin(),
                     copy.end());
        break;
      }
      default: {
        Input bytes(1 + below(32));
        for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(below(256));
        input.insert(position, bytes.begin(), bytes.end());
      }
    }
  }

  std::vector<Input> seeds_;
  std::mt19937 random_;
};

}  // namespace

// Called by AddressSanitizer before it ends the process; UndefinedBehaviorSanitizer aborts (fuzz.sh).
extern "C" void __sanitizer_set_death_callback(void (*callback)()) __attribute__((weak));

int main(int argc, char** argv) {
  if (argc < 2) return std::fprintf(stderr, "usage: %s SECONDS|INPUT [SEEDS [RANDOM_SEED]]\n", argv[0]), 2;
  const std::filesystem::path program = argv[0];
  if (std::filesystem::exists(argv[1])) {
    const Input input = contentOf(argv[1]);
    return LLVMFuzzerTestOneInput(input.data(), input.size());
  }
  finding = "finding_" + program.filename().string() + ".bin";
  if (__sanitizer_set_death_callback != nullptr) __sanitizer_set_death_callback(saveFinding);
  std::signal(SIGABRT, [](int) { saveFinding(); });
  std::signal(SIGALRM, [](int) { std::abort(); });

  std::vector<Input> seeds(1);
  if (argc > 2) {
    for (const auto& entry : std::filesystem::directory_iterator(argv[2]))
      seeds.push_back(contentOf(entry.path()));
  }
  Mutator mutator(std::move(seeds),
                  argc > 3 ? static_cast<unsigned>(std::stoul(argv[3])) : std::random_device{}());
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(std::stod(argv[1]));
  std::size_t inputs = 0;
  for (; std::chrono::steady_clock::now() < end; ++inputs) {
    current = mutator.next();
    alarm(kTimeoutS);
    try {
      LLVMFuzzerTestOneInput(current.data(), current.size());
    } catch (const std::exception& error) {
      std::fprintf(stderr, "an error that was not promised: %s\n", error.what());
      saveFinding();
      return 1;
    }
  }
  alarm(0);
  std::printf("%s: %zu inputs, nothing found\n", program.filename().c_str(), inputs);
  return inputs > 0 ? 0 : 1;
}
