// focal eval --report in a real browser: nothing is loaded or complained of, the surface is drawn, keys are answered.
#include <doctest/doctest.h>

#include <cstdlib>
#include <iostream>
#include <nlohmann/json.hpp>

#include "browser.h"
#include "files.h"
#include "report_files.h"
#include "tiny_set.h"

namespace {

using nlohmann::json;

// Eggs, one of which lacks its tail and has a name that HTML would take for a tag; the page of a model of them.
struct Report {
  ScratchFolder scratch;
  json measured;
  Report() {
    write_tiny_set(scratch, 4, 3);
    json marks = json::parse(focal_cli::read_text_file(scratch / "egg5.landmarks.json"));
    marks["landmarks"].erase(3);
    scratch.write("egg5.landmarks.json", marks.dump());
    json set = json::parse(focal_cli::read_text_file(scratch / "set.json"));
    set["name"] = "eggs </script><b>\"x\"";
    scratch.write("set.json", set.dump());
    const std::string folder = scratch.path.string();
    run("train " + folder + " -o " + model() + " --eigenpairs 40 --trees 8 --quiet");
    run("eval " + model() + " " + folder + " --report " + page() + " --json > " + (scratch / "eval.json"));
    measured = json::parse(focal_cli::read_text_file(scratch / "eval.json"));
  }
  std::string model() const { return scratch / "eggs.focal"; }
  std::string page() const { return scratch / "report.html"; }
  static void run(const std::string& arguments) {
    REQUIRE(std::system(("\"" FOCAL_COMMAND "\" " + arguments).c_str()) == 0);
  }
};

const Report& report() {
  static const Report made;
  return made;
}

Browser* browser() {
  static const auto program = Browser::program();
  static const std::unique_ptr<Browser> opened = program ? std::make_unique<Browser>(*program) : nullptr;
  if (!opened) std::cout << "skipped: no Chromium on this machine\n";
  return opened.get();
}

constexpr const char* ready = "document.documentElement?.dataset.drawn !== undefined";

// Share of the canvas that is painted, and share that has the red of many votes.
json painted(Browser& page, const std::string& canvas) {
  return page.evaluate(R"((async () => {
    await new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)));
    const canvas = document.querySelector(')" +
                       canvas + R"(');
    const copy = new OffscreenCanvas(canvas.width, canvas.height).getContext("2d", {willReadFrequently: true});
    copy.drawImage(canvas, 0, 0);
    const p = copy.getImageData(0, 0, canvas.width, canvas.height).data;
    let some = 0, red = 0, sum = 0;
    for (let i = 0; i < p.length; i += 4) {
      some += p[i + 3] > 200;
      red += p[i + 3] > 200 && p[i] > 1.6 * p[i + 1] && p[i] > 1.3 * p[i + 2];
      sum = (sum * 31 + p[i] + 7 * p[i + 1] + 13 * p[i + 3]) % 1000003;
    }
    return {some: 4 * some / p.length, red: 4 * red / p.length, sum};
  })())");
}

// Without a GPU the browser's software renderer says that reading pictures back is slow; that is not the page's.
void check_quiet(const Browser& page) {
  for (const std::string& complaint : page.complaints()) {
    CAPTURE(complaint);
    CHECK(complaint.find("GL Driver Message") != std::string::npos);
  }
  for (const std::string& address : page.requests()) {
    CAPTURE(address);
    CHECK((address.starts_with("file://" + report().page()) || address == "data:,"));
  }
  CHECK_FALSE(page.requests().empty());  // the page itself: requests are seen at all
}

void open(Browser& page, const std::string& renderer) {
  page.size(1280, 900);
  page.open("file://" + report().page() + (renderer == "canvas" ? "#flat" : ""), ready);
  REQUIRE(page.evaluate("document.documentElement.dataset.renderer") == renderer);
}

void check_surface_and_keys(Browser& page) {
  const json start = painted(page, "#viewer");
  CHECK(start["some"].get<double>() > 0.1);
  CHECK(start["some"].get<double>() < 0.9);
  CHECK(start["red"].get<double>() > 0.001);
  CHECK(painted(page, "#worst canvas")["some"].get<double>() > 0.1);
  page.evaluate("document.getElementById('viewer').focus()");
  page.press("ArrowRight");
  const json turned = painted(page, "#viewer");
  CHECK(turned["sum"] != start["sum"]);
  page.press("0");
  CHECK(painted(page, "#viewer")["sum"] == start["sum"]);
  page.press("+");
  CHECK(painted(page, "#viewer")["some"].get<double>() > start["some"].get<double>());
  page.evaluate(
      "document.getElementById('landmark').value = ''; "
      "document.getElementById('landmark').dispatchEvent(new Event('change'))");
  CHECK(painted(page, "#viewer")["red"].get<double>() < 0.001);  // all landmarks: no votes
  const json mesh = page.evaluate("document.getElementById('mesh').value");
  page.press("]");
  CHECK(page.evaluate("document.getElementById('mesh').value") != mesh);
  page.press(".");
  CHECK(page.evaluate("document.getElementById('landmark').value") == "nose");
}

}  // namespace

TEST_CASE("the page holds all its parts and refers to nothing outside") {
  const std::string page = focal_cli::read_text_file(report().page());
  for (const auto part :
       {focal_cli::report_style_text, focal_cli::report_script_text, focal_cli::report_three_text}) {
    CHECK(page.find(part) != std::string::npos);
  }
  CHECK(page.find("{{") ==
        page.find("{{", page.find("<script>")));  // no placeholder is left before the scripts
  CHECK(page.find("</script><b>") == std::string::npos);
  CHECK(page.size() < 2'000'000);
  for (size_t at = page.find("http"); at != std::string::npos; at = page.find("http", at + 4)) {
    if (page.compare(at, 7, "http://") != 0 && page.compare(at, 8, "https://") != 0) continue;
    CHECK(page.substr(at, 18) == "http://www.w3.org/");  // names of XML vocabularies, never fetched
  }
}

TEST_CASE(
    "a folder that is not there is said before the work, and a page that cannot be written leaves none") {
  const std::string arguments =
      "eval " + report().model() + " " + report().scratch.path.string() + " --report ";
  CHECK(std::system(("\"" FOCAL_COMMAND "\" " + arguments + (report().scratch / "nowhere/x.html") + " 2> " +
                     (report().scratch / "said"))
                        .c_str()) != 0);
  CHECK(focal_cli::read_text_file(report().scratch / "said").find("no folder") != std::string::npos);
}

TEST_CASE("three.js turns the meshes where it was bundled, quietly and without the network") {
  if (!browser()) return;
  if (focal_cli::report_three_text.empty()) {
    std::cout << "skipped: no three.js was bundled into this build\n";
    return;
  }
  open(*browser(), "three.js");
  check_surface_and_keys(*browser());
  check_quiet(*browser());
}

TEST_CASE("the page's own renderer does the same") {
  if (!browser()) return;
  open(*browser(), "canvas");
  check_surface_and_keys(*browser());
  check_quiet(*browser());
}

TEST_CASE("the page says what the JSON says") {
  if (!browser()) return;
  Browser& page = *browser();
  open(page, "canvas");
  const json& measured = report().measured;
  CHECK(page.evaluate("document.querySelector('h1').textContent") ==
        "eggs </script><b>\"x\": 3 meshes, 11 marks");
  char mean[32];
  std::snprintf(mean, sizeof mean, "%.2f", measured["mean_edges"].get<double>());
  CHECK(page.evaluate("document.querySelector('#figures dd').textContent") == mean);
  CHECK(page.evaluate("document.querySelectorAll('#meshes tbody tr').length") == 3);
  CHECK(page.evaluate("document.querySelectorAll('#landmarks tbody tr').length") == 4);
  CHECK(page.evaluate("document.querySelectorAll('#errors tbody td').length") == 12);
  CHECK(
      page.evaluate(
          "[...document.querySelectorAll('#errors tbody td')].filter((c) => c.textContent === '–').length") ==
      1);
  CHECK(page.evaluate("document.querySelectorAll('#calibration circle').length >= 1") == true);
  CHECK(page.evaluate("document.querySelectorAll('#cumulative path').length") ==
        6);  // four, all, the chosen one
  std::vector<double> means;
  for (const json& mesh : page.evaluate(
           "[...document.querySelectorAll('#meshes tbody tr')].map((r) => r.cells[1].textContent)")) {
    means.push_back(std::stod(mesh.get<std::string>()));
  }
  CHECK(std::is_sorted(means.rbegin(), means.rend()));  // worst first
}

TEST_CASE("the grid of errors is walked by arrow keys, Enter shows the cell; columns sort") {
  if (!browser()) return;
  Browser& page = *browser();
  open(page, "canvas");
  page.evaluate("document.querySelector('#errors td').focus()");
  page.press("ArrowRight");
  page.press("ArrowDown");
  page.press("Enter");
  CHECK(page.evaluate("document.getElementById('mesh').value") == "1");
  CHECK(page.evaluate("document.getElementById('landmark').value") ==
        page.evaluate("document.querySelectorAll('#errors thead th')[2].textContent"));
  CHECK(page.evaluate("document.activeElement.id") == "viewer");
  page.evaluate("document.querySelectorAll('#landmarks thead button')[0].click()");
  CHECK(page.evaluate("document.querySelector('#landmarks tbody th').textContent") == "horn.L");
  CHECK(page.evaluate("document.querySelector('#landmarks thead th').getAttribute('aria-sort')") ==
        "ascending");
}

TEST_CASE("nothing runs out of a narrow window; every control has a name; pictures are kept to look at") {
  if (!browser()) return;
  Browser& page = *browser();
  open(page, focal_cli::report_three_text.empty() ? "canvas" : "three.js");
  page.save_picture(FOCAL_PICTURES "/report-light.png");
  page.dark(true);
  page.save_picture(FOCAL_PICTURES "/report-dark.png");
  page.dark(false);
  page.size(390, 844);
  CHECK(page.evaluate("document.documentElement.scrollWidth <= 390") == true);
  page.save_picture(FOCAL_PICTURES "/report-narrow.png");
  CHECK(
      page.evaluate(R"([...document.querySelectorAll("button, select, input, canvas[tabindex]")].filter((e) =>
    !(e.textContent.trim() || e.getAttribute("aria-label") || e.closest("label"))).length)") == 0);
  CHECK(page.evaluate("document.querySelectorAll('[id]').length === new "
                      "Set([...document.querySelectorAll('[id]')].map((e) => e.id)).size") == true);
}
