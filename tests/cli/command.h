// The built command, run as a user would.
#pragma once
#include <doctest/doctest.h>
#include <sys/wait.h>

#include <cstdio>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "files.h"
#include "scratch_folder.h"

using nlohmann::json;
using Keys = std::set<std::string>;

struct Run {
  int status = -1;
  std::string out, err;
};

// before: a program that runs the command, such as timeout.
inline Run focal(const std::string& arguments, const std::string& before = "") {
  const ScratchFolder scratch;
  const std::string line =
      before + " \"" FOCAL_COMMAND "\" " + arguments + " 2> '" + (scratch / "stderr") + "'";
  std::FILE* pipe = ::popen(line.c_str(), "r");
  REQUIRE(pipe);
  Run run;
  char block[4096];
  for (size_t size; (size = std::fread(block, 1, sizeof block, pipe)) > 0;) run.out.append(block, size);
  const int status = ::pclose(pipe);
  run.status = WIFEXITED(status) ? WEXITSTATUS(status) : 128;
  run.err = focal_cli::read_text_file(scratch / "stderr");
  return run;
}

inline Keys keys_of(const json& object) {
  Keys keys;
  for (const auto& [key, value] : object.items()) keys.insert(key);
  return keys;
}

// Runs with --json: done, one document on stdout, nothing on stderr.
inline json focal_json(const std::string& arguments) {
  const Run run = focal(arguments + " --json");
  CAPTURE(arguments);
  CAPTURE(run.err);
  REQUIRE(run.status == 0);
  CHECK(run.err.empty());
  return json::parse(run.out);
}

// Fails with status 1, says `words` and a hint on stderr and nothing on stdout.
inline void check_fails(const std::string& arguments, const std::string& words) {
  const Run run = focal(arguments);
  CAPTURE(arguments);
  CAPTURE(run.err);
  CHECK(run.status == 1);
  CHECK(run.out.empty());
  CHECK(run.err.starts_with("focal: "));
  CHECK(run.err.find(words) != std::string::npos);
  CHECK(run.err.find("\nhint: ") != std::string::npos);
}
