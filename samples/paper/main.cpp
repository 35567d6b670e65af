// focal_paper OUT.html SET...: pictures of votes like the paper's Figs. 7-11, both presets, in one page of its own.
#include <cstdio>
#include <exception>
#include <fstream>

#include "figures.h"

namespace {

constexpr size_t kTrain = 6, kTest = 1;

constexpr const char* kHead = R"(<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width, initial-scale=1">
<link rel="icon" href="data:,"><title>Votes for focal features</title>
<style>
:root { color-scheme: light dark; }
body { font: 16px/1.45 system-ui, sans-serif; max-width: 1180px; margin: 0 auto; padding: 1.2rem; background: #fff; color: #222; }
@media (prefers-color-scheme: dark) { body { background: #17181b; color: #e8e6e1; } }
svg { max-width: 100%; height: auto; }
h2 { margin-top: 2.5rem; }
.ramp { display: inline-block; width: 9rem; height: .8rem; border-radius: 4px; vertical-align: middle;
  background: linear-gradient(90deg, #ccc7bd, #fadb8c, #f79940, #d93829, #800a29); }
.found, .marked { display: inline-block; width: .8rem; height: .8rem; border-radius: 50%; vertical-align: middle; }
.found { background: #2563eb; } .marked { border: 3px solid #0a7d3c; }
</style></head><body>
<h1>Votes for focal features</h1>
<p>How the points of a surface vote for a landmark, with the method of Xia et al. 2016 to the letter (preset paper) and with the
default one, which lets a constellation choose among the candidates that the votes leave. The test shape was not trained on.
Votes: none <span class="ramp"></span> most. <span class="marked"></span> marked by hand, <span class="found"></span> found.
The number in a caption is the error in mean edge lengths.</p>
)";

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) {
    std::fprintf(stderr, "usage: %s OUT.html SET...\n", argv[0]);
    return 2;
  }
  try {
    const focal::Context context;
    std::string page = kHead;
    for (int i = 2; i < argc; ++i) {
      const paper::Set set = paper::load_set(context, argv[i], kTrain, kTest);
      std::printf("%s\n", set.name.c_str());
      std::fflush(stdout);
      page += "<h2>" + set.name + ", " + std::to_string(set.train.size()) + " training shapes</h2>\n";
      page += paper::figures_of(context, set);
    }
    std::ofstream out(argv[1], std::ios::binary);
    out << page << "</body></html>\n";
    if (!out.flush()) throw std::runtime_error(std::string("cannot write ") + argv[1]);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "focal_paper: %s\n", error.what());
    return 1;
  }
  return 0;
}
