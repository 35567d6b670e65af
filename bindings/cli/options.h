// The options that every verb has.
#pragma once
#include <CLI/CLI.hpp>
#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "handles.h"

namespace focal_cli {

// How meshes are read.
struct MeshOptions {
  bool lenient = false;
  focal_surface surface = FOCAL_SURFACE_AUTO;
  bool keep_scenery = false;
};

struct CommonOptions : MeshOptions {
  bool json = false;
  bool quiet = false;
  int32_t threads = 0;
  uint64_t memory_budget = 0;  // bytes; 0: none
  focal_backend backend = FOCAL_BACKEND_AUTO;
  std::optional<uint64_t> seed;

  bool prints_text() const { return !json && !quiet; }
};

// An option of a few words, each standing for a number of focal.h.
void add_choice(CLI::App& verb, const std::string& name, int32_t& value, const std::string& help,
                const std::string& words, const std::map<std::string, int32_t>& choices);

// For the verbs that read meshes: --lenient, and with add_mesh_options also --surface and --keep-scenery.
void add_lenient_option(CLI::App& verb, MeshOptions& options);
void add_mesh_options(CLI::App& verb, MeshOptions& options);
// makes_choices: random ones, so that --seed means something.
void add_common_options(CLI::App& verb, CommonOptions& options, bool makes_choices = true);

// Says on stderr when the backend that was asked for could not be had.
Context make_context(const CommonOptions& options);

const char* backend_name(focal_backend backend);
const char* preset_name(focal_preset preset);

// The verbs, each in its own file; each adds its subcommand, which runs as the command line is parsed.
void add_train(CLI::App& app);
void add_detect(CLI::App& app);
void add_rig(CLI::App& app);
void add_segment(CLI::App& app);
void add_correspond(CLI::App& app);
void add_batch(CLI::App& app);
void add_eval(CLI::App& app);
void add_cross_validate(CLI::App& app);
void add_info(CLI::App& app);
void add_convert(CLI::App& app);
void add_doctor(CLI::App& app);
void add_models(CLI::App& app);

}  // namespace focal_cli
