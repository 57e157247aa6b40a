// What the command line says, as plain values.
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

namespace sfumato::app {

// In every command.
struct CommonOptions {
  std::string device;  // see gl::DeviceOptions::choice
  std::string shaderDir;
};

struct RenderOptions {
  CommonOptions common;
  std::string scene;                 // .gltf or .glb
  std::vector<std::string> volumes;  // .vdb
  std::string grid;                  // of the volumes given by flags
  double volumeScale = 1;
  glm::dvec3 volumeAlbedo{0.9};
  double volumeG = 0;
  std::vector<std::string> outputs;
  int width = 1280;
  int height = 720;
  std::string camera;
  std::optional<glm::dvec3> lookFrom;
  std::optional<glm::dvec3> lookAt;
  std::optional<double> fovDegrees;
  std::optional<double> timeSeconds;  // pose of the scene's animations; none: at rest
  std::string quality = "medium";
  std::optional<double> stepVoxels;
  std::optional<int> shadowResolution;
  double exposureStops = 0;
  std::string statistics;  // path, empty: none
  int repeat = 1;          // frames; the last one is written
  bool dryRun = false;
};

struct InfoOptions {
  CommonOptions common;
  bool json = false;
};

// Each runs its subcommand; the result is the program's exit code. Errors are thrown as base::Error.
int render(const RenderOptions& options);
int info(const InfoOptions& options);

}  // namespace sfumato::app
