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

TEST_CASE("pictures of votes: six figures of both presets in one page that stands alone") {
#ifndef FOCAL_PAPER
  std::cout << "skipped: samples/paper is not built\n";
#else
  const ScratchFolder scratch;
  write_tiny_set(scratch, 4, 1);
  const std::string out = scratch / "votes.html";
  REQUIRE(std::system(
              ("\"" FOCAL_PAPER "\" " + out + " " + scratch.path.string() + " > /dev/null").c_str()) == 0);
  const std::string page = focal_cli::read_text_file(out);
  CHECK(count(page, "<svg ") == 6);
  const std::regex caption(">(paper|default), ([^:<]*): ([^<]*)</text>");
  size_t paper = 0, standard = 0;
  for (std::sregex_iterator match(page.begin(), page.end(), caption), end; match != end; ++match) {
    ((*match)[1] == "paper" ? paper : standard) += 1;
    const double error = std::stod((*match)[3]);
    CHECK(error >= 0);
    CHECK(error < 40);
    const bool learned_from_all = (*match)[1] == "default" && (*match)[2] == "clean";
    if (learned_from_all) CHECK(error < 4);
  }
  CHECK(paper == 21);  // 5 sample counts, 2 training sizes, 2 sides, 4 landmarks, 4 damages, 4 resolutions
  CHECK(standard == paper);
  const std::regex paint("<path fill=\"(#[0-9a-f]{6})\"");
  std::set<std::string> paints;
  for (std::sregex_iterator match(page.begin(), page.end(), paint), end; match != end; ++match)
    paints.insert((*match)[1]);
  CHECK(paints.size() > 60);  // hues of the votes in several shades
  CHECK(page.find("nan") == std::string::npos);
#endif
}
