// The program as a function.
#pragma once

namespace hagfish {

/// Runs the command that the arguments of a command line name, and says what went wrong. Returns
/// the exit code, 2 for bad input.
int run_program(int argc, char** argv);

}  // namespace hagfish
