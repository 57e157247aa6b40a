// `sfumato`: the command line to options, and errors to one line and an exit code.
#include <fcntl.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <exception>
#include <new>
#include <string>
#include <vector>

#include "app/commands.h"
#include "app/options.h"
#include "base/error.h"
#include "base/log.h"

namespace {

using namespace sfumato;
using base::ExitCode;

// The command that was named, and of it the one within it.
std::vector<const CLI::App*> commandsOf(const CLI::App& program) {
  std::vector<const CLI::App*> commands;
  for (const CLI::App* command = &program; !command->get_subcommands().empty();)
    commands.push_back(command = command->get_subcommands().front());
  return commands;
}

// CLI11 words its other messages as ours, these two not: the argument, what is wrong.
std::string describe(const CLI::ExtrasError&, const CLI::App& program) {
  const std::string argument = program.remaining(true).front();
  if (argument.starts_with('-')) return argument + ": no such option";
  return argument + (program.get_subcommands().empty() ? ": no such command" : ": is one argument too many");
}

std::string describe(const CLI::ArgumentMismatch& error, const CLI::App& program) {
  const std::string what = error.what();
  const std::string name = what.substr(0, what.find(':'));
  for (const CLI::App* command : commandsOf(program))
    if (const CLI::Option* option = command->get_option_no_throw(name))
      return name + ": takes " + option->get_type_name() + (option->get_expected_max() > 3 ? "" : ", once");
  return what;
}

[[noreturn]] void failUsage(const CLI::App& program, const std::string& what) {
  std::string names;
  for (const CLI::App* command : commandsOf(program)) names += command->get_name() + " ";
  base::fail(ExitCode::Usage, "{}: see `sfumato {}--help`", what, names);
}

// The command line in one line, as a shell would take it again.
std::string quoted(int argc, char** argv) {
  std::string line = "sfumato";
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    const bool plain =
        !argument.empty() &&
        argument.find_first_not_of(
            "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-+_./,:=@%") == std::string::npos;
    line += " " + (plain ? argument : "'" + CLI::detail::find_and_replace(argument, "'", "'\\''") + "'");
  }
  return line;
}

int run(int argc, char** argv) {
  CLI::App program("Lights and shadows smoke and glass through per-pixel linked lists, without a window.",
                   "sfumato");
  app::Verbosity verbosity;
  app::addProgram(program, verbosity);
  app::RenderOptions renderOptions{.commandLine = quoted(argc, argv)};
  const CLI::App& renderCommand = app::addRender(program, renderOptions, verbosity);
  app::CompareOptions compareOptions{.commandLine = renderOptions.commandLine};
  const CLI::App& compareCommand = app::addCompare(program, compareOptions, verbosity);
  app::StressOptions stressOptions;
  stressOptions.shot.commandLine = renderOptions.commandLine;
  const CLI::App& stressCommand = app::addStress(program, stressOptions, verbosity);
  app::BenchOptions benchOptions;
  benchOptions.shot.commandLine = renderOptions.commandLine;
  app::PapersOptions papersOptions{.commandLine = renderOptions.commandLine};
  const app::BenchCommands benchCommands = app::addBench(program, benchOptions, papersOptions, verbosity);
  app::InfoOptions infoOptions;
  const CLI::App& infoCommand = app::addInfo(program, infoOptions, verbosity);
  app::ValidateOptions validateOptions;
  const CLI::App& validateCommand = app::addValidate(program, validateOptions, verbosity);

  try {
    program.parse(argc, argv);
  } catch (const CLI::ExtrasError& error) {
    failUsage(program, describe(error, program));
  } catch (const CLI::ArgumentMismatch& error) {
    failUsage(program, describe(error, program));
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return program.exit(error);  // --help, --version
    failUsage(program, error.what());
  }
  base::setVerbosity(verbosity.quiet     ? base::Verbosity::Quiet
                     : verbosity.verbose ? base::Verbosity::Verbose
                                         : base::Verbosity::Normal);
  if (renderCommand.parsed()) return app::render(renderOptions);
  if (compareCommand.parsed()) return app::compare(compareOptions);
  if (stressCommand.parsed()) return app::stress(stressOptions);
  if (benchCommands.pipelines.parsed()) return app::bench(benchOptions);
  if (benchCommands.papers.parsed()) return app::benchPapers(papersOptions);
  if (benchCommands.bench.parsed()) failUsage(program, "bench: compares what: name pipelines or papers");
  if (infoCommand.parsed()) return app::info(infoOptions);
  if (validateCommand.parsed()) return app::validate(validateOptions);
  failUsage(program, "no command");
}

// A file opened later would take the number of a closed standard stream, and our lines would go into it. What
// stands in refuses them.
void occupyStandardStreams() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (fcntl(stream, F_GETFD) == -1) open("/dev/null", stream == STDIN_FILENO ? O_WRONLY : O_RDONLY);
}

}  // namespace

int main(int argc, char** argv) {
  occupyStandardStreams();
  try {
    const int exitCode = run(argc, argv);
    base::flushResults();
    return exitCode;
  } catch (const base::Error& error) {
    base::logError(error.what());
    return static_cast<int>(error.exitCode);
  } catch (const std::bad_alloc&) {
    base::logError("out of memory: use a smaller image or a smaller volume");
    return static_cast<int>(ExitCode::Memory);
  } catch (const std::exception& error) {
    base::logError(std::string("unexpected: ") + error.what() + ": please report it");
    return static_cast<int>(ExitCode::Bug);
  }
}
