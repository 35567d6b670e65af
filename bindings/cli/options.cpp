// The options that every verb has.
#include "options.h"

#include <iostream>

namespace focal_cli {

void add_choice(CLI::App& verb, const std::string& name, int32_t& value, const std::string& help,
                const std::string& words, const std::map<std::string, int32_t>& choices) {
  const auto number_of_word = [choices, words](std::string& word) {
    const auto choice = choices.find(word);
    if (choice == choices.end()) return "'" + word + "' is not one of " + words;
    word = std::to_string(choice->second);
    return std::string();
  };
  verb.add_option(name, value, help)->type_name(words)->transform(CLI::Validator(number_of_word, ""));
}

void add_lenient_option(CLI::App& verb, MeshOptions& options) {
  verb.add_flag("--lenient", options.lenient,
                "Leave out triangles with NaN or infinite positions or indices out of range, instead of "
                "refusing the mesh");
}

void add_mesh_options(CLI::App& verb, MeshOptions& options) {
  add_lenient_option(verb, options);
  add_choice(
      verb, "--surface", options.surface,
      "What to analyse: the mesh as it is, or one closed surface around all of its parts; auto: wrapped if "
      "it "
      "has several parts",
      "auto|as-is|wrapped",
      {{"auto", FOCAL_SURFACE_AUTO}, {"as-is", FOCAL_SURFACE_AS_IS}, {"wrapped", FOCAL_SURFACE_WRAPPED}});
  verb.add_flag(
      "--keep-scenery", options.keep_scenery,
      "Also analyse hidden nodes, a ground, a backdrop, an enclosing shape and parts that stand apart, "
      "which are left out by default");
}

void add_common_options(CLI::App& verb, CommonOptions& options, bool makes_choices) {
  // The parser alone would turn -3 into a large seed without a word.
  const auto unsigned_only = [](std::string& text) {
    return text.starts_with('-') ? "'" + text + "' is negative" : std::string();
  };
  verb.add_flag("--json", options.json, "Print only one JSON document on stdout")->group("Common");
  verb.add_flag("--quiet", options.quiet, "Print only errors (and the JSON, with --json)")->group("Common");
  verb.add_option("--threads", options.threads, "Threads to use; 0: one per core")
      ->type_name("N")
      ->check(CLI::Range(0, 1024).description(""))
      ->group("Common");
  verb.add_option("--memory-budget", options.memory_budget,
                  "Fail instead of holding more memory than this, such as 500MB or 2GB; 0: no limit")
      ->type_name("SIZE")
      ->transform(CLI::AsSizeValue(false).description(""))
      ->group("Common");
  add_choice(verb, "--backend", options.backend, "Where to compute", "auto|cpu|cuda",
             {{"auto", FOCAL_BACKEND_AUTO}, {"cpu", FOCAL_BACKEND_CPU}, {"cuda", FOCAL_BACKEND_CUDA}});
  verb.get_option("--backend")->group("Common");
  if (!makes_choices) return;
  verb.add_option("--seed", options.seed, "Seed of all random choices; the same seed gives the same result")
      ->type_name("N")
      ->check(CLI::Validator(unsigned_only, ""))
      ->group("Common");
}

Context make_context(const CommonOptions& options) {
  auto params = initialised(focal_context_params_init);
  params.backend = options.backend;
  params.thread_count = options.threads;
  params.memory_budget_bytes = options.memory_budget;
  Context context = owned<Context>(focal_context_create, &params);
  const focal_backend used = focal_context_backend(context.get());
  if (options.backend != FOCAL_BACKEND_AUTO && used != options.backend && !options.quiet) {
    std::cerr << "note: using " << backend_name(used) << ": " << focal_context_backend_reason(context.get())
              << "\n";
  }
  return context;
}

const char* backend_name(focal_backend backend) { return backend == FOCAL_BACKEND_CUDA ? "cuda" : "cpu"; }
const char* preset_name(focal_preset preset) { return preset == FOCAL_PRESET_PAPER ? "paper" : "default"; }

}  // namespace focal_cli
