// hagfish: runs scenes and reads their logs.

#include "experiments/program/run_program.hpp"

int main(int argc, char** argv) { return hagfish::run_program(argc, argv); }
