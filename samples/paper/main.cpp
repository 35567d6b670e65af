// focal_paper [--quick] OUT.html SET...: reproduces the paper's tables and figures with both presets, in one page.
// The first set is asked every question, so are other humans; the rest have tables, planes and Figs. 8, 9, 12 and 13.
#include <chrono>
#include <cstdio>
#include <exception>
#include <fstream>
#include <stdexcept>

#include "page.h"
#include "study.h"

namespace {

using Clock = std::chrono::steady_clock;

void tell(const std::string& what, Clock::time_point start) {
  std::printf("%6.1f s  %s\n", std::chrono::duration<double>(Clock::now() - start).count(), what.c_str());
  std::fflush(stdout);
}

std::string figures_of(const paper::Study& study, bool all, Clock::time_point start) {
  struct Part {
    const char* name;
    std::string (*make)(const paper::Study&);
    bool always;
  };
  static constexpr Part parts[] = {
      {"Figs. 1, 6", paper::pipeline, false},      {"Fig. 2", paper::descriptors, false},
      {"Fig. 3", paper::symmetry, false},          {"Fig. 4", paper::metrics, false},
      {"Fig. 5", paper::regression, false},        {"Fig. 7", paper::sampling, false},
      {"Figs. 8, 9", paper::extraction, true},     {"few marks", paper::few_marks, false},
      {"Fig. 10", paper::damage, false},           {"Fig. 11", paper::resolution, false},
      {"Figs. 12, 13", paper::applications, true}, {"Fig. 14", paper::missing_parts, false}};
  std::string html = "<h2>" + study.set.name + ", " + std::to_string(study.set.train.size()) +
                     " training and " + std::to_string(study.set.test.size()) + " test shapes</h2>\n";
  for (const Part& part : parts) {
    if (!all && !part.always) continue;
    html += part.make(study);
    tell(study.set.name + ", " + part.name, start);
  }
  return html;
}

void write(const std::string& path, const std::string& page) {
  std::ofstream out(path, std::ios::binary);
  out << page << "</body></html>\n";
  if (!out.flush()) throw std::runtime_error("cannot write " + path);
}

// The page is there, as far as it is, after each set.
void write_page(const focal::Context& context, const std::string& path,
                const std::vector<std::string>& folders, bool quick) {
  const auto start = Clock::now();
  std::vector<paper::Study> studies;
  for (const std::string& folder : folders) {
    studies.emplace_back(context, paper::load_set(context, folder, quick ? 4 : 10, quick ? 2 : 4), quick);
    tell(studies.back().set.name + ", models", start);
  }
  std::string page = paper::kHead;
  page += "<h2>Tables</h2>\n" + paper::performance(studies) + paper::errors(studies) + paper::planes(studies);
  write(path, page);
  for (size_t i = 0; i < studies.size(); ++i) {
    page += figures_of(studies[i], i == 0 || studies[i].set.name == "scape", start);
    write(path, page);
  }
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<std::string> words(argv + 1, argv + argc);
  const bool quick = !words.empty() && words[0] == "--quick";
  if (quick) words.erase(words.begin());
  if (words.size() < 2) {
    std::fprintf(stderr, "usage: %s [--quick] OUT.html SET...\n", argv[0]);
    return 2;
  }
  try {
    const focal::Context context;
    write_page(context, words[0], {words.begin() + 1, words.end()}, quick);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "focal_paper: %s\n", error.what());
    return 1;
  }
  return 0;
}
