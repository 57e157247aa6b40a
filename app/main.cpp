#include <CLI/CLI.hpp>
#include <cmath>
#include <exception>
#include <new>

#include "app/options.h"
#include "base/error.h"
#include "base/log.h"
#include "base/version.h"
#include "pipelines/quality.h"

namespace {

using namespace sfumato;
using base::ExitCode;

// "640x480" to two integers; CLI11 reports the text that is returned when it is not that.
CLI::Validator resolutionValidator() {
  const auto check = [](const std::string& text) -> std::string {
    int width = 0;
    int height = 0;
    int used = 0;
    const bool parsed = std::sscanf(text.c_str(), "%6dx%6d%n", &width, &height, &used) == 2;
    const bool whole = parsed && static_cast<size_t>(used) == text.size();
    if (!whole || width < 1 || height < 1 || width > 16384 || height > 16384)
      return "\"" + text + "\" is not WIDTHxHEIGHT with 1 to 16384 pixels a side, e.g. 1280x720";
    return {};
  };
  return CLI::Validator(check, "WxH");
}

CLI::Validator finiteVector() {
  return CLI::Validator(
      [](const std::string& text) -> std::string {
        char* end = nullptr;
        const double value = std::strtod(text.c_str(), &end);
        return end == text.c_str() || *end != 0 || !std::isfinite(value)
                   ? "\"" + text + "\" is not a finite number"
                   : std::string();
      },
      "NUMBER");
}

void addCommon(CLI::App& command, app::CommonOptions& options) {
  command.add_option("--device", options.device,
                     "GL device: a number or part of a name as `sfumato info` lists them, or `software`");
  command
      .add_option("--shader-dir", options.shaderDir,
                  "Shader files here stand in for the built-in ones of the same name")
      ->check(CLI::ExistingDirectory);
}

struct RenderText {
  std::string resolution;
  std::vector<double> from;
  std::vector<double> at;
  std::vector<double> albedo;
};

void addRender(CLI::App& command, app::RenderOptions& options, RenderText& text) {
  command.add_option("scene", options.scene, "Scene to render: .gltf or .glb")->type_name("SCENE");
  command
      .add_option("--time", options.timeSeconds,
                  "Pose the scene as its animations have it at this time, seconds; at rest otherwise")
      ->type_name("SECONDS")
      ->check(finiteVector());
  command.add_option("--volume", options.volumes, "OpenVDB smoke to add to the scene; may be given again")
      ->type_name("SMOKE.vdb")
      ->allow_extra_args(false);
  command.add_option("--grid", options.grid, "Grid to take from the volumes given by --volume");
  command.add_option("--volume-scale", options.volumeScale, "Their extinction per unit of density, 1/m")
      ->check(CLI::Range(0.0, 1e9));
  command.add_option("--volume-albedo", text.albedo, "Their scattering albedo, R G B in [0, 1]")
      ->expected(3)
      ->check(CLI::Range(0.0, 1.0));
  command.add_option("--volume-g", options.volumeG, "Their Henyey-Greenstein g, in (-1, 1)")
      ->check(CLI::Range(-0.99, 0.99));
  command
      .add_option("-o,--output", options.outputs,
                  "Image to write: .exr linear, .png tone-mapped sRGB; may be given again")
      ->required()
      ->allow_extra_args(false)
      ->type_name("OUT");
  command.add_option("--res", text.resolution, "Image size, e.g. 1280x720")
      ->check(resolutionValidator())
      ->type_name("");
  command.add_option("--camera", options.camera, "Camera of the scene, by name; the first one otherwise");
  command.add_option("--look-from", text.from, "Stand here: X Y Z in metres")
      ->expected(3)
      ->check(finiteVector());
  command.add_option("--look-at", text.at, "Look at this point: X Y Z in metres")
      ->expected(3)
      ->check(finiteVector());
  command.add_option("--fov", options.fovDegrees, "Vertical field of view, degrees")
      ->check(CLI::Range(0.1, 170.0));
  command
      .add_option("--quality", options.quality,
                  "draft, medium, high or reference: sets the step, the shadow maps and their error bound")
      ->check(CLI::IsMember(pipelines::qualityNames()))
      ->capture_default_str();
  command.add_option("--step", options.stepVoxels, "Step of the march through smoke, in voxels")
      ->check(CLI::Range(0.01, 100.0));
  command.add_option("--shadow-res", options.shadowResolution, "Texels a side of a deep shadow map")
      ->check(CLI::Range(32, 16384));
  command.add_option("--exposure", options.exposureStops, "Stops to brighten the .png by")
      ->check(CLI::Range(-30.0, 30.0));
  command.add_option("--stats", options.statistics, "Write times, bytes and list figures as JSON")
      ->type_name("OUT.json");
  command
      .add_option("--repeat", options.repeat,
                  "Draw the frame this often, for its times; the last one is written")
      ->check(CLI::Range(1, 1000));
  command.add_flag("-n,--dry-run", options.dryRun, "Print what would be done");
}

glm::dvec3 vectorOf(const std::vector<double>& values) {
  return {values[0], values[1], values[2]};
}

void finishRender(app::RenderOptions& options, const RenderText& text) {
  if (!text.resolution.empty())
    std::sscanf(text.resolution.c_str(), "%dx%d", &options.width, &options.height);
  if (!text.from.empty()) options.lookFrom = vectorOf(text.from);
  if (!text.at.empty()) options.lookAt = vectorOf(text.at);
  if (!text.albedo.empty()) options.volumeAlbedo = vectorOf(text.albedo);
}

// One line, whatever CLI11 says.
int usageError(const CLI::ParseError& error) {
  std::string line = error.what();
  std::replace(line.begin(), line.end(), '\n', ' ');
  base::logError(line + ": see `sfumato --help`");
  return static_cast<int>(ExitCode::Usage);
}

int run(int argc, char** argv) {
  CLI::App program("Lights and shadows smoke and glass through per-pixel linked lists, without a window.",
                   "sfumato");
  program.set_version_flag("--version", std::string("sfumato ") + base::version());
  program.require_subcommand(1);
  bool verbose = false;
  bool quiet = false;
  const auto addVerbosity = [&](CLI::App& command) {
    command.add_flag("-v,--verbose", verbose, "Say more");
    command.add_flag("-q,--quiet", quiet, "Say only what is wrong");
  };

  app::RenderOptions renderOptions;
  RenderText renderText;
  CLI::App& renderCommand = *program.add_subcommand("render", "Render a scene with smoke into images");
  addRender(renderCommand, renderOptions, renderText);
  addCommon(renderCommand, renderOptions.common);
  addVerbosity(renderCommand);

  app::InfoOptions infoOptions;
  CLI::App& infoCommand =
      *program.add_subcommand("info", "Show the GL devices, the one in use, and what its limits mean");
  infoCommand.add_flag("--json", infoOptions.json, "As JSON");
  addCommon(infoCommand, infoOptions.common);
  addVerbosity(infoCommand);

  try {
    program.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return program.exit(error);  // --help, --version
    return usageError(error);
  }
  base::setVerbosity(quiet     ? base::Verbosity::Quiet
                     : verbose ? base::Verbosity::Verbose
                               : base::Verbosity::Normal);
  if (renderCommand.parsed()) {
    finishRender(renderOptions, renderText);
    return app::render(renderOptions);
  }
  return app::info(infoOptions);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
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
