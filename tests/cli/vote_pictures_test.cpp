// samples/paper on a small set: every figure is there, with votes in colour and errors that a found landmark can have.
#include <doctest/doctest.h>

#include <cstdlib>
#include <iostream>
#include <regex>
#include <set>

#include "files.h"
#include "tiny_set.h"

namespace {

[[maybe_unused]] size_t count(const std::string& text, const std::string& part) {
  size_t found = 0;
  for (size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++found;
  return found;
}

}  // namespace

TEST_CASE("the paper's experiments: every table and figure of both presets in one page that stands alone") {
#ifndef FOCAL_PAPER
  std::cout << "skipped: samples/paper is not built\n";
#else
  const ScratchFolder scratch;
  write_tiny_set(scratch, 3, 1);
  const std::string out = scratch / "index.html";
  REQUIRE(std::system(("\"" FOCAL_PAPER "\" --quick " + out + " " + scratch.path.string() + " > /dev/null")
                          .c_str()) == 0);
  const std::string page = focal_cli::read_text_file(out);
  for (const char* title : {"Table 1", "Table 2", "Fig. 1:", "Fig. 2", "Fig. 3 a", "Fig. 3 b", "Fig. 4",
                            "Fig. 5", "Fig. 6", "Fig. 7 a", "Fig. 7 b", "Fig. 7 c", "Figs. 8 and 9",
                            "Schelling", "Fig. 10", "Fig. 11", "Fig. 12", "Fig. 13"}) {
    CAPTURE(title);
    CHECK(count(page, std::string("<h3>") + title) + count(page, std::string("<h3>Beside ") + title) == 1);
  }
  CHECK(page.find("<img") == std::string::npos);  // nothing is fetched
  const std::regex caption(">(paper|default), ([^:<]*): ([0-9.]+)</text>");
  size_t paper = 0, standard = 0;
  for (std::sregex_iterator match(page.begin(), page.end(), caption), end; match != end; ++match) {
    ((*match)[1] == "paper" ? paper : standard) += 1;
    const double error = std::stod((*match)[3]);
    CHECK(error < 40);
    if ((*match)[1] == "default" && (*match)[2] == "clean") CHECK(error < 4);
  }
  CHECK(paper > 10);
  CHECK(standard > 10);
  const std::regex paint("<path fill=\"(#[0-9a-f]{6})\"");
  std::set<std::string> paints;
  for (std::sregex_iterator match(page.begin(), page.end(), paint), end; match != end; ++match)
    paints.insert((*match)[1]);
  CHECK(paints.size() > 60);  // hues of the votes in several shades
  CHECK(page.find("nan") == std::string::npos);
#endif
}
