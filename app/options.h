// What the command line says, as plain values.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace sfumato::app {

// In every command that uses GL.
struct DeviceChoice {
  std::string device;  // see gl::DeviceOptions::choice
  std::string shaderDir;
};

// What shapes pictures for a screen (.png), and leaves an .exr as it is.
struct DisplayOptions {
  double exposureStops = 0;
  std::string toneCurve = "neutral";
  std::optional<double> white;  // luminance, of Reinhard's curve; none: the largest of the picture
  std::string bloom = "off";
  std::optional<double> bloomStrength;
  std::string antiAliasing = "off";
};

struct RenderOptions {
  DeviceChoice device;
  std::string commandLine;           // as typed, for the metadata
  std::string scene;                 // .gltf or .glb; empty: the volumes get a default set
  std::vector<std::string> volumes;  // .vdb
  std::string grid;                  // of the volumes given by flags
  std::optional<double> volumeScale;
  glm::dvec3 volumeExtinction{1};
  glm::dvec3 volumeAlbedo{0.9};
  double volumeG = 0;
  std::string fire;  // its grid that glows
  std::optional<double> fireKelvin;
  double fireStrength = 1;
  int fireLights = 0;
  std::string volumeMemory;  // empty: what the device allows
  std::vector<std::string> outputs;
  int width = 1280;
  int height = 720;
  std::string camera;
  std::optional<glm::dvec3> lookFrom;
  std::optional<glm::dvec3> lookAt;
  std::optional<double> fovDegrees;
  std::optional<double> timeSeconds;  // pose of the scene's animations; none: at rest
  bool depthsFirst = false;
  std::string pipeline = "lund";
  std::string shadows;  // of a pipeline other than lund: pipelines/deferred_options.h; empty: its own
  std::string interlace = "lines";
  std::string storage = "exact";
  std::string passes = "object";
  int layers = 0;
  double refraction = 0;
  std::string quality = "medium";
  std::optional<double> stepVoxels;
  std::optional<int> shadowResolution;
  std::optional<double> smokeSpacing;
  bool halfResolutionSmoke = false;
  std::optional<double> shadowError;
  std::string shadowFilter;   // empty: by quality
  std::string shadowMemory;   // empty: what the device reads
  int scatteringOctaves = 0;  // of multiple scattering
  std::string lists;          // a strategy; empty: the device's
  std::string listMemory;     // empty: what the device allows
  std::string onOverflow = "window";
  std::optional<glm::dvec3> ambient;
  std::string ambientOcclusion = "off";
  std::optional<double> ambientOcclusionRadius;  // m
  bool reference = false;                        // drawn by the CPU reference
  int samples = 1;                               // a side of the pixel, of the reference
  DisplayOptions display;
  std::string effects;                                           // a preset (app/effects.h), empty: none
  std::optional<int> mostShadowResolution;                       // of that
  int routedSamples = 0;                                         // likewise: see pipelines::DeferredOptions
  std::vector<std::string> aovs;                                 // see pipelines/aovs.h
  std::string deep;                                              // .exr, empty: none
  std::vector<std::pair<std::string, std::string>> deepShadows;  // a light's name or number, and an .exr
  std::string statistics;                                        // path, empty: none
  int repeat = 1;                                                // frames; the last one is written
  bool dryRun = false;
};

// As in OpenImageIO's idiff: a comparison fails where more than `percent` of the pixels differ by more than
// `threshold`, or one by more than `hard`.
struct Tolerance {
  double threshold = 1e-6;
  double percent = 0;
  double hard = std::numeric_limits<double>::infinity();
};

struct CompareOptions {
  std::string commandLine;
  std::string image;
  std::string reference;
  Tolerance fail;
  Tolerance warn;
  std::string heatMap;  // .png, empty: none
  bool json = false;
};

struct InfoOptions {
  DeviceChoice device;
  bool json = false;
};

struct ValidateOptions {
  DeviceChoice device;
  std::vector<std::string> only;  // names of checks or groups; empty: all
  std::vector<std::string> skip;
  uint64_t seed = 1;
  std::string scale = "small";
  std::optional<double> timeoutSeconds;  // of one check; none: 60, or 180 at full scale
  int jobs = 1;
  bool list = false;
  bool selfTest = false;
  bool json = false;
  bool tap = false;
  std::string junit;     // path, empty: none
  std::string runCheck;  // not for users: run this one here, as a process of its own
  std::string mutant;    // its
};

struct StressOptions {
  // Device, command line, and of a scene what is seen of it.
  RenderOptions shot{.width = 320, .height = 180, .quality = "draft"};
  std::vector<glm::ivec2> cells = {{128, 128}};
  std::vector<int> layers = {4, 16, 32};
  std::vector<std::string> distributions = {"uniform", "hot-spot", "one-cell", "hair"};
  std::vector<int> nodeBytes = {4};  // of payload, multiples of 4
  int seed = 1;
  std::vector<std::string> lists = {"spinlock", "lockfree", "append", "count"};
  std::vector<std::string> listMemory;  // sizes, "none", "10%"; empty: none, and 10 % of synthetic loads
  std::string onOverflow = "window";
  std::optional<glm::ivec2> lights;  // of a scene: from, to
  int repeat = 1;                    // of each run; the least times count
  double minutes = 0;                // 0: a sweep
  bool json = false;
  std::string report;  // folder, empty: none
};

struct BenchOptions {
  // Device, command line, and of a scene what is seen of it; without one: panes and smoke.
  RenderOptions shot{.width = 320, .height = 180};
  std::vector<std::string> pipelines;  // empty: all
  std::string exact = "auto";          // "cpu", "lund"
  int repeat = 3;                      // frames that are timed
  bool json = false;
  std::string report;  // folder, empty: none
};

struct PapersOptions {
  DeviceChoice device;
  std::string commandLine;
  std::string paper;  // "metu", "cescg"; empty: both
  int width = 480;    // of what the papers drew with 1920 x 1080 pixels
  int height = 270;
  std::optional<glm::ivec2> lights;  // from, to: rows of the first paper's tables
  int repeat = 3;
  bool json = false;
  std::string report;
};

// Each runs its subcommand; the result is the program's exit code. Errors are thrown as base::Error.
int render(const RenderOptions& options);
int compare(const CompareOptions& options);
int info(const InfoOptions& options);
int validate(const ValidateOptions& options);
int stress(const StressOptions& options);
int bench(const BenchOptions& options);
int benchPapers(const PapersOptions& options);

}  // namespace sfumato::app
