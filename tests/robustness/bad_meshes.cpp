// Bad meshes, made and collected, each through the C API: a finite result or a clear error, and nearly always the first.
//   focal_bad_meshes [--count N] [--seed N] [--kind NAME] [--only I] [--folder DIR]
// DIR: files with hard defects; by default corpora/meshes_bad of FOCAL_EVALUATION_DATA, where there is one.
// Meshes run in a process of their own, so that a crash is counted, not suffered. Ends with 1 when a promise is broken:
// a crash, more than 20 s for one mesh, a result that is not finite or out of range, an error that is not clear, or less
// than 99 % usable of those that should be (see should_be_usable).
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <iostream>
#include <map>

#include "bad_mesh_trial.h"
extern "C" {
#include "capi/shapes.h"
}

namespace {

using namespace focal_bad_meshes;
namespace fs = std::filesystem;

struct Options {
  size_t count = 5000;
  uint64_t seed = 1;
  std::string kind, folder;
  long only = -1;
};

Options options_of(int count, char** arguments) {
  Options options;
  if (const char* data = std::getenv("FOCAL_EVALUATION_DATA"))
    options.folder = fs::path(data) / "corpora/meshes_bad";
  for (int i = 1; i < count; i += 2) {
    const std::string name = arguments[i], value = i + 1 < count ? arguments[i + 1] : "";
    if (name == "--count")
      options.count = std::stoul(value);
    else if (name == "--seed")
      options.seed = std::stoull(value);
    else if (name == "--kind")
      options.kind = value;
    else if (name == "--only")
      options.only = std::stol(value);
    else if (name == "--folder")
      options.folder = value;
    else
      std::cerr << "unknown option " << name << '\n', std::exit(2);
  }
  return options;
}

struct Trial {
  std::string kind, file;  // a file, or made of the kind's number and a seed
  size_t number = 0;
  uint64_t seed = 0;
};

std::vector<Trial> trials_of(const Options& options) {
  std::vector<Trial> trials;
  for (size_t i = 0; i < options.count; ++i) {
    const size_t kind = i % kinds().size();
    if (options.kind.empty() || kinds()[kind] == options.kind)
      trials.push_back({kinds()[kind], {}, kind, options.seed + i / kinds().size()});
  }
  if (!options.kind.empty() || options.folder.empty() || !fs::is_directory(options.folder)) return trials;
  std::vector<std::string> files;
  for (const auto& entry : fs::directory_iterator(options.folder))
    if (entry.path().extension() == ".glb") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  for (const auto& file : files) trials.push_back({"collected files", file});
  return trials;
}

// What the trying process leaves for the judging one.
struct Record {
  Outcome outcome;
  bool should_be_usable;
  char note[240];
};

// Without and with a proxy: half of the meshes are decimated too.
class Trier {
 public:
  Trier() {
    auto context = initialised(focal_context_params_init);
    context.thread_count = 1;
    insist(focal_context_create(&context, &context_));
    for (size_t i = 0; i < 2; ++i) {
      focal_training_set* set = shape_training_set(context_, 8, 4);
      auto params = initialised(focal_train_params_init);
      params.tree_count = 4, params.proxy_vertices = i ? 60 : 3500;
      insist(focal_model_train(set, &params, nullptr, &model_[i]));
      focal_training_set_destroy(set);
    }
  }
  ~Trier() {
    for (focal_model* model : model_) focal_model_destroy(model);
    focal_context_destroy(context_);
  }
  Trier(const Trier&) = delete;
  Trier& operator=(const Trier&) = delete;

  void run(const Trial& trial, Record& record) const {
    const focal_model* model = model_[trial.seed % 2];
    Verdict verdict;
    if (trial.file.empty()) {
      const BadMesh mesh = make(trial.number, trial.seed);
      record.should_be_usable = should_be_usable(mesh);
      verdict = try_mesh(context_, model, mesh);
    } else {
      verdict = try_file(context_, model, trial.file);
      record.should_be_usable =
          verdict.outcome != Outcome::refused;  // judged by hand, see the list of refusals
    }
    std::snprintf(record.note, sizeof record.note, "%s", verdict.note.c_str());
    record.outcome = verdict.outcome;  // last: a crash before leaves none
  }

 private:
  template <class Struct>
  static Struct initialised(focal_status (*init)(Struct*, size_t)) {
    Struct value;
    insist(init(&value, sizeof value));
    return value;
  }
  static void insist(focal_status status) {
    if (status != FOCAL_OK) std::cerr << focal_last_error() << '\n', std::exit(2);
  }
  focal_context* context_ = nullptr;
  focal_model* model_[2] = {};
};

// A new process goes on behind every mesh that ends one.
void run_all(const Trier& trier, const std::vector<Trial>& trials, Record* records) {
  auto* next = static_cast<size_t*>(
      mmap(nullptr, sizeof(size_t), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0));
  while (*next < trials.size()) {
    const pid_t child = fork();
    if (child == 0) {
      while (*next < trials.size()) {
        const size_t i = (*next)++;
        alarm(FOCAL_LONGEST_SECONDS);
        trier.run(trials[i], records[i]);
      }
      _exit(0);
    }
    int status = 0;
    waitpid(child, &status, 0);
    if (WIFSIGNALED(status))
      std::snprintf(records[*next - 1].note, sizeof records->note, "%s", strsignal(WTERMSIG(status)));
  }
}

struct Tally {
  size_t meshes = 0, ended = 0, broken = 0, usable = 0, refused = 0, should = 0, should_and_is = 0;
  void add(const Record& record) {
    ++meshes;
    ended += record.outcome == Outcome::none, broken += record.outcome == Outcome::broken;
    usable += record.outcome == Outcome::usable, refused += record.outcome == Outcome::refused;
    should += record.should_be_usable;
    should_and_is += record.should_be_usable && record.outcome == Outcome::usable;
  }
  double share() const {
    return should ? 100.0 * static_cast<double>(should_and_is) / static_cast<double>(should) : 100;
  }
  bool keeps_promises() const { return ended == 0 && broken == 0 && share() >= 99; }
};

void print(const std::string& name, const Tally& tally) {
  std::printf(
      "%-26s %6zu meshes, %zu crashes, %zu not finite, %5zu usable, %4zu clear errors; of %5zu that should "
      "be "
      "usable %6.2f %% are\n",
      name.c_str(), tally.meshes, tally.ended, tally.broken, tally.usable, tally.refused, tally.should,
      tally.share());
}

}  // namespace

int main(int count, char** arguments) {
  const Options options = options_of(count, arguments);
  const std::vector<Trial> trials = trials_of(options);
  auto* records = static_cast<Record*>(mmap(nullptr, trials.size() * sizeof(Record), PROT_READ | PROT_WRITE,
                                            MAP_SHARED | MAP_ANONYMOUS, -1, 0));
  const Trier trier;
  if (options.only >= 0) {  // in this process, for a debugger
    const auto i = static_cast<size_t>(options.only);
    trier.run(trials.at(i), records[i]);
    std::printf("%s: %d %s\n", trials[i].kind.c_str(), static_cast<int>(records[i].outcome), records[i].note);
    return 0;
  }
  run_all(trier, trials, records);
  Tally all;
  std::map<std::string, Tally> by_kind;
  for (size_t i = 0; i < trials.size(); ++i) {
    const Record& record = records[i];
    all.add(record), by_kind[trials[i].kind].add(record);
    const bool as_promised =
        record.outcome == Outcome::usable || (record.outcome == Outcome::refused && !record.should_be_usable);
    if (!as_promised)
      std::printf("%zu (%s): %s\n", i,
                  trials[i].file.empty() ? trials[i].kind.c_str() : trials[i].file.c_str(), record.note);
  }
  for (const auto& [kind, tally] : by_kind) print(kind, tally);
  print("all", all);
  return all.keeps_promises() ? 0 : 1;
}
