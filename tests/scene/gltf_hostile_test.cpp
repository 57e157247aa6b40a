// Damaged and hostile glTF files: each is one line of Input error, and nothing else.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "base/error.h"
#include "base/file.h"
#include "base/log.h"
#include "base/random.h"
#include "scene/gltf.h"
#include "tests/image/openimageio.h"
#include "tests/image/png_builder.h"
#include "tests/scene/gltf_builder.h"
#include "tests/scene/gltf_moving.h"

namespace sfumato::scene {
namespace {

namespace fs = std::filesystem;
using test::GltfBuilder;
using test::Json;
using test::TemporaryFolder;

class GltfHostile : public testing::Test {
 protected:
  void SetUp() override {
    if (!test::hasOpenImageIO()) GTEST_SKIP() << "this build has no OpenImageIO to read the scenes' texture";
  }
};

// The error line of a file that must not load; "" when it loads.
std::string errorOf(const fs::path& path, std::optional<double> seconds = {}) {
  try {
    readGltf(path, seconds);
  } catch (const base::Error& error) {
    EXPECT_EQ(error.exitCode, base::ExitCode::Input);
    const std::string line = error.what();
    EXPECT_EQ(line.rfind(path.string() + ": ", 0), 0u) << line;
    EXPECT_EQ(line.find_first_of("\n\r\x1b"), std::string::npos) << line;
    EXPECT_LT(line.size(), 1000u) << line;
    return line;
  }
  return "";
}

std::string errorOf(const std::string& content, const std::string& name = "scene.gltf") {
  const TemporaryFolder folder("gltf_hostile");
  return errorOf(folder.write(name, content));
}

void expectError(const std::string& line, const std::string& part, const std::string& about) {
  EXPECT_NE(line, "") << about << ": loads";
  EXPECT_NE(line.find(part), std::string::npos)
      << about << ": \"" << line << "\" does not say \"" << part << '"';
}

// A scene with one of everything, which loads.
GltfBuilder everything() {
  GltfBuilder gltf = test::triangle();
  Json& attributes = gltf.json["meshes"][0]["primitives"][0]["attributes"];
  attributes["NORMAL"] = gltf.accessor<float>("VEC3", {0, 0, 1, 0, 0, 1, 0, 0, 1});
  attributes["TEXCOORD_0"] = gltf.accessor<float>("VEC2", {0, 0, 1, 0, 0, 1});
  attributes["COLOR_0"] = gltf.accessor<float>("VEC3", std::vector<float>(9, 1.f));
  const std::vector<uint8_t> rows = {1, 2, 3, 4};
  const auto png = test::PngBuilder(2, 2, 8, 0, rows).bytes();
  std::vector<uint8_t> bytes;
  for (std::byte b : png) bytes.push_back(std::to_integer<uint8_t>(b));
  gltf.add("images", {{"bufferView", gltf.view(bytes)}, {"mimeType", "image/png"}});
  gltf.add("samplers", {{"wrapS", 10497}, {"magFilter", 9729}});
  gltf.add("textures", {{"source", 0}, {"sampler", 0}});
  gltf.add(
      "materials",
      {{"name", "paint"},
       {"pbrMetallicRoughness",
        {{"baseColorFactor", {1, 1, 1, 1}}, {"baseColorTexture", {{"index", 0}}}, {"metallicFactor", 0.5}}},
       {"normalTexture",
        {{"index", 0},
         {"extensions",
          {{"KHR_texture_transform", {{"offset", {0.5, 0.5}}, {"rotation", 0.5}, {"scale", {2, 2}}}}}}}},
       {"alphaMode", "BLEND"},
       {"emissiveFactor", {0, 0, 1}},
       {"extensions",
        {{"KHR_materials_transmission", {{"transmissionFactor", 0.5}}},
         {"KHR_materials_specular", {{"specularColorFactor", {1, 1, 1}}}},
         {"KHR_materials_ior", {{"ior", 1.4}}},
         {"KHR_materials_emissive_strength", {{"emissiveStrength", 2.5}}}}}});
  gltf.json["meshes"][0]["primitives"][0]["material"] = 0;
  gltf.json["nodes"][0].update({{"name", "triangle"}, {"scale", {1, -1, 1}}});
  gltf.add("cameras",
           {{"type", "perspective"}, {"perspective", {{"yfov", 0.5}, {"znear", 0.1}, {"zfar", 10.5}}}});
  gltf.add("cameras", {{"type", "orthographic"},
                       {"orthographic", {{"xmag", 1}, {"ymag", 1}, {"znear", 0}, {"zfar", 1}}}});
  gltf.add("nodes", {{"camera", 0}, {"name", "eye"}, {"rotation", {0, 0, 0, 1}}});
  gltf.add("nodes", {{"camera", 1}, {"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 2, 3, 4, 1}}});
  gltf.light({{"type", "spot"},
              {"color", {1, 0.5, 0.25}},
              {"intensity", 10.5},
              {"range", 5.5},
              {"spot", {{"innerConeAngle", 0.1}, {"outerConeAngle", 0.5}}}});
  gltf.json["nodes"][3].update({{"name", "lamp"}, {"translation", {0, 1, 0}}});
  gltf.add("nodes", {{"name", "smoke"},
                     {"extras",
                      {{"volume", "a.vdb"},
                       {"volume_grid", "density"},
                       {"volume_scale", 2.5},
                       {"volume_albedo", {0.5, 0.5, 0.5}},
                       {"volume_g", 0.25}}}});
  gltf.add("nodes", {{"name", "root"}, {"children", {0, 1, 2, 3, 4}}});
  gltf.json["scenes"] = Json::array({{{"nodes", {5}}}});
  gltf.json["scene"] = 0;
  return gltf;
}

TEST(GltfOfAnotherKind, SmokeIsToldWhereItBelongs) {
  expectError(errorOf(std::string(" BDV\0\0\0\0", 8), "smoke.vdb"), "--volume", "an OpenVDB file");
}

TEST_F(GltfHostile, TheSceneToDamageLoads) {
  EXPECT_EQ(errorOf(everything().text()), "");
  EXPECT_EQ(errorOf(everything().binary()), "");
}

struct Damage {
  const char* name;
  std::function<void(Json&)> apply;
  const char* says;
};

Json& primitive(Json& j) {
  return j["meshes"][0]["primitives"][0];
}
Json& volume(Json& j) {
  return j["nodes"][4]["extras"];
}
Json& burning(Json& j) {
  volume(j)["volume_fire"] = "flame";
  return volume(j);
}
Json& light(Json& j) {
  return j["extensions"]["KHR_lights_punctual"]["lights"][0];
}
Json& perspective(Json& j) {
  return j["cameras"][0]["perspective"];
}
Json& orthographic(Json& j) {
  return j["cameras"][1]["orthographic"];
}
Json& extension(Json& j, const char* name) {
  return j["materials"][0]["extensions"][name];
}
Json& textureTransform(Json& j) {
  return j["materials"][0]["normalTexture"]["extensions"]["KHR_texture_transform"];
}
Json sparse(int count, int indexView, int indexType, int valueView) {
  return {{"count", count},
          {"indices", {{"bufferView", indexView}, {"componentType", indexType}}},
          {"values", {{"bufferView", valueView}}}};
}

TEST_F(GltfHostile, EachDamageIsNamed) {
  const Damage damages[] = {
      // Indices between the lists.
      {"scene", [](Json& j) { j["scene"] = 1; }, "scene 1"},
      {"negative scene", [](Json& j) { j["scene"] = -5; }, "scene -5"},
      {"scene's node", [](Json& j) { j["scenes"][0]["nodes"] = {77}; }, "node 77"},
      {"child", [](Json& j) { j["nodes"][5]["children"][0] = 99; }, "node 5 \"root\": there is no node 99"},
      {"negative child", [](Json& j) { j["nodes"][5]["children"][0] = -1; }, "there is no node -1"},
      {"mesh", [](Json& j) { j["nodes"][0]["mesh"] = 1; }, "node 0 \"triangle\": there is no mesh 1"},
      {"negative mesh", [](Json& j) { j["nodes"][0]["mesh"] = -2; }, "there is no mesh -2"},
      {"camera", [](Json& j) { j["nodes"][1]["camera"] = 2; }, "there is no camera 2"},
      {"light", [](Json& j) { j["nodes"][3]["extensions"]["KHR_lights_punctual"]["light"] = 1; }, "light 1"},
      {"light is text", [](Json& j) { j["nodes"][3]["extensions"]["KHR_lights_punctual"]["light"] = "a"; },
       "light is not an integer"},
      {"shadow is text",
       [](Json& j) { j["extensions"]["KHR_lights_punctual"]["lights"][0]["extras"]["shadow"] = "no"; },
       "shadow is not a boolean"},
      {"shadow of a node is a number", [](Json& j) { j["nodes"][3]["extras"]["shadow"] = 0; },
       "shadow is not a boolean"},
      {"light missing", [](Json& j) { j["nodes"][3]["extensions"]["KHR_lights_punctual"] = {{"x", 1}}; },
       "there is no light -1"},
      {"material", [](Json& j) { primitive(j)["material"] = 1; }, "there is no material 1"},
      {"texture", [](Json& j) { j["materials"][0]["normalTexture"]["index"] = 9; }, "there is no texture 9"},
      {"texture in an extension",
       [](Json& j) { extension(j, "KHR_materials_transmission")["transmissionTexture"] = {{"index", 9}}; },
       "there is no texture 9"},
      {"texture info is a number",
       [](Json& j) { extension(j, "KHR_materials_transmission")["transmissionTexture"] = 3; }, "texture -1"},
      {"uv set", [](Json& j) { j["materials"][0]["normalTexture"]["texCoord"] = 2; }, "TEXCOORD_2"},
      {"texture offset of three", [](Json& j) { textureTransform(j)["offset"] = {1, 2, 3}; },
       "offset is not an array of 2 numbers"},
      {"texture scale too large", [](Json& j) { textureTransform(j)["scale"] = {1e300, 1}; }, "texture scale is 1e+300"},
      {"texture rotation is text", [](Json& j) { textureTransform(j)["rotation"] = "left"; },
       "rotation is not a number"},
      {"texture rotation beyond 32 bits", [](Json& j) { textureTransform(j)["rotation"] = 5000000000; }, "rotation"},
      {"texture transform's uv set", [](Json& j) { textureTransform(j)["texCoord"] = 7; }, "TEXCOORD_7"},
      {"image", [](Json& j) { j["textures"][0]["source"] = 4; }, "there is no image 4"},
      {"no image", [](Json& j) { j["textures"][0].erase("source"); }, "there is no image -1"},
      {"sampler", [](Json& j) { j["textures"][0]["sampler"] = 4; }, "there is no sampler 4"},
      {"wrap", [](Json& j) { j["samplers"][0]["wrapS"] = 1; }, "wrap mode 1"},
      {"magFilter", [](Json& j) { j["samplers"][0]["magFilter"] = 9984; }, "magFilter 9984"},
      {"minFilter", [](Json& j) { j["samplers"][0]["minFilter"] = 7; }, "minFilter 7"},
      {"position accessor", [](Json& j) { primitive(j)["attributes"]["POSITION"] = 99; }, "accessor 99"},
      {"negative accessor", [](Json& j) { primitive(j)["attributes"]["NORMAL"] = -1; }, "accessor -1"},
      {"indices accessor", [](Json& j) { primitive(j)["indices"] = 99; }, "out of bounds"},
      {"negative indices accessor", [](Json& j) { primitive(j)["indices"] = -2; }, "accessor -2"},
      {"accessor's view", [](Json& j) { j["accessors"][0]["bufferView"] = 99; }, "buffer view 99"},
      {"negative view", [](Json& j) { j["accessors"][0]["bufferView"] = -2; }, "buffer view -2"},
      {"view's buffer", [](Json& j) { j["bufferViews"][0]["buffer"] = 1; }, "there is no buffer 1"},
      {"negative buffer", [](Json& j) { j["bufferViews"][0]["buffer"] = -1; }, "there is no buffer -1"},
      {"image's view", [](Json& j) { j["images"][0]["bufferView"] = 99; }, "bufferView \"99\" not found"},
      {"image's buffer", [](Json& j) { j["bufferViews"].back()["buffer"] = 7; }, "buffer \"7\" not found"},

      // Bytes.
      {"view beyond buffer", [](Json& j) { j["bufferViews"][0]["byteLength"] = 100000; }, "reaches beyond"},
      {"view offset beyond", [](Json& j) { j["bufferViews"][0]["byteOffset"] = 100000; }, "reaches beyond"},
      {"view offset that wraps", [](Json& j) { j["bufferViews"][0]["byteOffset"] = 0xffffffffffffffffu; },
       "reaches beyond"},
      {"view length that wraps", [](Json& j) { j["bufferViews"][0]["byteLength"] = 0xffffffffffffffffu; },
       "reaches beyond"},
      {"image view beyond buffer", [](Json& j) { j["bufferViews"].back()["byteOffset"] = 1u << 31; },
       "reaches beyond"},
      {"image view offset that wraps",
       [](Json& j) { j["bufferViews"].back()["byteOffset"] = 0xfffffffffffffff0u; }, "reaches beyond"},
      {"accessor beyond view", [](Json& j) { j["accessors"][0]["count"] = 4; }, "reach beyond buffer view 0"},
      {"accessor offset", [](Json& j) { j["accessors"][0]["byteOffset"] = 4; }, "reach beyond"},
      {"accessor offset that wraps", [](Json& j) { j["accessors"][0]["byteOffset"] = 0xfffffffffffffffcu; },
       "reach beyond"},
      {"count that wraps", [](Json& j) { j["accessors"][0]["count"] = 0xffffffffffffffffu; }, "more than"},
      {"count times stride that wraps", [](Json& j) { j["accessors"][0]["count"] = 0x1555555555555556u; },
       "more than"},
      {"huge count of zeros",
       [](Json& j) {
         j["accessors"][0].erase("bufferView");
         j["accessors"][0]["count"] = 1u << 31;
       },
       "more than"},
      {"negative count", [](Json& j) { j["accessors"][0]["count"] = -3; }, "positive integer"},
      {"no count", [](Json& j) { j["accessors"][0].erase("count"); }, "count"},
      {"empty accessor", [](Json& j) { j["accessors"][0]["count"] = 0; }, "is empty"},
      {"negative offset", [](Json& j) { j["accessors"][0]["byteOffset"] = -4; }, "\"byteOffset\""},
      {"broken offset", [](Json& j) { j["accessors"][0]["byteOffset"] = 0.5; }, "\"byteOffset\""},
      {"stride below size", [](Json& j) { j["bufferViews"][0]["byteStride"] = 4; }, "reach beyond"},
      {"stride beyond view", [](Json& j) { j["bufferViews"][0]["byteStride"] = 252; }, "reach beyond"},
      {"stride too large", [](Json& j) { j["bufferViews"][0]["byteStride"] = 1 << 30; }, "byteStride"},
      {"component type", [](Json& j) { j["accessors"][0]["componentType"] = 5124; }, "component type 5124"},
      {"double", [](Json& j) { j["accessors"][0]["componentType"] = 5130; }, "component type 5130"},
      {"no component type", [](Json& j) { j["accessors"][0]["componentType"] = 1; }, "componentType"},
      {"type", [](Json& j) { j["accessors"][0]["type"] = "VEC2"; }, "does not have 3 component"},
      {"unknown type", [](Json& j) { j["accessors"][0]["type"] = "VEC9"; }, "VEC9"},
      {"colour type", [](Json& j) { primitive(j)["attributes"]["COLOR_0"] = 3; }, "does not have 3 component"},
      {"float indices", [](Json& j) { primitive(j)["indices"] = 0; }, "not plain unsigned integers"},
      {"attribute of other length",
       [](Json& j) {
         j["accessors"][2]["count"] = 2;
       },
       "NORMAL: has 2 elements for 3 vertices"},
      {"index out of range", [](Json& j) { j["accessors"][0]["count"] = 2; }, "index 2 is 2"},
      {"half a triangle", [](Json& j) { j["accessors"][1]["count"] = 2; }, "not whole triangles"},
      {"no position", [](Json& j) { primitive(j)["attributes"].erase("POSITION"); }, "no POSITION"},
      {"mode", [](Json& j) { primitive(j)["mode"] = 7; }, "mode 7"},
      {"negative mode", [](Json& j) { primitive(j)["mode"] = -1; }, "mode -1"},

      // Sparse accessors: view 0 holds floats, view 1 the bytes 0 0 1 0 2 0.
      {"sparse index beyond",
       [](Json& j) {
         j["accessors"][0]["sparse"] = sparse(1, 0, 5125, 0);
         j["accessors"][0]["sparse"]["indices"]["byteOffset"] = 12;  // 1.0f as an integer
       },
       "sparse index 1065353216 is beyond"},
      {"sparse index offset that wraps",
       [](Json& j) {
         j["accessors"][0]["sparse"] = sparse(1, 0, 5125, 0);
         j["accessors"][0]["sparse"]["indices"]["byteOffset"] = 0x80000000u;
       },
       "sparse"},
      {"sparse count 0", [](Json& j) { j["accessors"][0]["sparse"] = sparse(0, 1, 5123, 0); }, "sparse"},
      {"sparse negative count", [](Json& j) { j["accessors"][0]["sparse"] = sparse(-1, 1, 5123, 0); }, "sparse"},
      {"sparse count above", [](Json& j) { j["accessors"][0]["sparse"] = sparse(4, 1, 5121, 0); }, "sparse"},
      {"sparse view", [](Json& j) { j["accessors"][0]["sparse"] = sparse(1, 99, 5123, 0); }, "buffer view 99"},
      {"sparse value view", [](Json& j) { j["accessors"][0]["sparse"] = sparse(1, 1, 5123, -1); },
       "buffer view -1"},
      {"sparse values beyond", [](Json& j) { j["accessors"][0]["sparse"] = sparse(1, 1, 5123, 1); },
       "reach beyond"},
      {"sparse index type", [](Json& j) { j["accessors"][0]["sparse"] = sparse(1, 1, 5126, 0); }, "sparse"},
      {"sparse is a number", [](Json& j) { j["accessors"][0]["sparse"] = 5; }, "count"},
      {"sparse without indices", [](Json& j) { j["accessors"][0]["sparse"] = {{"count", 1}}; }, "indices"},

      // Buffers and pictures.
      {"missing buffer file", [](Json& j) { j["buffers"] = {{{"byteLength", 4}, {"uri", "no.bin"}}}; }, "no.bin"},
      {"folder as buffer", [](Json& j) { j["buffers"] = {{{"byteLength", 4}, {"uri", "."}}}; },
       "not a regular file"},
      {"device as buffer", [](Json& j) { j["buffers"] = {{{"byteLength", 4}, {"uri", "../../dev/zero"}}}; }, ""},
      {"uri is a number", [](Json& j) { j["buffers"] = {{{"byteLength", 4}, {"uri", 5}}}; }, "uri"},
      {"no uri", [](Json& j) { j["buffers"] = {{{"byteLength", 4}}}; }, "uri"},
      {"data uri of other length",
       [](Json& j) { j["buffers"][0]["byteLength"] = 3; }, "Failed to decode"},
      {"garbage data uri",
       [](Json& j) {
         j["buffers"] = {{{"byteLength", 4}, {"uri", "data:application/octet-stream;base64,****"}}};
       },
       "Failed to decode"},
      {"data uri of unknown kind",
       [](Json& j) { j["buffers"] = {{{"byteLength", 4}, {"uri", "data:a;base64,AAAA"}}}; }, "data:a;base64"},
      {"uri with a line break", [](Json& j) { j["buffers"] = {{{"byteLength", 4}, {"uri", "a%0Ab\nc.bin"}}}; },
       "a b c.bin"},
      {"long uri", [](Json& j) { j["buffers"] = {{{"byteLength", 4}, {"uri", std::string(100000, 'x')}}}; }, "xxx"},
      {"buffer is text", [](Json& j) { j["buffers"][0] = "x"; }, "buffers"},
      {"negative buffer length", [](Json& j) { j["buffers"][0]["byteLength"] = -1; }, "byteLength"},
      {"image is no picture",
       [](Json& j) { j["images"][0] = {{"uri", "data:image/png;base64,AAAAAAAA"}}; },
       "image 0: is not a PNG or JPEG"},
      {"image view is no picture", [](Json& j) { j["images"][0]["bufferView"] = 0; }, "is not a PNG or JPEG"},
      {"missing image file", [](Json& j) { j["images"][0] = {{"uri", "no.png"}}; }, "no.png"},
      {"image uri is a number", [](Json& j) { j["images"][0] = {{"uri", 7}}; }, "uri"},
      {"image without source", [](Json& j) { j["images"][0] = {{"name", "x"}}; }, "uri"},
      {"image from both", [](Json& j) { j["images"][0]["uri"] = "a.png"; }, "Only one"},

      // The node graph and its transforms.
      {"cycle", [](Json& j) { j["nodes"][0]["children"] = {5}; }, "its own ancestor"},
      {"its own child", [](Json& j) { j["nodes"].push_back({{"children", {6}}}); }, "its own ancestor"},
      {"two parents", [](Json& j) { j["nodes"].push_back({{"children", {2}}}); }, "child of both"},
      {"child named twice", [](Json& j) { j["nodes"][5]["children"].push_back(0); }, "child of both"},
      {"scene names a child", [](Json& j) { j["scenes"][0]["nodes"] = {0}; }, "is no root"},
      {"scene names a root twice", [](Json& j) { j["scenes"][0]["nodes"] = {5, 5}; }, "there twice"},
      {"short matrix", [](Json& j) { j["nodes"][2]["matrix"] = {1, 2, 3}; }, "16 numbers"},
      {"perspective matrix", [](Json& j) { j["nodes"][2]["matrix"][3] = 1; }, "not affine"},
      {"long translation", [](Json& j) { j["nodes"][0]["translation"] = {1, 2, 3, 4}; }, "3 numbers"},
      {"text in scale", [](Json& j) { j["nodes"][0]["scale"] = {1, 2, "x"}; }, "3 numbers"},
      {"short rotation", [](Json& j) { j["nodes"][0]["rotation"] = {0, 0, 1}; }, "4 numbers"},
      {"zero rotation", [](Json& j) { j["nodes"][0]["rotation"] = {0, 0, 0, 0}; }, "not a quaternion"},
      {"infinite transform",
       [](Json& j) {
         j["nodes"][5]["scale"] = {1e300, 1e300, 1e300};
         j["nodes"][0]["scale"] = {1e300, 1e300, 1e300};
       },
       "not finite"},
      {"too far away", [](Json& j) { j["nodes"][0]["translation"] = {0, 2e12, 0}; }, "reaches 2e+12 m"},
      {"too large", [](Json& j) { j["nodes"][0]["scale"] = {1e30, 1, 1}; }, "reaches 1e+30 m"},
      {"huge transform", [](Json& j) { j["nodes"][0]["translation"] = {1e39, 0, 0}; }, "not finite"},

      // Cameras.
      {"yfov 0", [](Json& j) { perspective(j)["yfov"] = 0; }, "node 1 \"eye\": camera yfov is 0"},
      {"yfov all but 0", [](Json& j) { perspective(j)["yfov"] = 1e-300; }, "yfov is 1e-300"},
      {"yfov negative", [](Json& j) { perspective(j)["yfov"] = -1; }, "yfov is -1"},
      {"yfov pi", [](Json& j) { perspective(j)["yfov"] = 3.1415926535897932; }, "yfov"},
      {"no yfov", [](Json& j) { perspective(j).erase("yfov"); }, "yfov"},
      {"yfov text", [](Json& j) { perspective(j)["yfov"] = "wide"; }, "yfov"},
      {"znear 0", [](Json& j) { perspective(j)["znear"] = 0; }, "znear is 0"},
      {"zfar at znear", [](Json& j) { perspective(j)["zfar"] = 0.1; }, "zfar 0.1 is not beyond"},
      {"zfar negative", [](Json& j) { perspective(j)["zfar"] = -5; }, "zfar -5 is not beyond"},
      {"ymag 0", [](Json& j) { orthographic(j)["ymag"] = 0; }, "ymag is 0"},
      {"ymag all but 0", [](Json& j) { orthographic(j)["ymag"] = 1e-300; }, "ymag is 1e-300"},
      {"ymag without end", [](Json& j) { orthographic(j)["ymag"] = 1e300; }, "ymag is 1e+300"},
      {"orthographic znear", [](Json& j) { orthographic(j)["znear"] = -1; }, "znear is -1"},
      {"orthographic zfar", [](Json& j) { orthographic(j)["zfar"] = 0; }, "zfar 0 is not beyond"},
      {"camera type", [](Json& j) { j["cameras"][0]["type"] = "fisheye"; }, "fisheye"},
      {"camera without direction", [](Json& j) { j["nodes"][1]["scale"] = {1, 1, 0}; }, "no direction"},
      {"camera without up", [](Json& j) { j["nodes"][1]["scale"] = {1, 0, 1}; }, "no direction"},

      // Lights.
      {"light type", [](Json& j) { light(j)["type"] = "area"; }, "node 3 \"lamp\": light type \"area\""},
      {"no light type", [](Json& j) { light(j).erase("type"); }, "type"},
      {"negative intensity", [](Json& j) { light(j)["intensity"] = -1; }, "light intensity is -1"},
      {"huge intensity", [](Json& j) { light(j)["intensity"] = 1e300; }, "light intensity"},
      {"negative colour", [](Json& j) { light(j)["color"] = {1, -1, 1}; }, "light colour is -1"},
      {"short colour", [](Json& j) { light(j)["color"] = {1, 1}; }, "3 numbers"},
      {"negative range", [](Json& j) { light(j)["range"] = -2; }, "light range is -2"},
      {"cones swapped", [](Json& j) { light(j)["spot"]["innerConeAngle"] = 0.6; }, "cones are 0.6 and 0.5"},
      {"cones equal", [](Json& j) { light(j)["spot"]["innerConeAngle"] = 0.5; }, "cones are"},
      {"inner cone negative", [](Json& j) { light(j)["spot"]["innerConeAngle"] = -0.1; }, "cones are"},
      {"outer cone too wide", [](Json& j) { light(j)["spot"]["outerConeAngle"] = 1.6; }, "cones are"},
      {"no spot", [](Json& j) { light(j).erase("spot"); }, "Spot"},
      {"spot without direction", [](Json& j) { j["nodes"][3]["scale"] = {0, 0, 0}; }, "no direction"},

      // Materials.
      {"base colour", [](Json& j) { j["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"][0] = 2; },
       "material 0 \"paint\": baseColorFactor is 2"},
      {"metallic", [](Json& j) { j["materials"][0]["pbrMetallicRoughness"]["metallicFactor"] = -1; },
       "metallicFactor is -1"},
      {"roughness", [](Json& j) { j["materials"][0]["pbrMetallicRoughness"]["roughnessFactor"] = 1e300; },
       "roughnessFactor"},
      {"emission", [](Json& j) { j["materials"][0]["emissiveFactor"] = {0, -1, 0}; }, "emissiveFactor is -1"},
      {"emissive strength", [](Json& j) { extension(j, "KHR_materials_emissive_strength")["emissiveStrength"] = -1; },
       "emissiveStrength is -1"},
      {"alpha mode", [](Json& j) { j["materials"][0]["alphaMode"] = "GLOW"; }, "alphaMode \"GLOW\""},
      {"alpha cutoff", [](Json& j) { j["materials"][0]["alphaCutoff"] = -1; }, "alphaCutoff is -1"},
      {"transmission", [](Json& j) { extension(j, "KHR_materials_transmission")["transmissionFactor"] = 1.5; },
       "transmissionFactor is 1.5"},
      {"transmission is text",
       [](Json& j) { extension(j, "KHR_materials_transmission")["transmissionFactor"] = "full"; },
       "transmissionFactor is not a number"},
      {"specular colour", [](Json& j) { extension(j, "KHR_materials_specular")["specularColorFactor"] = {1, 1}; },
       "not an array of 3 numbers"},
      {"ior", [](Json& j) { extension(j, "KHR_materials_ior")["ior"] = 0.5; }, "ior is 0.5"},
      {"shadow_self is a number", [](Json& j) { j["materials"][0]["extras"]["shadow_self"] = 0; },
       "material 0 \"paint\": shadow_self is not a boolean"},
      {"shadow_once is text", [](Json& j) { j["materials"][0]["extras"]["shadow_once"] = "yes"; },
       "material 0 \"paint\": shadow_once is not a boolean"},
      {"shadow_rim is true", [](Json& j) { j["materials"][0]["extras"]["shadow_rim"] = true; },
       "material 0 \"paint\": shadow_rim is not a number"},
      {"shadow_rim negative", [](Json& j) { j["materials"][0]["extras"]["shadow_rim"] = -0.5; },
       "material 0 \"paint\": shadow_rim is -0.5"},
      {"shadow_rim beyond floats", [](Json& j) { j["materials"][0]["extras"]["shadow_rim"] = 1e300; },
       "material 0 \"paint\": shadow_rim is 1e+300"},

      // Ambient light.
      {"ambient is a number", [](Json& j) { j["scenes"][0]["extras"]["ambient"] = 1; },
       "scene 0: ambient is not an array of 3 numbers"},
      {"ambient below 0", [](Json& j) { j["scenes"][0]["extras"]["ambient"] = {0, -1, 0}; }, "ambient is -1"},
      {"ambient beyond sense", [](Json& j) { j["scenes"][0]["extras"]["ambient"] = {0, 0, 1e7}; }, "ambient is 1"},
      {"ambient with text", [](Json& j) { j["scenes"][0]["extras"]["ambient"] = {"a", 0, 0}; }, "not an array of 3"},

      // Volumes.
      {"volume is a number", [](Json& j) { volume(j)["volume"] = 3; }, "node 4 \"smoke\": volume is not a string"},
      {"volume is empty", [](Json& j) { volume(j)["volume"] = ""; }, "volume is empty"},
      {"grid is a number", [](Json& j) { volume(j)["volume_grid"] = 3; }, "volume_grid is not a string"},
      {"scale is text", [](Json& j) { volume(j)["volume_scale"] = "7"; }, "volume_scale is not a number"},
      {"scale negative", [](Json& j) { volume(j)["volume_scale"] = -1; }, "volume_scale is -1"},
      {"scale beyond 32 bits", [](Json& j) { volume(j)["volume_scale"] = 5000000000; }, "volume_scale"},
      {"extinction below 0", [](Json& j) { volume(j)["volume_extinction"] = {0, -0.5, 1}; }, "volume_extinction is -0.5"},
      {"extinction beyond sense", [](Json& j) { volume(j)["volume_extinction"] = {0, 1e7, 1}; }, "volume_extinction is 1"},
      {"extinction is a number", [](Json& j) { volume(j)["volume_extinction"] = 0.5; }, "not an array of 3 numbers"},
      {"albedo above 1", [](Json& j) { volume(j)["volume_albedo"] = {0, 0, 1.01}; }, "volume_albedo is 1.01"},
      {"albedo below 0", [](Json& j) { volume(j)["volume_albedo"] = {0, -0.5, 1}; }, "volume_albedo is -0.5"},
      {"albedo is a number", [](Json& j) { volume(j)["volume_albedo"] = 0.5; }, "not an array of 3 numbers"},
      {"albedo of four", [](Json& j) { volume(j)["volume_albedo"] = {0, 0, 0, 0}; }, "not an array of 3 numbers"},
      {"albedo with text", [](Json& j) { volume(j)["volume_albedo"] = {0, "x", 0}; }, "not an array of 3 numbers"},
      {"fire is a number", [](Json& j) { volume(j)["volume_fire"] = 1; }, "volume_fire is not a string"},
      {"fire without a grid", [](Json& j) { volume(j)["volume_fire_lights"] = 1; }, "volume_fire_lights without a grid"},
      {"fire of 0 K", [](Json& j) { burning(j)["volume_fire_kelvin"] = 0; }, "volume_fire_kelvin is 0"},
      {"fire too bright", [](Json& j) { burning(j)["volume_fire_strength"] = 1e7; }, "volume_fire_strength is 1"},
      {"fire of two looks",
       [](Json& j) {
         burning(j)["volume_fire_kelvin"] = 5;
         burning(j)["volume_fire_ramp"] = {{0, 0, 0}, {1, 1, 1}};
       },
       "give one of them"},
      {"fire of one colour", [](Json& j) { burning(j)["volume_fire_ramp"] = Json::array({{0, 0, 0}}); }, "not an array of 2"},
      {"fire ramp is text", [](Json& j) { burning(j)["volume_fire_ramp"] = "red"; }, "not an array of 2"},
      {"fire colour of two", [](Json& j) { burning(j)["volume_fire_ramp"] = {{0, 0, 0}, {1, 1}}; }, "not three numbers"},
      {"fire colour of text", [](Json& j) { burning(j)["volume_fire_ramp"] = {{0, 0, 0}, {1, "x", 1}}; }, "not three numbers"},
      {"fire colour below 0", [](Json& j) { burning(j)["volume_fire_ramp"] = {{0, 0, 0}, {1, -1, 1}}; }, "volume_fire_ramp is -1"},
      {"fire of 65 lights", [](Json& j) { burning(j)["volume_fire_lights"] = 65; }, "volume_fire_lights is 65"},
      {"fire of half a light", [](Json& j) { burning(j)["volume_fire_lights"] = 0.5; }, "not an integer"},
      {"g of 1", [](Json& j) { volume(j)["volume_g"] = 1; }, "volume_g is 1"},
      {"g of -1", [](Json& j) { volume(j)["volume_g"] = -1.0; }, "volume_g is -1"},
      {"g is true", [](Json& j) { volume(j)["volume_g"] = true; }, "volume_g is not a number"},
      {"volume without extent", [](Json& j) { j["nodes"][4]["scale"] = {1, 0, 1}; }, "no extent"},

      // The whole.
      {"required extension", [](Json& j) { j["extensionsRequired"] = {"KHR_draco_mesh_compression"}; },
       "\"KHR_draco_mesh_compression\""},
      {"required extension with a line break", [](Json& j) { j["extensionsRequired"] = {"A\nB\x1b[0m"}; }, "A B"},
      {"glTF 1", [](Json& j) { j["asset"]["version"] = "1.0"; }, "glTF 1.0"},
      {"no version", [](Json& j) { j["asset"].erase("version"); }, "asset"},
      {"no asset", [](Json& j) { j.erase("asset"); }, "asset"},
      {"node name with a line break",
       [](Json& j) {
         j["nodes"][0]["name"] = "a\nb";
         j["nodes"][0]["mesh"] = 5;
       },
       "\"a b\""},
      {"accessors hold text", [](Json& j) { j["accessors"][0] = "x"; }, "accessors"},
      {"nodes hold text", [](Json& j) { j["nodes"][0] = "x"; }, "nodes"},
  };
  const TemporaryFolder folder("gltf_damages");
  for (const Damage& damage : damages) {
    GltfBuilder gltf = everything();
    gltf.json = Json::parse(gltf.text());  // with its buffer in it
    damage.apply(gltf.json);
    expectError(errorOf(folder.write("scene.gltf", gltf.json.dump())), damage.says, damage.name);
  }
}

// The ribbon with a morph target; its weights and its elbow move.
GltfBuilder moving() {
  GltfBuilder gltf = test::bendingRibbon();
  std::vector<float> offsets(18, 0.5f);
  gltf.json["meshes"][0]["primitives"][0]["targets"] =
      Json::array({{{"POSITION", gltf.accessor<float>("VEC3", offsets)}}});
  gltf.json["meshes"][0]["weights"] = {0.5};
  Json& animation = gltf.json["animations"][0];
  animation["samplers"].push_back({{"input", gltf.accessor<float>("SCALAR", {0, 1, 2})},
                                   {"output", gltf.accessor<float>("SCALAR", {0, 1, 0, 0, 0.5f, 0, 0, 1, 0})},
                                   {"interpolation", "CUBICSPLINE"}});
  animation["channels"].push_back({{"sampler", 1}, {"target", {{"node", 0}, {"path", "weights"}}}});
  return gltf;
}

constexpr double posed = 0.75;  // seconds

TEST_F(GltfHostile, EachDamageToWhatMovesIsNamed) {
  ASSERT_EQ(errorOf(moving().text()), "");
  // Accessors: 0 positions, 1 normals, 2 joints, 3 weights, 4 indices, 5 binds, 6 times, 7 turns, 8 morph
  // target, 9 times, 10 weights.
  const auto channel = [](Json& j) -> Json& { return j["animations"][0]["channels"][0]; };
  const auto sampler = [](Json& j) -> Json& { return j["animations"][0]["samplers"][0]; };
  const auto attributes = [](Json& j) -> Json& { return primitive(j)["attributes"]; };
  const Damage damages[] = {
      {"channel's sampler", [&](Json& j) { channel(j)["sampler"] = 9; },
       "animation 0 channel 0: there is no sampler 9"},
      {"channel's node", [&](Json& j) { channel(j)["target"]["node"] = 99; }, "there is no node 99"},
      {"negative node", [&](Json& j) { channel(j)["target"]["node"] = -2; }, "there is no node -2"},
      {"input", [&](Json& j) { sampler(j)["input"] = 99; }, "channel 0 input: there is no accessor 99"},
      {"output", [&](Json& j) { sampler(j)["output"] = -3; }, "channel 0 output: there is no accessor -3"},
      {"input of triples", [&](Json& j) { sampler(j)["input"] = 0; }, "does not have 1 component"},
      {"output of triples", [&](Json& j) { sampler(j)["output"] = 0; }, "does not have 4 component"},
      {"input descends", [&](Json& j) { sampler(j)["input"] = 10; }, "input: key 2 is not later than"},
      {"too few outputs", [&](Json& j) { sampler(j)["input"] = 9; }, "has 8 numbers, but 3 keys need 12"},
      {"cubic without tangents", [&](Json& j) { sampler(j)["interpolation"] = "CUBICSPLINE"; },
       "has 8 numbers, but 2 keys need 24"},
      {"interpolation", [&](Json& j) { sampler(j)["interpolation"] = "SMOOTH"; }, "interpolation \"SMOOTH\""},
      {"matrix animated",
       [](Json& j) {
         j["nodes"][2] = {{"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 2, 3, 4, 1}}};
       },
       "node 2 has a matrix"},
      {"weights of a node without a mesh",
       [](Json& j) { j["animations"][0]["channels"][1]["target"]["node"] = 1; }, "there is no mesh -1"},
      {"weights without targets", [](Json& j) { primitive(j).erase("targets"); }, "has no morph targets"},
      {"rotation of nothing", [](Json& j) { j["accessors"][7].erase("bufferView"); }, "not a quaternion"},

      {"target's accessor", [](Json& j) { primitive(j)["targets"][0]["POSITION"] = 99; },
       "morph target 0 POSITION: there is no accessor 99"},
      {"target of other length", [](Json& j) { j["accessors"][8]["count"] = 5; },
       "5 elements for 6 vertices"},
      {"target of pairs", [](Json& j) { j["accessors"][8]["type"] = "VEC2"; }, "does not have 3 component"},
      {"weights of the mesh",
       [](Json& j) {
         j["animations"][0]["channels"].erase(1);
         j["meshes"][0]["weights"] = {1, 2};
       },
       "2 weights for 1 morph targets"},
      {"weights of the node",
       [](Json& j) {
         j["animations"][0]["channels"].erase(1);
         j["nodes"][0]["weights"] = {1, 2};
       },
       "2 weights for 1 morph targets"},
      {"huge weight",
       [](Json& j) {
         j["animations"][0]["channels"].erase(1);
         j["nodes"][0]["weights"] = {1e300};
       },
       "morph weight is 1e+300"},
      {"weight that leads to infinity",
       [](Json& j) {
         j["animations"][0]["channels"].erase(1);
         j["nodes"][0]["weights"] = {3e38};
         j["nodes"][1]["scale"] = {100, 100, 100};
       },
       "moved to where it is not finite"},
      {"second primitive without targets",
       [](Json& j) {
         Json& primitives = j["meshes"][0]["primitives"];
         primitives.push_back(primitives[0]);
         primitives[1].erase("targets");
       },
       "primitive 1: has 0 morph targets for 1 weights"},

      {"skin", [](Json& j) { j["nodes"][0]["skin"] = 1; }, "there is no skin 1"},
      {"negative skin", [](Json& j) { j["nodes"][0]["skin"] = -7; }, "there is no skin -7"},
      {"joint's node",
       [](Json& j) {
         j["skins"][0]["joints"] = {1, 99};
       },
       "skin 0: there is no node 99"},
      {"negative joint",
       [](Json& j) {
         j["skins"][0]["joints"] = {1, -1};
       },
       "skin 0: there is no node -1"},
      {"no joints", [](Json& j) { j["skins"][0]["joints"] = Json::array(); }, "skin 0: has no joints"},
      {"joint out of range", [](Json& j) { j["skins"][0]["joints"] = {1}; },
       "follows joint 1, but the skin has 1"},
      {"joint outside the scene",
       [](Json& j) {
         j["scenes"] = {{{"nodes", {0}}}};
       },
       "node 1 \"shoulder\", is not in the scene"},
      {"cyclic skeleton", [](Json& j) { j["nodes"][2]["children"] = {1}; }, "its own ancestor"},
      {"inverse bind matrices", [](Json& j) { j["skins"][0]["inverseBindMatrices"] = 99; },
       "there is no accessor 99"},
      {"too few of them", [](Json& j) { j["accessors"][5]["count"] = 1; },
       "1 inverse bind matrices for 2 joints"},
      {"of vectors", [](Json& j) { j["skins"][0]["inverseBindMatrices"] = 0; }, "does not have 16 component"},
      {"perspective ones", [](Json& j) { j["bufferViews"][5]["byteOffset"] = 0; }, "not affine"},
      {"no joints of vertices", [&](Json& j) { attributes(j).erase("JOINTS_0"); },
       "no JOINTS_0 and WEIGHTS_0"},
      {"no weights of vertices", [&](Json& j) { attributes(j).erase("WEIGHTS_0"); },
       "no JOINTS_0 and WEIGHTS_0"},
      {"half a second set", [&](Json& j) { attributes(j)["JOINTS_1"] = 2; },
       "only one of JOINTS_1 and WEIGHTS_1"},
      {"joints of other length", [](Json& j) { j["accessors"][2]["count"] = 5; },
       "5 elements for 6 vertices"},
      {"weights are all 0", [](Json& j) { j["accessors"][3].erase("bufferView"); },
       "vertex 0 follows no joint"},
      {"huge skeleton",
       [](Json& j) {
         j["nodes"][1]["scale"] = {1e39, 1e39, 1e39};
       },
       "not finite"},
  };
  const TemporaryFolder folder("gltf_moving");
  for (const Damage& damage : damages) {
    GltfBuilder gltf = moving();
    gltf.json = Json::parse(gltf.text());
    damage.apply(gltf.json);
    expectError(errorOf(folder.write("scene.gltf", gltf.json.dump()), posed), damage.says, damage.name);
  }
}

TEST_F(GltfHostile, WeightsThatAreNoWeights) {
  for (const float bad : {std::nanf(""), std::numeric_limits<float>::infinity(), -0.5f}) {
    GltfBuilder gltf = moving();
    std::vector<float> weights(24, 0.25f);
    weights[21] = bad;
    gltf.json["meshes"][0]["primitives"][0]["attributes"]["WEIGHTS_0"] =
        gltf.accessor<float>("VEC4", weights);
    expectError(errorOf(gltf.text()), bad < 0 ? "a weight of vertex 5 is -0.5" : "element 5 is not finite",
                "weight");
  }
}

TEST_F(GltfHostile, NonFiniteVertices) {
  const float nan = std::nanf(""), inf = std::numeric_limits<float>::infinity();
  for (const float bad : {nan, inf, -inf}) {
    GltfBuilder gltf;
    gltf.meshNode(
        {{"attributes", {{"POSITION", gltf.accessor<float>("VEC3", {0, 0, 0, 1, bad, 0, 0, 1, 0})}}}});
    expectError(errorOf(gltf.text()), "mesh 0 primitive 0 POSITION: element 1 is not finite", "position");
  }
}

TEST_F(GltfHostile, IndexBeyondTheVertices) {
  for (const uint16_t bad : {uint16_t{3}, uint16_t{65535}}) {
    GltfBuilder gltf;
    const int position = gltf.accessor<float>("VEC3", std::vector<float>(9));
    const int indices = gltf.accessor<uint16_t>("SCALAR", {0, 1, bad});
    gltf.meshNode({{"attributes", {{"POSITION", position}}}, {"indices", indices}});
    expectError(errorOf(gltf.text()), "index 2 is " + std::to_string(bad), "index");
  }
}

TEST_F(GltfHostile, FilesThatAreNoScenes) {
  const TemporaryFolder folder("gltf_none");
  expectError(errorOf(folder.path() / "missing.gltf"), "cannot be read", "missing");
  expectError(errorOf(folder.path()), "is a folder", "folder");
  expectError(errorOf(std::string()), "is empty", "empty");
  for (const char* text :
       {"{", "[]", "5", "null", "\"glTF\"", "{}", "hello, world", "{\"asset\": 5}", "\xff\xfe{}",
        "{\"asset\":{\"version\":\"2.0\"}} x", "{\"asset\":{\"version\":\"2.0\"}, \"a\": 1e999}"})
    expectError(errorOf(std::string(text)), ": ", text);
}

TEST_F(GltfHostile, NestedJsonDoesNotExhaustTheStack) {
  for (const char* place : {"\"extras\":", "\"extensions\":{\"a\":", "\"b\":"})
    for (const auto& [open, close] : {std::pair{"[", "]"}, std::pair{"{\"a\":", "}"}}) {
      std::string text = std::string("{\"asset\":{\"version\":\"2.0\"},") + place;
      for (int i = 0; i < 1'000'000; ++i) text += open;
      expectError(errorOf(text), "nested deeper", place);
      text += "1";
      for (int i = 0; i < 1'000'000; ++i) text += close;
      expectError(errorOf(text + "}"), "nested deeper", place);
    }
}

TEST_F(GltfHostile, FewBytesCannotAskForMuchMemory) {
  {
    GltfBuilder gltf;  // each buffer would be a copy of the binary chunk
    gltf.buffer.resize(1 << 20);
    for (int i = 0; i < 20000; ++i) gltf.json["buffers"].push_back({{"byteLength", 1 << 20}});
    expectError(errorOf(gltf.binary()), "has no uri", "buffers");
  }
  {
    GltfBuilder gltf;  // each primitive would be a copy of its vertices
    const int position = gltf.accessor<float>("VEC3", std::vector<float>(300'000));
    Json primitives = Json::array();
    for (int i = 0; i < 10000; ++i)
      primitives.push_back({{"attributes", {{"POSITION", position}}}, {"indices", i % 2}});
    gltf.accessor<uint8_t>("SCALAR", {0, 1, 2});
    for (auto& primitive : primitives) primitive["indices"] = 1;
    gltf.add("meshes", {{"primitives", primitives}});
    gltf.add("nodes", {{"mesh", 0}});
    expectError(errorOf(gltf.binary()), "vertices and indices", "primitives");
  }
  {
    GltfBuilder gltf = test::triangle();  // each node draws each primitive
    Json& primitives = gltf.json["meshes"][0]["primitives"];
    while (primitives.size() < 3000) primitives.push_back(Json(primitives[0]));
    while (gltf.json["nodes"].size() < 3000) gltf.json["nodes"].push_back({{"mesh", 0}});
    expectError(errorOf(gltf.text()), "primitives", "instances");
  }
  {
    GltfBuilder gltf;
    std::string ones = "[1";
    for (int i = 0; i < 9'000'000; ++i) ones += ",1";
    expectError(errorOf("{\"asset\":{\"version\":\"2.0\"},\"extras\":" + ones + "]}"), "JSON values",
                "values");
  }
}

void putWord(std::string& file, size_t at, uint32_t value) {
  for (size_t i = 0; i < 4; ++i) file[at + i] = static_cast<char>(value >> (8 * i) & 0xff);
}

TEST_F(GltfHostile, BinaryContainerThatLies) {
  const std::string good = everything().binary();
  ASSERT_EQ(errorOf(good), "");
  uint32_t jsonSize;
  std::memcpy(&jsonSize, &good[12], 4);
  const auto size = static_cast<uint32_t>(good.size());
  const size_t lengthAt = 8, jsonSizeAt = 12, jsonTypeAt = 16, binarySizeAt = 20 + jsonSize;
  const std::tuple<const char*, size_t, uint32_t> lies[] = {
      {"version", 4, 1},
      {"length above", lengthAt, size + 4},
      {"length huge", lengthAt, 0xffffffffu},
      {"length 0", lengthAt, 0},
      {"length below the JSON", lengthAt, 30},
      {"JSON size above", jsonSizeAt, size},
      {"JSON size that wraps", jsonSizeAt, 0xfffffff0u},
      {"JSON size 0", jsonSizeAt, 0},
      {"JSON size short", jsonSizeAt, jsonSize - 40},
      {"JSON type", jsonTypeAt, 0x4e4f534b},
      {"binary size above", binarySizeAt, size - static_cast<uint32_t>(binarySizeAt)},
      {"binary size 4 above", binarySizeAt, size - static_cast<uint32_t>(binarySizeAt) - 8 + 4},
      {"binary size that wraps", binarySizeAt, 0xfffffffcu},
      {"binary size 0", binarySizeAt, 0},
      {"binary type", binarySizeAt + 4, 0x4e494243},
  };
  for (const auto& [name, at, value] : lies) {
    std::string bad = good;
    putWord(bad, at, value);
    expectError(errorOf(bad, "scene.glb"), ": ", name);
  }
  for (size_t cut = 0; cut < good.size(); cut += cut < 64 ? 1 : 37)
    expectError(errorOf(good.substr(0, cut), "scene.glb"), ": ", fmt::format("cut at {}", cut));
}

TEST_F(GltfHostile, TruncatedTextNeverLoads) {
  const std::string good = everything().text();
  for (size_t cut = 0; cut < good.size(); cut += 11)
    expectError(errorOf(good.substr(0, cut)), ": ", fmt::format("cut at {}", cut));
}

// Bytes flipped, overwritten, removed, doubled, cut: from a seed, so that what fails fails again.
std::string mutated(std::string file, base::Random& random) {
  const auto below = [&](size_t n) { return static_cast<size_t>(random.uniform() * static_cast<double>(n)); };
  const auto edits = 1 + below(4);
  for (size_t i = 0; i < edits && !file.empty(); ++i) {
    const size_t at = below(file.size());
    switch (below(6)) {
      case 0:
        file[at] = static_cast<char>(file[at] ^ (1 << below(8)));
        break;
      case 1:
        file[at] = static_cast<char>(random.next());
        break;
      case 2:
        file[at] = "0123456789-.eE[]{},:\"tfn"[below(24)];
        break;
      case 3:
        file.erase(at, 1 + below(8));
        break;
      case 4:
        file.insert(at, file.substr(below(file.size()), 1 + below(16)));
        break;
      default:
        if (below(8) == 0) file.resize(at);
    }
  }
  return file;
}

void fuzz(const std::string& good, const std::string& name, int runs, std::optional<double> seconds = {}) {
  const TemporaryFolder folder("gltf_fuzz");
  const base::Verbosity before = base::verbosity();
  base::setVerbosity(base::Verbosity::Quiet);
  int loaded = 0;
  for (int run = 0; run < runs; ++run) {
    base::Random random(static_cast<uint64_t>(run));
    SCOPED_TRACE(fmt::format("run {} of {}", run, name));
    loaded += errorOf(folder.write(name, mutated(good, random)), seconds).empty();
  }
  base::setVerbosity(before);
  // Neither all nor none: the mutations reach behind the parser, and are noticed.
  EXPECT_GT(loaded, runs / 50);
  EXPECT_LT(loaded, runs * 49 / 50);
}

TEST_F(GltfHostile, MutatedTextLoadsOrFailsInOneLine) {
  fuzz(everything().text(), "scene.gltf", 2000);
}
TEST_F(GltfHostile, MutatedBinaryLoadsOrFailsInOneLine) {
  fuzz(everything().binary(), "scene.glb", 2000);
}

TEST_F(GltfHostile, MutatedMotionLoadsOrFailsInOneLine) {
  fuzz(moving().text(), "scene.gltf", 2000, posed);
  fuzz(moving().binary(), "scene.glb", 2000, posed);
}

// Each value of the JSON in turn becomes something else.
void replaceEachValue(const GltfBuilder& gltf, std::optional<double> seconds) {
  const Json good = Json::parse(gltf.text());
  const TemporaryFolder folder("gltf_replaced");
  const base::Verbosity before = base::verbosity();
  base::setVerbosity(base::Verbosity::Quiet);
  const Json others[] = {
      nullptr, true, -1,     0,   2147483647, 2147483648u,   -2147483648,    18446744073709551615u,
      1.5,     1e38, -1e300, "a", "",         Json::array(), Json::object(), {1, 2, 3}};
  const Json flat = good.flatten();
  for (const auto& item : flat.items())
    for (const Json& other : others) {
      Json bad = good;
      bad[Json::json_pointer(item.key())] = other;
      SCOPED_TRACE(item.key() + " = " + other.dump());
      errorOf(folder.write("scene.gltf", bad.dump()), seconds);
    }
  base::setVerbosity(before);
}

TEST_F(GltfHostile, EachValueReplaced) {
  replaceEachValue(everything(), {});
  replaceEachValue(moving(), posed);
}

}  // namespace
}  // namespace sfumato::scene
