// The `focal` command behind main().
#pragma once

namespace focal_cli {

// The arguments are UTF-8. Returns the exit status: 0 done, 1 the work failed, 2 usage.
int run_command(int argc, char** argv);

}  // namespace focal_cli
