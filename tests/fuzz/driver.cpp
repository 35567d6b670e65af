// Runs a fuzz target without libFuzzer: on every file named, or in a folder named, and on blind changes of each.
// usage: PROGRAM [--changes N] FILE_OR_FOLDER...
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>

#include "fuzz.h"

namespace {

using Input = std::vector<uint8_t>;

std::vector<Input> inputs_of(const std::filesystem::path& path) {
  std::vector<std::filesystem::path> files;
  if (std::filesystem::is_directory(path))
    for (const auto& entry : std::filesystem::directory_iterator(path)) files.push_back(entry.path());
  else
    files.push_back(path);
  std::vector<Input> inputs;
  for (const auto& file : files) {
    std::ifstream stream(file, std::ios::binary);
    inputs.emplace_back(std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>());
  }
  return inputs;
}

// One byte changed, a stretch left out, a stretch doubled, or a stretch of another input put in.
void change(Input& input, const Input& other, std::mt19937& random) {
  const auto below = [&](size_t n) { return n ? random() % n : 0; };
  if (input.empty()) return;
  const size_t at = below(input.size()), length = 1 + below(std::min<size_t>(input.size() - at, 32));
  const auto begin = input.begin() + static_cast<ptrdiff_t>(at), end = begin + static_cast<ptrdiff_t>(length);
  switch (random() % 5) {
    case 0:
      *begin = static_cast<uint8_t>(random());
      break;
    case 1:
      *begin ^= static_cast<uint8_t>(1u << random() % 8);
      break;
    case 2:
      input.erase(begin, end);
      break;
    case 3: {
      const Input stretch(begin, end);
      input.insert(begin, stretch.begin(), stretch.end());
      break;
    }
    default: {
      const size_t from = below(other.size()), some = below(std::min<size_t>(other.size() - from, 32) + 1);
      input.insert(begin, other.begin() + static_cast<ptrdiff_t>(from),
                   other.begin() + static_cast<ptrdiff_t>(from + some));
    }
  }
}

}  // namespace

int main(int argc, char** argv) {
  long changes = 0, runs = 0;
  std::vector<Input> inputs;
  for (int a = 1; a < argc; ++a) {
    if (std::strcmp(argv[a], "--changes") == 0 && a + 1 < argc)
      changes = std::atol(argv[++a]);
    else
      for (auto& input : inputs_of(argv[a])) inputs.push_back(std::move(input));
  }
  if (inputs.empty()) return std::fprintf(stderr, "usage: %s [--changes N] FILE_OR_FOLDER...\n", argv[0]), 2;
  std::mt19937 random(1);
  for (const Input& input : inputs) {
    LLVMFuzzerTestOneInput(input.data(), input.size()), ++runs;
    for (long i = 0; i < changes; ++i) {
      Input changed = input;
      for (size_t times = 1 + random() % 4; times > 0; --times)
        change(changed, inputs[random() % inputs.size()], random);
      LLVMFuzzerTestOneInput(changed.data(), changed.size()), ++runs;
    }
  }
  std::printf("%zu inputs, %ld executions, no promise broken\n", inputs.size(), runs);
}
