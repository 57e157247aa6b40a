#include "pipelines/pipeline_gpu.h"

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
  if (name == "interlaced") return std::make_unique<InterlacedPipeline>(device, scene, media, gridOptions);
  if (name == "forward")
    return std::make_unique<ForwardPipeline>(ForwardPipeline::Refraction::ByDepth, device, scene, media,
                                             gridOptions);
  if (name == "forward-mask")
    return std::make_unique<ForwardPipeline>(ForwardPipeline::Refraction::ByMask, device, scene, media,
                                             gridOptions);
  if (name == "peeling") return std::make_unique<PeelingPipeline>(device, scene, media, gridOptions);
  if (name == "reentrant") return std::make_unique<ReentrantPipeline>(device, scene, media, gridOptions);
  if (name == "stencil-routed")
    return std::make_unique<StencilRoutedPipeline>(device, scene, media, gridOptions);
  return std::make_unique<LinkedListsPipeline>(device, scene, media, gridOptions);
}

}  // namespace sfumato::pipelines
