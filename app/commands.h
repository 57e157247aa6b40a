// The command line of each subcommand: its options, their help, and where their values go.
#pragma once

#include <CLI/CLI.hpp>

#include "app/options.h"

namespace sfumato::app {

struct Verbosity {
  bool verbose = false;
  bool quiet = false;
};

// What stands before any subcommand. The arguments of all functions here must outlive the parsing.
void addProgram(CLI::App& program, Verbosity& verbosity);

CLI::App& addRender(CLI::App& program, RenderOptions& options, Verbosity& verbosity);
CLI::App& addCompare(CLI::App& program, CompareOptions& options, Verbosity& verbosity);
CLI::App& addStress(CLI::App& program, StressOptions& options, Verbosity& verbosity);
// The command of a kind of comparison each, of a command that has no options of its own.
struct BenchCommands {
  CLI::App& bench;
  CLI::App& pipelines;
  CLI::App& papers;
};
BenchCommands addBench(CLI::App& program, BenchOptions& options, PapersOptions& papers, Verbosity& verbosity);
CLI::App& addInfo(CLI::App& program, InfoOptions& options, Verbosity& verbosity);
CLI::App& addValidate(CLI::App& program, ValidateOptions& options, Verbosity& verbosity);

}  // namespace sfumato::app
