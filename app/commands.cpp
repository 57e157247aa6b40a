#include "app/commands.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <limits>
#include <memory>

#include "app/effects.h"
#include "app/validators.h"
#include "base/version.h"
#include "image/tone_map.h"
#include "lists/strategy.h"
#include "lists/stress/load.h"
#include "pipelines/aovs.h"
#include "pipelines/pipeline_names.h"
#include "pipelines/post.h"
#include "pipelines/quality.h"

namespace sfumato::app {
namespace {

// Help that names what an option takes, and nothing else; ranges and defaults stand in the sentences.
class Help : public CLI::Formatter {
 public:
  explicit Help(std::string usage) : usage_(std::move(usage)) {
    label("Positionals", "Input");
    column_width(28);
  }
  std::string make_usage(const CLI::App*, std::string name) const override {
    return "Usage: " + name + " " + usage_ + "\n";
  }
  std::string make_help(const CLI::App* app, std::string name, CLI::AppFormatMode mode) const override {
    return CLI::detail::find_and_replace(CLI::Formatter::make_help(app, name, mode), "\n\n\n", "\n\n");
  }
  // A flag that may take a number is added as --name{what it is alone}.
  std::string make_option_name(const CLI::Option* option, bool isPositional) const override {
    std::string name = CLI::Formatter::make_option_name(option, isPositional);
    const size_t brace = name.find('{');
    return brace == std::string::npos ? name : name.substr(0, brace) + "[=COUNT]";
  }
  std::string make_option_opts(const CLI::Option* option) const override {
    return option->get_type_size() == 0 || option->get_positional() ? "" : " " + option->get_type_name();
  }

 private:
  std::string usage_;
};

// The flags of the program and of every command. They are added last, and stand last in the help.
void addFlags(CLI::App& command, Verbosity& verbosity) {
  command.add_flag("-v,--verbose", verbosity.verbose, "Say more")->group("General");
  command.add_flag("-q,--quiet", verbosity.quiet, "Say only what is wrong")->group("General");
  command.set_help_flag();
  command.set_help_flag("-h,--help", "Show this and exit")->group("General");
}

void addDevice(CLI::App& command, DeviceChoice& choice) {
  command
      .add_option("--device", choice.device,
                  "GL device: a number or part of a name in `sfumato info`, or `software`")
      ->type_name("DEVICE")
      ->group("General");
  command
      .add_option("--shader-dir", choice.shaderDir,
                  "Shader files here stand in for the built-in ones of the same name")
      ->type_name("FOLDER")
      ->group("General")
      ->check(folder());
}

// An option of three numbers into a glm::dvec3 or an optional one.
template <typename Vector>
CLI::Option* addVector(CLI::App& command, const char* name, const char* help, Vector& vector) {
  const auto take = [&vector](const std::vector<double>& v) { vector = glm::dvec3(v[0], v[1], v[2]); };
  return command.add_option_function<std::vector<double>>(name, take, help)->expected(3);
}

void addSmoke(CLI::App& command, RenderOptions& options) {
  const auto add = [&](const char* name, auto& value, const char* help) {
    return command.add_option(name, value, help)->group("Smoke");
  };
  add("--volume", options.volumes, "Add this OpenVDB smoke; without SCENE it gets a set; may be given again")
      ->type_name("FILE.vdb")
      ->check(fileName())
      ->allow_extra_args(false);
  add("--grid", options.grid, "The grid to take from it; else \"density\", or the only one")
      ->type_name("NAME");
  add("--volume-scale", options.volumeScale,
      "Its extinction per density, 1/m: 0 to 1e9, else 1, or alone what suits")
      ->type_name("SCALE")
      ->check(between(0.0, 1e9));
  addVector(command, "--volume-extinction", "Its extinction's colour, times SCALE: each 0 to 1e6, else 1",
            options.volumeExtinction)
      ->type_name("R G B")
      ->check(between(0.0, 1e6))
      ->group("Smoke");
  addVector(command, "--volume-albedo", "Its scattering albedo: each 0 to 1, else 0.9", options.volumeAlbedo)
      ->type_name("R G B")
      ->check(between(0.0, 1.0))
      ->group("Smoke");
  add("--volume-g", options.volumeG, "Its Henyey-Greenstein g: -0.99 to 0.99, else 0")
      ->type_name("G")
      ->check(between(-0.99, 0.99));
  add("--volume-memory", options.volumeMemory,
      "Most that all smoke takes; more comes in bricks, else what there is")
      ->type_name("BYTES|256M|2G");
}

void addFire(CLI::App& command, RenderOptions& options) {
  CLI::Option* fire =
      command
          .add_option("--fire", options.fire, "The grid of its file that glows, e.g. temperature or flame")
          ->type_name("NAME")
          ->group("Smoke");
  const auto add = [&](const char* name, auto& value, const char* help) {
    return command.add_option(name, value, help)->needs(fire)->group("Smoke");
  };
  add("--fire-kelvin", options.fireKelvin, "Glow as a black body, so hot per unit: 1e-6 to 1e6")
      ->type_name("KELVIN")
      ->check(between(1e-6, 1e6));
  add("--fire-strength", options.fireStrength, "Its radiance, times this: 0 to 1e6, else 1")
      ->type_name("FACTOR")
      ->check(between(0.0, 1e6));
  add("--fire-lights", options.fireLights, "Point lights in it that light the rest: 0 to 64, else 0")
      ->type_name("COUNT")
      ->check(wholeBetween(0, 64));
}

// Of `options.width` and `options.height`.
template <typename Options>
CLI::Option& addResolution(CLI::App& command, Options& options, const std::string& help) {
  const auto take = [&options](const std::string& text) {
    const Resolution size = parseResolution(text).value();
    options.width = size.width;
    options.height = size.height;
  };
  return *command.add_option_function<std::string>("--res", take, help)
              ->type_name("WxH")
              ->check(resolution());
}

void addView(CLI::App& command, RenderOptions& options) {
  const auto add = [&](const char* name, auto& value, const char* help) {
    return command.add_option(name, value, help)->group("View");
  };
  addResolution(
      command, options,
      fmt::format("Image size: 1 to 16384 pixels a side, else {}x{}", options.width, options.height))
      .group("View");
  add("--camera", options.camera, "Camera of the scene; else its first, or one that sees everything")
      ->type_name("NAME");
  add("--time", options.timeSeconds, "Pose the scene as its animations have it then; else at rest")
      ->type_name("SECONDS")
      ->check(coordinate());
  addVector(command, "--look-from", "Stand here: metres", options.lookFrom)
      ->type_name("X Y Z")
      ->check(coordinate())
      ->group("View");
  addVector(command, "--look-at", "Look at this point: metres", options.lookAt)
      ->type_name("X Y Z")
      ->check(coordinate())
      ->group("View");
  add("--fov", options.fovDegrees, "Vertical field of view: 0.1 to 170")
      ->type_name("DEGREES")
      ->check(between(0.1, 170.0));
}

void addQuality(CLI::App& command, RenderOptions& options) {
  const auto add = [&](const char* name, auto& value, const char* help) {
    return command.add_option(name, value, help)->group("Quality");
  };
  command
      .add_option("--quality", options.quality, "draft, medium, high or reference; else " + options.quality)
      ->group("Quality")
      ->type_name("NAME")
      ->check(oneOf(pipelines::qualityNames()));
  add("--step", options.stepVoxels, "March through smoke in such steps: 0.01 to 100, else by --quality")
      ->type_name("VOXELS")
      ->check(between(0.01, 100.0));
  add("--smoke-spacing", options.smokeSpacing,
      "March once for up to 4 x 4 pixels if rays stay so close: 0 to 100")
      ->type_name("VOXELS")
      ->check(between(0.0, 100.0));
  command
      .add_flag("--half-res-smoke", options.halfResolutionSmoke,
                "March smoke once for 2 x 2 pixels at least: faster, less sharp")
      ->group("Quality");
  add("--shadow-res", options.shadowResolution,
      "Texels a side of every shadow map: 32 to 16384, else what suits")
      ->type_name("TEXELS")
      ->check(wholeBetween(32, 16384));
  add("--shadow-error", options.shadowError,
      "Error bound of their transmittance: 0 to 0.5, else by --quality")
      ->type_name("ERROR")
      ->check(between(0.0, 0.5));
  add("--shadow-filter", options.shadowFilter,
      "Look shadows up so: nearest, bilinear, soft; else by --quality")
      ->type_name("NAME")
      ->check(oneOf(pipelines::shadowFilters().names));
  add("--shadow-memory", options.shadowMemory,
      "Most that shadow maps may take together, else what the device holds")
      ->type_name("BYTES|64K|256M|2G");
}

void addPipeline(CLI::App& command, RenderOptions& options) {
  command
      .add_option("--pipeline", options.pipeline,
                  fmt::format("Of {}", fmt::join(pipelines::pipelineNames(), ",")))
      ->type_name("NAME")
      ->check(oneOf(pipelines::pipelineNames()))
      ->group("Pipeline");
}

// Settings of pipelines other than lund.
void addDeferred(CLI::App& command, RenderOptions& options) {
  const auto add = [&](const char* name, auto& value, const std::string& help) {
    return command.add_option(name, value, help)->group("Pipeline");
  };
  const auto choose = [&](const std::string& name, std::string& value, const std::string& what,
                          const std::vector<std::string>& names, const std::string& usual) {
    command.add_option(name, value, fmt::format("{}: {}; else {}", what, fmt::join(names, ", "), usual))
        ->group("Pipeline")
        ->type_name("NAME")
        ->check(oneOf(names));
  };
  choose("--shadows", options.shadows, "Of pipelines but lund", pipelines::shadowKinds().names, "theirs");
  choose("--interlace", options.interlace, "Pixels of translucent surfaces", pipelines::interlaces().names,
         options.interlace);
  choose("--storage", options.storage, "Targets: of floats, or of 8 and 10 bits", pipelines::storages().names,
         options.storage);
  choose("--passes", options.passes, "Of reentrant, for all surfaces or each object",
         pipelines::passesNames().names, options.passes);
  command
      .add_flag("--depth-prepass", options.depthsFirst,
                "Draw depths of opaque surfaces first, so that none is shaded in vain")
      ->group("Pipeline");
  add("--layers", options.layers, "Layers that are peeled at most: 1 to 10000, else all")
      ->type_name("N")
      ->check(wholeBetween(1, 10000));
  add("--refraction", options.refraction,
      "Bend what surfaces let through: 0 to 1 of the image's height, else 0")
      ->type_name("PART")
      ->check(between(0.0, 1.0));
}

void addScattering(CLI::App& command, RenderOptions& options) {
  // Alone it is a flag, so that what stands behind it is not taken for a number of octaves.
  command
      .add_flag(fmt::format("--multiscatter{{{}}}", pipelines::usualScatteringOctaves),
                options.scatteringOctaves,
                fmt::format("Let smoke scatter again, in octaves: 0 to {}, else 0, or alone {}",
                            pipelines::maxScatteringOctaves, pipelines::usualScatteringOctaves))
      ->check(wholeBetween(0, pipelines::maxScatteringOctaves))
      ->group("Quality");
}

void addLists(CLI::App& command, RenderOptions& options) {
  const auto add = [&](const char* name, auto& value, const char* help) {
    return command.add_option(name, value, help)->group("Quality");
  };
  add("--lists", options.lists, "Build lists so: spinlock, lockfree, append, count; else what suits")
      ->type_name("NAME")
      ->check(oneOf(lists::strategies().names));
  add("--list-memory", options.listMemory, "Most that the lists at one time may take, else what there is")
      ->type_name("BYTES|64K|256M|2G");
  add("--on-overflow", options.onOverflow, "What then: grow, window (in parts, slower) or error; else window")
      ->type_name("NAME")
      ->check(oneOf(lists::overflowPolicies().names));
}

void addReference(CLI::App& command, RenderOptions& options) {
  CLI::Option* reference =
      command
          .add_flag("--reference", options.reference,
                    "Draw on the CPU, by tracing rays in double precision: slow, needs no GL")
          ->group("Quality");
  command.add_option("--samples", options.samples, "Its samples a side of a pixel: 1 to 64, else 1")
      ->type_name("COUNT")
      ->check(wholeBetween(1, 64))
      ->needs(reference)
      ->group("Quality");
}

void addAmbient(CLI::App& command, RenderOptions& options) {
  command
      .add_option_function<std::string>(
          "--ambient", [&options](const std::string& text) { options.ambient = parseColour(text); },
          "Light surfaces from all around: 0 to 1e6 each, else as the scene says")
      ->type_name("R,G,B")
      ->check(colour())
      ->group("Quality");
  CLI::Option* occlusion =
      command
          .add_option("--ssao", options.ambientOcclusion,
                      "Let surfaces shadow that light: off, full, half, quarter; else off")
          ->type_name("SIZE")
          ->check(oneOf(pipelines::occlusionSizes().names))
          ->excludes("--reference")
          ->group("Quality");
  command
      .add_option("--ssao-radius", options.ambientOcclusionRadius,
                  "Within this distance: 1e-6 to 1e6, else what suits the scene")
      ->type_name("METRES")
      ->check(between(1e-6, 1e6))
      ->needs(occlusion)
      ->group("Quality");
}

void addOutput(CLI::App& command, RenderOptions& options) {
  const auto add = [&](const char* name, auto& value, const std::string& help) {
    return command.add_option(name, value, help)->group("Output");
  };
  add("-o,--output", options.outputs,
      "Image to write: .exr linear, .png tone-mapped sRGB; may be given again")
      ->type_name("FILE")
      ->check(fileName())
      ->allow_extra_args(false);
  add("--aov", options.aovs,
      fmt::format("Layers of an .exr; of the last three heat maps beside a .png:\n{}",
                  fmt::join(pipelines::aovKinds().names, ", ")))
      ->type_name("NAME,...")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(oneOf(pipelines::aovKinds().names));
  add("--deep", options.deep, "Write what lies along each pixel's depth, for deep compositing")
      ->type_name("FILE.exr")
      ->check(fileName());
  add("--deep-shadow", options.deepShadows,
      "Write the deep shadow map of a light so: its name or number; may recur")
      ->type_name("LIGHT FILE.exr")
      ->check(fileName())
      ->allow_extra_args(false);
  add("--stats", options.statistics, "Write times, bytes and list figures as JSON")
      ->type_name("FILE.json")
      ->check(fileName());
  add("--repeat", options.repeat, "Draw so often, for the times: 1 to 1000, else 1; the last is written")
      ->type_name("TIMES")
      ->check(wholeBetween(1, 1000));
  command
      .add_flag("-n,--dry-run", options.dryRun, "Read all files, print the plan, write nothing; needs no GL")
      ->group("Output");
}

constexpr const char* pictures = "Pictures (.png; an .exr keeps linear radiance)";

void addDisplay(CLI::App& command, DisplayOptions& options) {
  const auto add = [&](const char* name, auto& value, const char* help) {
    return command.add_option(name, value, help)->group(pictures);
  };
  add("--exposure", options.exposureStops, "Brighten them: -30 to 30, else 0")
      ->type_name("STOPS")
      ->check(between(-30.0, 30.0));
  add("--tonemap", options.toneCurve, "neutral (Khronos), reinhard (by log-average luminance); else neutral")
      ->type_name("NAME")
      ->check(oneOf(image::toneCurves().names));
  add("--white", options.white, "What reinhard shows white: 1e-6 to 1e9, else the brightest there")
      ->type_name("LUMINANCE")
      ->check(between(1e-6, 1e9));
  add("--bloom", options.bloom, "Let bright parts glow: separable, mipmap or off; else off")
      ->type_name("NAME")
      ->check(oneOf(pipelines::blooms().names));
  add("--bloom-strength", options.bloomStrength, "Part of their light that glows: 0 to 10, else 0.2")
      ->type_name("PART")
      ->check(between(0.0, 10.0));
  add("--aa", options.antiAliasing, "edges: blur across the edges of opaque surfaces; else off")
      ->type_name("NAME")
      ->check(oneOf(pipelines::antiAliasings().names));
}

// What a preset sets, unless a flag did.
void applyEffects(const CLI::App& command, RenderOptions& options) {
  const auto effects = std::ranges::find(allEffects(), options.effects, &Effects::name);
  if (effects == allEffects().end()) return;
  const auto isFree = [&](const char* flag) { return command.count(flag) == 0; };
  if (isFree("--tonemap")) options.display.toneCurve = "reinhard";
  if (isFree("--bloom")) options.display.bloom = "mipmap";
  if (isFree("--aa")) options.display.antiAliasing = "edges";
  if (isFree("--ssao")) options.ambientOcclusion = effects->ambientOcclusion;
  if (isFree("--shadow-res") && isFree("--quality")) options.mostShadowResolution = effects->shadowResolution;
  options.routedSamples = effects->routedSamples;
}

void addEffects(CLI::App& command, RenderOptions& options) {
  command
      .add_option("--effects", options.effects,
                  "low, medium, high: tone map, bloom, edges, --ssao at once; flags win")
      ->type_name("NAME")
      ->check(oneOf(effectsNames()))
      ->excludes("--reference")
      ->group(pictures);
  command.parse_complete_callback([&command, &options] { applyEffects(command, options); });
}

void addTolerance(CLI::App& command, const std::string& what, Tolerance& tolerance) {
  const auto add = [&](const std::string& name, double& value, const char* type, double high,
                       const std::string& help) {
    command.add_option(name, value, help)->type_name(type)->check(between(0.0, high))->group("Tolerances");
  };
  const std::string says = what == "fail" ? "Fail" : "Warn";
  add("--" + what, tolerance.threshold, "VALUE", 1e30,
      says + " where pixels differ by more, else 1e-6 (exit code " + (what == "fail" ? "1)" : "0)"));
  add("--" + what + "percent", tolerance.percent, "PERCENT", 100,
      "And where they are more than this of all pixels, else 0");
  add("--hard" + what, tolerance.hard, "VALUE", 1e30, says + " where any pixel differs by more");
}

// An option that takes one or more values with commas between them.
template <typename T>
CLI::Option* addChoices(CLI::App& command, const char* name, std::vector<T>& values, const char* help) {
  return command.add_option(name, values, help)->delimiter(',')->allow_extra_args(false);
}

void addLoad(CLI::App& command, StressOptions& options) {
  const auto takeCells = [&options](const std::vector<std::string>& texts) {
    options.cells.clear();
    for (const std::string& text : texts) {
      const Resolution size = parseResolution(text).value();
      options.cells.emplace_back(size.width, size.height);
    }
  };
  command.add_option_function<std::vector<std::string>>("--cells", takeCells, "Grids of cells, else 128x128")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->type_name("WxH,...")
      ->check(resolution())
      ->group("Synthetic loads");
  addChoices(command, "--layers", options.layers, "Mean nodes a cell: 1 to 1000000, else 4,16,32")
      ->type_name("COUNT,...")
      ->check(wholeBetween(1, 1000000))
      ->group("Synthetic loads");
  addChoices(command, "--distribution", options.distributions, "Of uniform,hot-spot,one-cell,hair; else all")
      ->type_name("NAME,...")
      ->check(oneOf(lists::stress::distributions().names))
      ->group("Synthetic loads");
  addChoices(command, "--node-bytes", options.nodeBytes, "Payload of a node: 0, 4, ... 64; else 4")
      ->type_name("BYTES,...")
      ->check(oneOf({"0", "4", "8", "12", "16", "20", "24", "28", "32", "36", "40", "44", "48", "52", "56",
                     "60", "64"}))
      ->group("Synthetic loads");
  command.add_option("--seed", options.seed, "Of the loads, and of the lights of a scene; else 1")
      ->type_name("NUMBER")
      ->check(wholeBetween(0, std::numeric_limits<int>::max()))
      ->group("Synthetic loads");
}

void addStrategies(CLI::App& command, StressOptions& options) {
  addChoices(command, "--lists", options.lists, "Of spinlock,lockfree,append,count; else all")
      ->type_name("NAME,...")
      ->check(oneOf(lists::strategies().names))
      ->group("Lists");
  addChoices(command, "--list-memory", options.listMemory,
             "Budgets: none, 256M, or 10% of what finished lists take; else none,10%")
      ->type_name("SIZE,...")
      ->check(budget())
      ->group("Lists");
  command
      .add_option("--on-overflow", options.onOverflow, "Of the budget: grow, window or error; else window")
      ->type_name("NAME")
      ->check(oneOf(lists::overflowPolicies().names))
      ->group("Lists");
}

// Of a command that compares many runs.
template <typename Options>
void addReport(CLI::App& command, Options& options) {
  command.add_flag("--json", options.json, "As JSON")->group("Output");
  command.add_option("--report", options.report, "Write FOLDER/index.html, a page with plots")
      ->type_name("FOLDER")
      ->check(fileName())
      ->group("Output");
}

void addTimes(CLI::App& command, StressOptions& options) {
  command
      .add_option("--repeat", options.repeat,
                  "Do each run so often, and keep its least times: 1 to 1000, else 1")
      ->type_name("TIMES")
      ->check(wholeBetween(1, 1000))
      ->group("Runs");
  command
      .add_option("--minutes", options.minutes,
                  "Soak so long instead: sizes and budgets change from run to run")
      ->type_name("COUNT")
      ->check(between(0.001, 100000))
      ->group("Runs");
}

CLI::Option* addRepeat(CLI::App& command, int& repeat) {
  return command.add_option("--repeat", repeat, "Time so many frames of each: 1 to 1000, else 3")
      ->type_name("TIMES")
      ->check(wholeBetween(1, 1000));
}

void addComparison(CLI::App& command, BenchOptions& options) {
  addChoices(command, "--pipelines", options.pipelines,
             fmt::format("Of {}", fmt::join(pipelines::pipelineNames(), ",")).c_str())
      ->type_name("NAME,...")
      ->check(oneOf(pipelines::pipelineNames()))
      ->group("Comparison");
  command
      .add_option("--exact", options.exact,
                  "What is exact: cpu (the reference), or lund at its best; else by size")
      ->type_name("NAME")
      ->check(oneOf({"cpu", "lund", "auto"}))
      ->group("Comparison");
  addRepeat(command, options.repeat)->group("Comparison");
}

void addPaperTests(CLI::App& command, PapersOptions& options) {
  const auto add = [&](const char* name, auto& value, const char* help) {
    return command.add_option(name, value, help)->group("Tests");
  };
  addResolution(command, options,
                fmt::format("Size for their 1920x1080, else {}x{}; all else in proportion", options.width,
                            options.height))
      .group("Tests");
  add("--paper", options.paper, "metu (Aladagli 2015) or cescg (Ferko 2012), else both")
      ->type_name("NAME")
      ->check(oneOf({"metu", "cescg"}));
  command
      .add_option_function<std::string>(
          "--lights", [&options](const std::string& text) { options.lights = parseRange(text, 0, 64); },
          "Of metu only the tests with so many lights: 0 to 64, else all")
      ->type_name("FROM..TO")
      ->check(range(0, 64))
      ->group("Tests");
  addRepeat(command, options.repeat)->group("Tests");
}

CLI::App& addCommand(CLI::App& program, const char* name, const char* help, const char* usage) {
  CLI::App& command = *program.add_subcommand(name, help);
  command.group("Commands");
  command.formatter(std::make_shared<Help>(usage));
  return command;
}

void addChecks(CLI::App& command, ValidateOptions& options) {
  const auto add = [&](const char* name, auto& value, const char* help) {
    return command.add_option(name, value, help)->group("Checks");
  };
  add("--only", options.only, "Run only these checks or groups of checks")->type_name("NAME ...");
  add("--skip", options.skip, "Leave these out")->type_name("NAME ...");
  add("--scale", options.scale, "small or full, else small: seconds or minutes on software GL")
      ->type_name("NAME")
      ->check(oneOf({"small", "full"}));
  add("--seed", options.seed, "Of all that is random: 0 to 2147483647, else 1")
      ->type_name("N")
      ->check(wholeBetween(0, std::numeric_limits<int>::max()));
  add("--timeout", options.timeoutSeconds, "Then a check hangs: 0.1 to 86400, else 60, or 180 at full scale")
      ->type_name("SECONDS")
      ->check(between(0.1, 86400.0));
  add("--jobs", options.jobs, "Checks at a time: 1 to 64, else 1")
      ->type_name("N")
      ->check(wholeBetween(1, 64));
  command.add_flag("--list", options.list, "Say which checks there are, and what they do")->group("Checks");
  command
      .add_flag("--self-test", options.selfTest,
                "Put faults into our own shaders, and show that the checks see each")
      ->group("Checks");
  add("--run-check", options.runCheck, "")
      ->group("");  // not in the help: what the program starts itself with
  add("--mutant", options.mutant, "")->group("");
}

void addReports(CLI::App& command, ValidateOptions& options) {
  CLI::Option* json = command.add_flag("--json", options.json, "As JSON")->group("Output");
  command.add_flag("--tap", options.tap, "As TAP, for test harnesses")->group("Output")->excludes(json);
  command.add_option("--junit", options.junit, "Write JUnit XML as well, for CI systems")
      ->type_name("FILE.xml")
      ->group("Output")
      ->check(fileName());
}

}  // namespace

void addProgram(CLI::App& program, Verbosity& verbosity) {
  program.formatter(std::make_shared<Help>("COMMAND [OPTIONS]"));
  program.set_version_flag("--version", std::string("sfumato ") + base::version(), "Show it and exit")
      ->group("General");
  program.require_subcommand(0, 1);  // that there is one is checked after what is unknown
  addFlags(program, verbosity);
}

CLI::App& addRender(CLI::App& program, RenderOptions& options, Verbosity& verbosity) {
  CLI::App& command =
      addCommand(program, "render", "Render a scene with smoke into images", "[SCENE] -o FILE [OPTIONS]");
  command.add_option("SCENE", options.scene, ".gltf or .glb; its nodes may name smoke (extras \"volume\")")
      ->check(fileName());
  addSmoke(command, options);
  addFire(command, options);
  addView(command, options);
  addQuality(command, options);
  addScattering(command, options);
  addPipeline(command, options);
  addDeferred(command, options);
  addLists(command, options);
  addReference(command, options);
  addAmbient(command, options);
  addOutput(command, options);
  addDisplay(command, options.display);
  addEffects(command, options);
  addDevice(command, options.device);
  addFlags(command, verbosity);
  return command;
}

CLI::App& addCompare(CLI::App& program, CompareOptions& options, Verbosity& verbosity) {
  CLI::App& command = addCommand(program, "compare", "Tell how far two images are apart", "A B [OPTIONS]");
  command.add_option("A", options.image, "Image; one of N times B's size is averaged down to it")
      ->required()
      ->check(fileName());
  command.add_option("B", options.reference, "What it should be")->required()->check(fileName());
  addTolerance(command, "fail", options.fail);
  addTolerance(command, "warn", options.warn);
  command.add_option("--heat-map", options.heatMap, "Write the difference of each pixel as a colour")
      ->type_name("FILE.png")
      ->check(fileName())
      ->group("Output");
  command.add_flag("--json", options.json, "As JSON")->group("Output");
  addFlags(command, verbosity);
  return command;
}

CLI::App& addStress(CLI::App& program, StressOptions& options, Verbosity& verbosity) {
  CLI::App& command = addCommand(
      program, "stress", "Build lists of every kind under load, and check every node", "[SCENE] [OPTIONS]");
  CLI::Option* scene =
      command.add_option("SCENE", options.shot.scene, ".gltf or .glb to stress instead of synthetic loads")
          ->check(fileName());
  addLoad(command, options);
  for (const char* name : {"--cells", "--layers", "--distribution", "--node-bytes"})
    command.get_option(name)->excludes(scene);
  addStrategies(command, options);
  addTimes(command, options);
  command
      .add_option_function<std::string>(
          "--lights", [&options](const std::string& text) { options.lights = parseRange(text, 1, 65536); },
          "Put so many lights into SCENE, twice as many from run to run")
      ->type_name("FROM..TO")
      ->check(range(1, 65536))
      ->group("Scene");
  addSmoke(command, options.shot);
  addFire(command, options.shot);
  addView(command, options.shot);
  addQuality(command, options.shot);
  addReport(command, options);
  addDevice(command, options.shot.device);
  addFlags(command, verbosity);
  return command;
}

BenchCommands addBench(CLI::App& program, BenchOptions& options, PapersOptions& papers,
                       Verbosity& verbosity) {
  CLI::App& bench = addCommand(program, "bench", "Compare pipelines: their errors, times and memory",
                               "pipelines|papers [OPTIONS]");
  CLI::App& comparison =
      addCommand(bench, "pipelines", "Draw one scene with all, and hold each against the exact answer",
                 "[SCENE] [OPTIONS]");
  comparison.add_option("SCENE", options.shot.scene, ".gltf or .glb; else 1, 2, 4 and 8 panes and smoke")
      ->check(fileName());
  addComparison(comparison, options);
  addSmoke(comparison, options.shot);
  addFire(comparison, options.shot);
  addView(comparison, options.shot);
  addQuality(comparison, options.shot);
  addDeferred(comparison, options.shot);
  addReport(comparison, options);
  addDevice(comparison, options.shot.device);
  addFlags(comparison, verbosity);
  CLI::App& tests =
      addCommand(bench, "papers", "Do the papers' tests, and tell ratios beside theirs", "[OPTIONS]");
  addPaperTests(tests, papers);
  addReport(tests, papers);
  addDevice(tests, papers.device);
  addFlags(tests, verbosity);
  bench.require_subcommand(0, 1);  // that there is one is checked after what is unknown
  addFlags(bench, verbosity);
  return {bench, comparison, tests};
}

CLI::App& addInfo(CLI::App& program, InfoOptions& options, Verbosity& verbosity) {
  CLI::App& command = addCommand(
      program, "info", "Show the GL devices, the one in use, and what its limits mean", "[OPTIONS]");
  command.add_flag("--json", options.json, "As JSON")->group("General");
  addDevice(command, options.device);
  addFlags(command, verbosity);
  return command;
}

CLI::App& addValidate(CLI::App& program, ValidateOptions& options, Verbosity& verbosity) {
  CLI::App& command =
      addCommand(program, "validate",
                 "Check whether this GL driver can be trusted with atomics, lists, locks", "[OPTIONS]");
  addChecks(command, options);
  addReports(command, options);
  addDevice(command, options.device);
  addFlags(command, verbosity);
  return command;
}

}  // namespace sfumato::app
