// The options that every verb has.
#include "options.h"

#include <iostream>
#include <map>

namespace focal_cli {

void add_common_options(CLI::App& verb, CommonOptions& options) {
  static const std::map<std::string, focal_backend> backends = {
      {"auto", FOCAL_BACKEND_AUTO}, {"cpu", FOCAL_BACKEND_CPU}, {"cuda", FOCAL_BACKEND_CUDA}};
  constexpr const char* group = "Common";
  verb.add_flag("--json", options.json, "Print one JSON document on stdout, nothing else")->group(group);
  verb.add_flag("--quiet", options.quiet, "Print nothing but errors (and the JSON, if asked for)")
      ->group(group);
  verb.add_option("--threads", options.threads, "Threads to use; 0: one a core")
      ->type_name("N")
      ->check(CLI::Range(0, 1024))
      ->group(group);
  verb.add_option("--backend", options.backend, "Where to compute")
      ->type_name("auto|cpu|cuda")
      ->transform(CLI::Transformer(backends, CLI::ignore_case).description(""))
      ->check(CLI::IsMember(std::set<focal_backend>{0, 1, 2}).description(""))
      ->group(group);
  verb.add_option("--seed", options.seed, "Of all random choices: same seed, same result")
      ->type_name("N")
      ->group(group);
}

Context make_context(const CommonOptions& options) {
  auto params = initialised(focal_context_params_init);
  params.backend = options.backend;
  params.thread_count = options.threads;
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
