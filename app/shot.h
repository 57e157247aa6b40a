// What `sfumato render` draws, and what comes of it, whoever draws.
#pragma once

#include <chrono>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "app/options.h"
#include "image/deep_image.h"
#include "image/image.h"
#include "image/tone_map.h"
#include "pipelines/aovs.h"
#include "pipelines/post.h"
#include "pipelines/quality.h"
#include "scene/default_set.h"
#include "scene/scene.h"
#include "volumes/grid.h"

namespace sfumato::app {

using Clock = std::chrono::steady_clock;

inline double secondsSince(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

struct Shot {
  scene::Scene scene;
  std::vector<volumes::Medium> media;
  scene::Camera camera;
  pipelines::Quality quality;
  size_t volumeMemory = std::numeric_limits<size_t>::max();  // most bytes of all smoke on the device
  pipelines::AovSet aovs;                                    // that are wanted
  std::vector<size_t> deepShadows;                           // lights whose maps are
  pipelines::PostOptions post;                               // of pictures

  // Those that are wanted, and those that post-processing looks at.
  pipelines::AovSet aovsToDraw() const {
    pipelines::AovSet all = pipelines::aovsFor(post);
    all.insert(aovs.begin(), aovs.end());
    return all;
  }
};

// Whether there is one: a file, or smoke, which gets a set.
bool isOfScene(const RenderOptions& options);
// Throws Usage where something was given that only a scene has.
void checkWithoutScene(const RenderOptions& options);

pipelines::Quality chooseQuality(const RenderOptions& options);

// Reads everything that is drawn.
Shot makeShot(const RenderOptions& options);
// Of all that is there.
scene::Bounds boundsOf(const scene::Scene& scene, const std::vector<volumes::Medium>& media);

struct Drawn {
  image::Image radiance;
  pipelines::AovImages aovs;
  std::optional<image::DeepImage> deep;
  std::vector<std::vector<image::DeepImage>> deepShadows;  // a light each, of an image for each face
  std::string device;                                      // who drew it, for the metadata
  std::string statistics;                                  // JSON
  std::optional<image::Image> display;                     // what pictures show instead, post-processed
  image::Brightness brightness;                            // of the radiance, where it was measured
};

// Opens the device and draws the frame --repeat times, the last one counts; `start` is when the program
// started to work. In render_gpu.cpp; a build without OpenGL has another in without_gl.cpp, which throws
// NoGl.
Drawn drawOnGpu(const RenderOptions& options, const Shot& shot, Clock::time_point start);

}  // namespace sfumato::app
