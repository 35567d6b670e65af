#include "command.h"

int main(int argc, char** argv) { return focal_cli::run_command(argc, argv); }
