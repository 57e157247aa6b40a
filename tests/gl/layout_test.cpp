// What C++ and GLSL share is laid out the same: the driver's own answer against offsetof, for every member of
// every struct in shaders/shared/*.h. The headers themselves are read, so that none is forgotten.
#include <gtest/gtest.h>

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <sstream>

#include "gl/program.h"
#include "shaders/shared/ambient_occlusion.h"
#include "shaders/shared/aovs.h"
#include "shaders/shared/deep.h"
#include "shaders/shared/deepshadow.h"
#include "shaders/shared/geometry.h"
#include "shaders/shared/grids.h"
#include "shaders/shared/lights.h"
#include "shaders/shared/lists.h"
#include "shaders/shared/post.h"
#include "shaders/shared/resolve.h"
#include "shaders/shared/stress.h"
#include "shaders/shared/surface.h"
#include "shaders/shared/view.h"
#include "shaders/shared/volumes.h"
#include "tests/gl/test_device.h"

namespace sfumato::gl {
namespace {

using Offsets = std::map<std::string, size_t>;

struct Layout {
  size_t size;
  Offsets offsets;
};

#define AT(type, member) \
  { #member, offsetof(shared::type, member) }

const std::map<std::string, Layout>& cppLayouts() {
  static const std::map<std::string, Layout> all = {
      {"ViewParams",
       {sizeof(shared::ViewParams),
        {AT(ViewParams, viewFromWorld), AT(ViewParams, worldFromView), AT(ViewParams, clipFromView),
         AT(ViewParams, halfExtent), AT(ViewParams, depthRange), AT(ViewParams, size), AT(ViewParams, tile),
         AT(ViewParams, window)}}},
      {"AovPixel",
       {sizeof(shared::AovPixel),
        {AT(AovPixel, depth), AT(AovPixel, normalX), AT(AovPixel, normalY), AT(AovPixel, normalZ),
         AT(AovPixel, albedoR), AT(AovPixel, albedoG), AT(AovPixel, albedoB), AT(AovPixel, lights),
         AT(AovPixel, fragments), AT(AovPixel, shadowNodes)}}},
      {"DeepEvent",
       {sizeof(shared::DeepEvent),
        {AT(DeepEvent, ray), AT(DeepEvent, front), AT(DeepEvent, back), AT(DeepEvent, addedR),
         AT(DeepEvent, addedG), AT(DeepEvent, addedB), AT(DeepEvent, throughputR), AT(DeepEvent, throughputG),
         AT(DeepEvent, throughputB)}}},
      {"DrawData",
       {sizeof(shared::DrawData),
        {AT(DrawData, worldFromObject), AT(DrawData, normalFromObject), AT(DrawData, indices)}}},
      {"MaterialData",
       {sizeof(shared::MaterialData),
        {AT(MaterialData, baseColour), AT(MaterialData, emissive), AT(MaterialData, specularColour),
         AT(MaterialData, factors), AT(MaterialData, flags), AT(MaterialData, shadow),
         AT(MaterialData, uvTransforms)}}},
      {"PostParams",
       {sizeof(shared::PostParams), {AT(PostParams, sizes), AT(PostParams, step), AT(PostParams, light)}}},
      {"PackedSurface",
       {sizeof(shared::PackedSurface),
        {AT(PackedSurface, normal), AT(PackedSurface, geometricNormal), AT(PackedSurface, diffuseRg),
         AT(PackedSurface, diffuseBRoughness), AT(PackedSurface, f0Rg), AT(PackedSurface, f0BF90),
         AT(PackedSurface, emissiveRg), AT(PackedSurface, emissiveBPassR), AT(PackedSurface, passGb),
         AT(PackedSurface, coverageObject)}}},
      {"LightData",
       {sizeof(shared::LightData),
        {AT(LightData, position), AT(LightData, direction), AT(LightData, intensity), AT(LightData, cone),
         AT(LightData, indices)}}},
      {"LightPassParams",
       {sizeof(shared::LightPassParams), {AT(LightPassParams, cells), AT(LightPassParams, window)}}},
      {"ListLink", {sizeof(shared::ListLink), {AT(ListLink, depth), AT(ListLink, id), AT(ListLink, next)}}},
      {"ListLogEntry",
       {sizeof(shared::ListLogEntry),
        {AT(ListLogEntry, cell), AT(ListLogEntry, depth), AT(ListLogEntry, id)}}},
      {"ListCounters",
       {sizeof(shared::ListCounters),
        {AT(ListCounters, demand), AT(ListCounters, overflowed), AT(ListCounters, maxSpins),
         AT(ListCounters, retries), AT(ListCounters, longest), AT(ListCounters, total),
         AT(ListCounters, unfinished), AT(ListCounters, broken), AT(ListCounters, unsorted)}}},
      {"ListKey", {sizeof(shared::ListKey), {AT(ListKey, depth), AT(ListKey, id)}}},
      {"ListRun", {sizeof(shared::ListRun), {AT(ListRun, first), AT(ListRun, count)}}},
      {"ListWindow", {sizeof(shared::ListWindow), {AT(ListWindow, range)}}},
      {"ListStep", {sizeof(shared::ListStep), {AT(ListStep, step), AT(ListStep, more)}}},
      {"ShadowFace",
       {sizeof(shared::ShadowFace),
        {AT(ShadowFace, faceFromWorld), AT(ShadowFace, projection), AT(ShadowFace, texels),
         AT(ShadowFace, smoke)}}},
      {"ShadowTexel",
       {sizeof(shared::ShadowTexel),
        {AT(ShadowTexel, first), AT(ShadowTexel, count), AT(ShadowTexel, opaqueDepth)}}},
      {"ShadowKnot",
       {sizeof(shared::ShadowKnot),
        {AT(ShadowKnot, depth), AT(ShadowKnot, tauR), AT(ShadowKnot, tauG), AT(ShadowKnot, tauB)}}},
      {"ShadowNode", {sizeof(shared::ShadowNode), {AT(ShadowNode, tauRg), AT(ShadowNode, tauBObject)}}},
      {"ShadowPassParams",
       {sizeof(shared::ShadowPassParams),
        {AT(ShadowPassParams, march), AT(ShadowPassParams, cells), AT(ShadowPassParams, units)}}},
      {"InterlacedPassParams",
       {sizeof(shared::InterlacedPassParams), {AT(InterlacedPassParams, lightColour)}}},
      {"ShadowCounters",
       {sizeof(shared::ShadowCounters),
        {AT(ShadowCounters, units), AT(ShadowCounters, unplaced), AT(ShadowCounters, unfinished),
         AT(ShadowCounters, boundHit), AT(ShadowCounters, hidden)}}},
      {"RayState",
       {sizeof(shared::RayState),
        {AT(RayState, radianceR), AT(RayState, radianceG), AT(RayState, radianceB), AT(RayState, depth),
         AT(RayState, throughputR), AT(RayState, throughputG), AT(RayState, throughputB),
         AT(RayState, surfaces)}}},
      {"ResolveParams",
       {sizeof(shared::ResolveParams),
        {AT(ResolveParams, march), AT(ResolveParams, options), AT(ResolveParams, samples01),
         AT(ResolveParams, samples23), AT(ResolveParams, ambient), AT(ResolveParams, blocks),
         AT(ResolveParams, area)}}},
      {"SmokeBlock",
       {sizeof(shared::SmokeBlock),
        {AT(SmokeBlock, radianceR), AT(SmokeBlock, radianceG), AT(SmokeBlock, radianceB),
         AT(SmokeBlock, reach), AT(SmokeBlock, passedR), AT(SmokeBlock, passedG), AT(SmokeBlock, passedB),
         AT(SmokeBlock, start), AT(SmokeBlock, depth), AT(SmokeBlock, refined), AT(SmokeBlock, firstKnot),
         AT(SmokeBlock, knots)}}},
      {"ResolveCounters",
       {sizeof(shared::ResolveCounters),
        {AT(ResolveCounters, groups), AT(ResolveCounters, unfinished), AT(ResolveCounters, boundHit)}}},
      {"StressParams",
       {sizeof(shared::StressParams),
        {AT(StressParams, load), AT(StressParams, window), AT(StressParams, lookups)}}},
      {"OcclusionParams",
       {sizeof(shared::OcclusionParams),
        {AT(OcclusionParams, offsets), AT(OcclusionParams, size), AT(OcclusionParams, along),
         AT(OcclusionParams, distances)}}},
      {"VolumeData",
       {sizeof(shared::VolumeData),
        {AT(VolumeData, extinction), AT(VolumeData, albedo), AT(VolumeData, scattering), AT(VolumeData, ramp),
         AT(VolumeData, phase)}}},
      {"GridData",
       {sizeof(shared::GridData),
        {AT(GridData, gridFromWorld), AT(GridData, boxMin), AT(GridData, boxMax), AT(GridData, bricksScale),
         AT(GridData, bricksFirst)}}},
  };
  return all;
}

// Struct names and their members as the headers spell them.
std::map<std::string, std::vector<std::string>> structsInHeaders() {
  std::map<std::string, std::vector<std::string>> found;
  for (const auto& entry :
       std::filesystem::directory_iterator(std::string(SFUMATO_SOURCE_DIR) + "/shaders/shared")) {
    if (entry.path().extension() != ".h") continue;
    std::ostringstream text;
    text << std::ifstream(entry.path()).rdbuf();
    const std::string content = text.str();
    const std::regex structure(R"(struct (\w+) \{([^}]*)\};)");
    for (std::sregex_iterator match(content.begin(), content.end(), structure), end; match != end; ++match) {
      const std::string body = (*match)[2];
      const std::regex member(R"(\n\s*\w+ (\w+)(?:\[[^\]]*\])?;)");
      for (std::sregex_iterator at(body.begin(), body.end(), member); at != end; ++at)
        found[(*match)[1]].push_back((*at)[1]);
    }
  }
  return found;
}

// Offsets of the members of subject[0] and the stride of the array, as the driver has them.
Layout driverLayout(Device& device, const std::string& name, bool uniform) {
  const Program program(device, {"gl/layouts.comp"},
                        {{"STRUCT", name},
                         {"LAYOUT", uniform ? "std140" : "std430"},
                         {"BLOCK", uniform ? "uniform" : "readonly buffer"}});
  Layout layout{0, {}};
  size_t second = 0;
  const std::regex member(R"((?:Subject\.)?subject\[([01])\]\.(\w+)(?:\[0\])?)");
  for (const BlockMember& variable : uniform ? program.uniformMembers() : program.storageMembers()) {
    std::smatch match;
    if (!std::regex_match(variable.name, match, member)) continue;
    if (match[1] == "0") layout.offsets[match[2]] = static_cast<size_t>(variable.offset);
    if (match[1] == "1" && second == 0) second = static_cast<size_t>(variable.offset);
    layout.size = static_cast<size_t>(variable.topLevelStride);
  }
  if (uniform)
    layout.size = second;  // std140 members are listed for each element; there is no stride to ask for
  return layout;
}

class SharedLayouts : public tests::GpuTest {};

TEST_F(SharedLayouts, TheTableHoldsEveryStructAndMember) {
  const auto inHeaders = structsInHeaders();
  EXPECT_EQ(inHeaders.size(), cppLayouts().size());
  for (const auto& [name, members] : inHeaders) {
    ASSERT_TRUE(cppLayouts().contains(name)) << name;
    EXPECT_EQ(members.size(), cppLayouts().at(name).offsets.size()) << name;
    for (const std::string& member : members)
      EXPECT_TRUE(cppLayouts().at(name).offsets.contains(member)) << name << "::" << member;
  }
}

TEST_F(SharedLayouts, StorageBlocksMatchCpp) {
  for (const auto& [name, cpp] : cppLayouts()) {
    const Layout driver = driverLayout(device(), name, false);
    EXPECT_EQ(driver.offsets, cpp.offsets) << name;
    EXPECT_EQ(driver.size, cpp.size) << name;
  }
}

TEST_F(SharedLayouts, UniformBlocksMatchCpp) {
  for (const std::string name :
       {"ViewParams", "LightPassParams", "ShadowPassParams", "InterlacedPassParams", "ResolveParams",
        "StressParams", "GridData", "OcclusionParams", "PostParams"}) {
    const Layout driver = driverLayout(device(), name, true);
    EXPECT_EQ(driver.offsets, cppLayouts().at(name).offsets) << name;
    EXPECT_EQ(driver.size, cppLayouts().at(name).size) << name;
  }
}

TEST_F(SharedLayouts, ADifferentLayoutIsSeen) {
  // std140 pads ListLink to 16 bytes an element; were it compared with C++, the test above would fail.
  EXPECT_NE(driverLayout(device(), "ListLink", true).size, cppLayouts().at("ListLink").size);
}

}  // namespace
}  // namespace sfumato::gl
