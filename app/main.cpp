// `sfumato`: the command line to options, and errors to one line and an exit code.
#include <fcntl.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <exception>
#include <memory>
#include <new>

#include "app/options.h"
#include "app/validators.h"
#include "base/error.h"
#include "base/log.h"
#include "base/version.h"
#include "pipelines/quality.h"

namespace {

using namespace sfumato;
using base::ExitCode;

// Help that names what an option takes, and nothing else; ranges and defaults stand in the sentences.
class Help : public CLI::Formatter {
 public:
  explicit Help(std::string usage) : usage_(std::move(usage)) {
    label("Positionals", "Scene");
    column_width(28);
  }
  std::string make_usage(const CLI::App*, std::string name) const override {
    return "Usage: " + name + " " + usage_ + "\n";
  }
  std::string make_help(const CLI::App* app, std::string name, CLI::AppFormatMode mode) const override {
    return CLI::detail::find_and_replace(CLI::Formatter::make_help(app, name, mode), "\n\n\n", "\n\n");
  }
  std::string make_option_opts(const CLI::Option* option) const override {
    return option->get_type_size() == 0 || option->get_positional() ? "" : " " + option->get_type_name();
  }

 private:
  std::string usage_;
};

struct Verbosity {
  bool verbose = false;
  bool quiet = false;
};

// The flags of the program and of every command. They are added last, and stand last in the help.
void addFlags(CLI::App& command, Verbosity& verbosity) {
  command.add_flag("-v,--verbose", verbosity.verbose, "Say more")->group("General");
  command.add_flag("-q,--quiet", verbosity.quiet, "Say only what is wrong")->group("General");
  command.set_help_flag();
  command.set_help_flag("-h,--help", "Show this and exit")->group("General");
}

void addCommon(CLI::App& command, app::CommonOptions& options, Verbosity& verbosity) {
  command
      .add_option("--device", options.device,
                  "GL device: a number or part of a name in `sfumato info`, or `software`")
      ->type_name("DEVICE")
      ->group("General");
  command
      .add_option("--shader-dir", options.shaderDir,
                  "Shader files here stand in for the built-in ones of the same name")
      ->type_name("FOLDER")
      ->group("General")
      ->check(app::folder());
  addFlags(command, verbosity);
}

struct RenderText {
  std::string resolution;
  std::vector<double> from;
  std::vector<double> at;
  std::vector<double> albedo;
};

void addSmoke(CLI::App& command, app::RenderOptions& options, RenderText& text) {
  const auto add = [&](const char* name, auto& value, const char* help) {
    return command.add_option(name, value, help)->group("Smoke");
  };
  add("--volume", options.volumes, "Add this OpenVDB smoke to the scene; may be given again")
      ->type_name("FILE.vdb")
      ->check(app::fileName())
      ->allow_extra_args(false);
  add("--grid", options.grid, "The grid to take from it; else \"density\", or the only one")
      ->type_name("NAME");
  add("--volume-scale", options.volumeScale, "Its extinction per unit of density, 1/m: 0 to 1e9, else 1")
      ->type_name("SCALE")
      ->check(app::between(0.0, 1e9));
  add("--volume-albedo", text.albedo, "Its scattering albedo: each 0 to 1, else 0.9")
      ->type_name("R G B")
      ->expected(3)
      ->check(app::between(0.0, 1.0));
  add("--volume-g", options.volumeG, "Its Henyey-Greenstein g: -0.99 to 0.99, else 0")
      ->type_name("G")
      ->check(app::between(-0.99, 0.99));
}

void addView(CLI::App& command, app::RenderOptions& options, RenderText& text) {
  const auto add = [&](const char* name, auto& value, const char* help) {
    return command.add_option(name, value, help)->group("View");
  };
  add("--res", text.resolution, "Image size: 1 to 16384 pixels a side, else 1280x720")
      ->type_name("WxH")
      ->check(app::resolution());
  add("--camera", options.camera, "Camera of the scene; else its first, or one that sees everything")
      ->type_name("NAME");
  add("--look-from", text.from, "Stand here: metres")
      ->type_name("X Y Z")
      ->expected(3)
      ->check(app::coordinate());
  add("--look-at", text.at, "Look at this point: metres")
      ->type_name("X Y Z")
      ->expected(3)
      ->check(app::coordinate());
  add("--fov", options.fovDegrees, "Vertical field of view: 0.1 to 170")
      ->type_name("DEGREES")
      ->check(app::between(0.1, 170.0));
}

void addQuality(CLI::App& command, app::RenderOptions& options) {
  const auto add = [&](const char* name, auto& value, const char* help) {
    return command.add_option(name, value, help)->group("Quality");
  };
  add("--quality", options.quality, "draft, medium, high or reference; else medium")
      ->type_name("NAME")
      ->check(app::oneOf(pipelines::qualityNames()));
  add("--step", options.stepVoxels, "March through smoke in such steps: 0.01 to 100, else by --quality")
      ->type_name("VOXELS")
      ->check(app::between(0.01, 100.0));
  add("--shadow-res", options.shadowResolution,
      "Texels a side of a deep shadow map: 32 to 16384, else by --quality")
      ->type_name("TEXELS")
      ->check(app::wholeBetween(32, 16384));
}

void addOutput(CLI::App& command, app::RenderOptions& options) {
  const auto add = [&](const char* name, auto& value, const char* help) {
    return command.add_option(name, value, help)->group("Output");
  };
  add("-o,--output", options.outputs,
      "Image to write: .exr linear, .png tone-mapped sRGB; may be given again")
      ->type_name("FILE")
      ->check(app::fileName())
      ->allow_extra_args(false);
  add("--exposure", options.exposureStops, "Brighten the .png: -30 to 30, else 0")
      ->type_name("STOPS")
      ->check(app::between(-30.0, 30.0));
  add("--stats", options.statistics, "Write times, bytes and list figures as JSON")
      ->type_name("FILE.json")
      ->check(app::fileName());
  add("--repeat", options.repeat, "Draw so often, for the times: 1 to 1000, else 1; the last is written")
      ->type_name("TIMES")
      ->check(app::wholeBetween(1, 1000));
  command
      .add_flag("-n,--dry-run", options.dryRun, "Read all files, print the plan, write nothing; needs no GL")
      ->group("Output");
}

void addRender(CLI::App& command, app::RenderOptions& options, RenderText& text) {
  command.formatter(std::make_shared<Help>("SCENE -o FILE [OPTIONS]"));
  command.add_option("SCENE", options.scene, ".gltf or .glb; its nodes may name smoke (extras \"volume\")")
      ->check(app::fileName());
  addSmoke(command, options, text);
  addView(command, options, text);
  addQuality(command, options);
  addOutput(command, options);
}

glm::dvec3 vectorOf(const std::vector<double>& values) {
  return {values[0], values[1], values[2]};
}

void finishRender(app::RenderOptions& options, const RenderText& text) {
  if (const auto resolution = app::parseResolution(text.resolution)) {
    options.width = resolution->width;
    options.height = resolution->height;
  }
  if (!text.from.empty()) options.lookFrom = vectorOf(text.from);
  if (!text.at.empty()) options.lookAt = vectorOf(text.at);
  if (!text.albedo.empty()) options.volumeAlbedo = vectorOf(text.albedo);
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
  for (const CLI::App* command : program.get_subcommands())
    if (const CLI::Option* option = command->get_option_no_throw(name))
      return name + ": takes " + option->get_type_name() + (option->get_expected_max() > 3 ? "" : ", once");
  return what;
}

[[noreturn]] void failUsage(const CLI::App& program, const std::string& what) {
  const std::vector<CLI::App*> commands = program.get_subcommands();
  base::fail(ExitCode::Usage, "{}: see `sfumato {}--help`", what,
             commands.empty() ? "" : commands.front()->get_name() + " ");
}

int run(int argc, char** argv) {
  CLI::App program("Lights and shadows smoke and glass through per-pixel linked lists, without a window.",
                   "sfumato");
  program.formatter(std::make_shared<Help>("COMMAND [OPTIONS]"));
  program.set_version_flag("--version", std::string("sfumato ") + base::version(), "Show it and exit")
      ->group("General");
  program.require_subcommand(0, 1);  // that there is one is checked after what is unknown
  Verbosity verbosity;
  addFlags(program, verbosity);

  app::RenderOptions renderOptions;
  RenderText renderText;
  CLI::App& renderCommand = *program.add_subcommand("render", "Render a scene with smoke into images");
  renderCommand.group("Commands");
  addRender(renderCommand, renderOptions, renderText);
  addCommon(renderCommand, renderOptions.common, verbosity);

  app::InfoOptions infoOptions;
  CLI::App& infoCommand =
      *program.add_subcommand("info", "Show the GL devices, the one in use, and what its limits mean");
  infoCommand.group("Commands");
  infoCommand.formatter(std::make_shared<Help>("[OPTIONS]"));
  infoCommand.add_flag("--json", infoOptions.json, "As JSON")->group("General");
  addCommon(infoCommand, infoOptions.common, verbosity);

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
  if (renderCommand.parsed()) {
    finishRender(renderOptions, renderText);
    return app::render(renderOptions);
  }
  if (infoCommand.parsed()) return app::info(infoOptions);
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
