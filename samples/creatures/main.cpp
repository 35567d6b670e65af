// focal_creatures: writes sets of sample characters, each a posed mesh with landmarks, joints and a rig.
#include <algorithm>
#include <atomic>
#include <cstdio>
#include <exception>
#include <mutex>
#include <stdexcept>
#include <string>
#include <thread>

#include "write.h"

namespace {

using namespace creatures;

constexpr const char* usage =
    "usage: focal_creatures OUT [--family NAME] [--train N] [--test N] [--seed S]\n"
    "Writes OUT/FAMILY/: N training and N test characters (default 10 and 5), their landmarks, joints and "
    "rigs.\n"
    "The same seed makes the same characters.\n"
    "Families of closed smooth bodies; all (the default) makes these four:\n"
    "  humanoid, quadruped, hand, insect\n"
    "Families as games have them, for `focal train --rigs OUT/FAMILY/*.rig.glb`. Their seed also chooses the "
    "style:\n"
    "  game_humanoid   realistic, stylised, chibi, mascot with snout and ears, box or capsule robot, block "
    "figure;\n"
    "                  heads of 1/9 to 1/2 of the height; T, A or hanging arms; mittens, fists or fingers; "
    "one skin,\n"
    "                  several surfaces or tubes, 350 to 16000 triangles; clothes that hide the skin below "
    "or replace\n"
    "                  it, boots, skirts, coats, capes, hats, helmets, hair, armour, packs, tails, wings, "
    "weapons,\n"
    "                  eyes and teeth; up to 40 meshes on one skeleton of 22 joints\n"
    "  game_quadruped  like a dog, cat, horse, cow, deer, pig, elephant, bear, lizard or none of them; stout "
    "or thin,\n"
    "                  short or long necks, ears, horns, manes, tails and trunks; one skin, several "
    "surfaces, tubes\n"
    "                  or blocks\n";

struct Options {
  std::string out, family = "all";
  int train = 10, test = 5;
  uint64_t seed = 1;
};

Options parse(int argc, char** argv) {
  Options options;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (!word.starts_with("--")) {
      if (!options.out.empty()) throw std::invalid_argument("more than one folder: " + word);
      options.out = word;
      continue;
    }
    if (i + 1 == argc) throw std::invalid_argument(word + " needs a value, or is unknown");
    const std::string value = argv[++i];
    if (word == "--family") {
      options.family = value;
    } else if (word == "--train") {
      options.train = std::stoi(value);
    } else if (word == "--test") {
      options.test = std::stoi(value);
    } else if (word == "--seed") {
      options.seed = std::stoull(value);
    } else {
      throw std::invalid_argument("unknown option " + word);
    }
  }
  if (options.out.empty()) throw std::invalid_argument("no folder to write to");
  if (options.train < 0 || options.test < 0 || options.train + options.test < 1)
    throw std::invalid_argument("--train and --test must make at least one character");
  return options;
}

void write_family(const Family& family, const Options& options) {
  const int count = options.train + options.test;
  std::vector<Character> characters(static_cast<size_t>(count));
  const std::filesystem::path folder = std::filesystem::path(options.out) / family.name;
  std::atomic<int> next = 0;
  std::exception_ptr failure;
  std::mutex failure_lock;
  const auto work = [&] {
    try {
      for (int i; (i = next++) < count;) {
        std::string name(family.name);
        name.append(i < 10 ? "_0" : "_").append(std::to_string(i));
        characters[i] = make_character(family, name, options.seed * 1000003 + static_cast<uint64_t>(i));
        write_character(characters[i], folder);
      }
    } catch (...) {
      const std::lock_guard lock(failure_lock);
      failure = std::current_exception();
    }
  };
  {
    std::vector<std::jthread> threads;
    for (unsigned t = 0; t < std::max(1u, std::thread::hardware_concurrency()); ++t)
      threads.emplace_back(work);
  }
  if (failure) std::rethrow_exception(failure);
  write_set(family, characters, options.train, options.seed, folder);
  std::printf("%s: %d to train, %d to test\n", folder.string().c_str(), options.train, options.test);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2 || std::string(argv[1]) == "--help") {
    std::fputs(usage, argc < 2 ? stderr : stdout);
    return argc < 2 ? 2 : 0;
  }
  try {
    const Options options = parse(argc, argv);
    bool any = false;
    for (const auto* list : {&families(), &game_families()})
      for (const Family& family : *list)
        if ((options.family == "all" && list == &families()) || options.family == family.name) {
          write_family(family, options);
          any = true;
        }
    if (!any) throw std::invalid_argument("no family is called " + options.family);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "focal_creatures: %s\n%s", error.what(), usage);
    return 1;
  }
}
