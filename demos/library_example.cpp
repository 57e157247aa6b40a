// Sfumato as a library: makes smoke, puts it into the default set, draws it on the GPU, writes a picture.
#include <iostream>

#include "base/error.h"
#include "gl/device.h"
#include "image/image_file.h"
#include "pipelines/linked_lists_gpu.h"
#include "scene/default_set.h"
#include "volumes/procedural_smoke.h"
#include "volumes/vdb_file.h"

int main(int argc, char** argv) {
  using namespace sfumato;
  try {
    volumes::writeVdb("plume.vdb", volumes::makePlume(96, 2.0, 1));
    std::vector<volumes::Medium> media(1);
    media[0].grid = volumes::readVdb("plume.vdb", "");
    media[0].worldFromIndex = media[0].grid.worldFromIndex;
    media[0].scale = scene::fittingScale(media[0]);

    scene::Scene scene;
    const int width = 96, height = 64;
    scene::addDefaultSet(scene, scene::boundsOf(media), glm::radians(40.0), double(width) / height);

    gl::Device device({});
    pipelines::LinkedListsPipeline pipeline(device, scene, media);
    const pipelines::Frame frame =
        pipeline.render(scene.cameras[0], width, height, pipelines::qualityNamed("draft"));
    image::writeImage(argc > 1 ? argv[1] : "smoke.png", frame.radiance, {});
    return 0;
  } catch (const base::Error& error) {
    std::cerr << "library_example: " << error.what() << "\n";
    return static_cast<int>(error.exitCode);
  }
}
