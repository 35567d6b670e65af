// The `focal` command: a client of focal.h like any other.
#include "command.h"

#include <CLI/CLI.hpp>
#include <exception>
#include <iostream>

#include "command_error.h"
#include "options.h"

namespace focal_cli {
namespace {

int run(int argc, char** argv) {
  CLI::App app("Rig characters, and find landmarks learned from about ten marked meshes.", "focal");
  app.set_version_flag("--version", std::string("focal ") + focal_version_string());
  app.failure_message(CLI::FailureMessage::simple);
  app.allow_windows_style_options(false);  // a path that starts with a slash is a path on every platform
  app.require_subcommand(1);
  for (const auto add : {add_train, add_detect, add_rig, add_segment, add_correspond, add_batch, add_eval,
                         add_cross_validate, add_info, add_convert, add_models, add_doctor}) {
    add(app);
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  std::cout.flush();
  if (!std::cout) throw CommandError("standard output could not be written", "is the disk full?");
  return 0;
}

}  // namespace

int run_command(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const CommandError& error) {
    std::cerr << "focal: " << error.what() << "\n";
    if (!error.hint.empty()) std::cerr << "hint: " << error.hint << "\n";
  } catch (const std::exception& error) {
    std::cerr << "focal: " << error.what() << "\n";
  }
  return 1;
}

}  // namespace focal_cli
