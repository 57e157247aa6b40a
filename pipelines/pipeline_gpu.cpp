#include "pipelines/pipeline_gpu.h"

#include <type_traits>

#include "pipelines/forward_gpu.h"
#include "pipelines/interlaced_gpu.h"
#include "pipelines/linked_lists_gpu.h"
#include "pipelines/peeling_gpu.h"
#include "pipelines/pipeline_names.h"
#include "pipelines/reentrant_gpu.h"
#include "pipelines/stencil_routed_gpu.h"

namespace sfumato::pipelines {

std::unique_ptr<Pipeline> makePipeline(const std::string& name, gl::Device& device, const scene::Scene& scene,
                                       std::span<const volumes::Medium> media,
                                       const volumes::GridOptions& gridOptions) {
  checkPipelineName(name);
  const auto make = [&]<typename Made>(std::type_identity<Made>, auto... first) {
    return std::make_unique<Made>(first..., device, scene, media, gridOptions);
  };
  using Refraction = ForwardPipeline::Refraction;
  if (name == "interlaced") return make(std::type_identity<InterlacedPipeline>());
  if (name == "peeling") return make(std::type_identity<PeelingPipeline>());
  if (name == "forward") return make(std::type_identity<ForwardPipeline>(), Refraction::ByDepth);
  if (name == "forward-mask") return make(std::type_identity<ForwardPipeline>(), Refraction::ByMask);
  if (name == "reentrant") return make(std::type_identity<ReentrantPipeline>());
  if (name == "stencil-routed") return make(std::type_identity<StencilRoutedPipeline>());
  return make(std::type_identity<LinkedListsPipeline>());
}

}  // namespace sfumato::pipelines
