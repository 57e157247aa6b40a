// glTF 2.0 (Khronos, 2021). tinygltf parses; everything that its model says is checked here before use.
#include "scene/gltf.h"

#include <tiny_gltf.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <compare>
#include <cstring>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <map>
#include <new>
#include <numbers>
#include <set>
#include <span>

#include "base/error.h"
#include "base/file.h"
#include "base/log.h"
#include "image/image_file.h"
#include "scene/animation.h"
#include "scene/deformation.h"
#include "scene/geometry.h"
#include "scene/gltf_json.h"
#include "scene/printable.h"
#include "scene/visible_hull.h"

namespace sfumato::scene {

namespace fs = std::filesystem;
using base::ExitCode;
using tinygltf::Model;
using tinygltf::Value;

namespace {

// What a small hostile file can make us hold, by naming the same bytes again and again.
constexpr size_t maxElements = size_t{1} << 26;  // vertices, indices and keys
constexpr double farthest =
    1e12;  // metres: squares and products of coordinates stay far below what floats hold
constexpr double smallestView = 1e-6;             // radians or metres: less is rounding
constexpr size_t maxInstances = size_t{1} << 22;  // drawn primitives
constexpr uint64_t maxExternalBytes = uint64_t{4} << 30;
constexpr uint64_t maxTextureBytes = uint64_t{4} << 30;

constexpr const char* textureTransform = "KHR_texture_transform";

const std::set<std::string> supportedExtensions = {
    "KHR_lights_punctual",
    "KHR_materials_transmission",
    "KHR_materials_specular",
    "KHR_materials_ior",
    "KHR_materials_emissive_strength",
    "KHR_mesh_quantization",
    "KHR_materials_unlit",
    textureTransform,
};

// Says what is wrong with a file, in one line that starts with its path.
class Faults {
 public:
  explicit Faults(const fs::path& path) : path_(path.string()) {}

  const std::string& path() const { return path_; }

  template <typename... Args>
  [[noreturn]] void fail(fmt::format_string<Args...> format, Args&&... args) const {
    base::fail(ExitCode::Input, "{}: {}", path_, fmt::format(format, std::forward<Args>(args)...));
  }

  // The element of a list that the file names by number.
  template <typename T>
  const T& at(const std::vector<T>& list, int index, const std::string& where, const char* what) const {
    if (index < 0 || static_cast<size_t>(index) >= list.size())
      fail("{}: there is no {} {} (the file has {}): export it again", where, what, index, list.size());
    return list[static_cast<size_t>(index)];
  }

  double inRange(double value, double low, double high, const std::string& where, const char* what) const {
    if (!(value >= low && value <= high))
      fail("{}: {} is {}: give a value in [{}, {}]", where, what, value, low, high);
    return value;
  }

  // For factors that exporters round: what is a hair outside [0, 1] is clamped.
  float fraction(double value, const std::string& where, const char* what) const {
    constexpr double rounding = 1e-4;
    const double clamped = std::clamp(value, 0.0, 1.0);
    return static_cast<float>(std::abs(value - clamped) < rounding ? clamped
                                                                   : inRange(value, 0, 1, where, what));
  }

  // What single precision holds.
  double finite(double value, const std::string& where, const char* what) const {
    if (!(std::abs(value) <= std::numeric_limits<float>::max()))
      fail("{}: {} is {}: give a smaller value", where, what, value);
    return value;
  }

  double notNegative(double value, const std::string& where, const char* what) const {
    if (value < 0) fail("{}: {} is {}: give 0 or more", where, what, value);
    return finite(value, where, what);
  }

  void warnOnce(const std::string& line) {
    if (warned_.insert(line).second) base::warn("{}: {}", path_, line);
  }

 private:
  std::string path_;
  std::set<std::string> warned_;
};

// node 3 "table"
std::string label(const char* what, size_t index, const std::string& name) {
  const std::string shown = printable(name);
  return shown.empty() ? fmt::format("{} {}", what, index) : fmt::format("{} {} \"{}\"", what, index, shown);
}

// --- JSON values that tinygltf keeps as they are: extensions and extras ---

double number(const Faults& faults, const Value& object, const char* key, double otherwise,
              const std::string& where) {
  if (!object.Has(key)) return otherwise;
  const Value& value = object.Get(key);
  if (!value.IsNumber()) faults.fail("{}: {} is not a number: give one", where, key);
  return value.GetNumberAsDouble();
}

int index(const Faults& faults, const Value& object, const char* key, int otherwise,
          const std::string& where) {
  if (!object.Has(key)) return otherwise;
  const Value& value = object.Get(key);
  if (!value.IsInt()) faults.fail("{}: {} is not an integer: give one", where, key);
  return value.GetNumberAsInt();
}

bool truth(const Faults& faults, const Value& object, const char* key, bool otherwise,
           const std::string& where) {
  if (!object.Has(key)) return otherwise;
  const Value& value = object.Get(key);
  if (!value.IsBool()) faults.fail("{}: {} is not a boolean: give true or false", where, key);
  return value.Get<bool>();
}

std::string text(const Faults& faults, const Value& object, const char* key, const std::string& where) {
  if (!object.Has(key)) return "";
  const Value& value = object.Get(key);
  if (!value.IsString()) faults.fail("{}: {} is not a string: give one", where, key);
  return value.Get<std::string>();
}

template <int n>
glm::vec<n, double> numbers(const Faults& faults, const Value& object, const char* key,
                            const glm::vec<n, double>& otherwise, const std::string& where) {
  if (!object.Has(key)) return otherwise;
  const Value& value = object.Get(key);
  glm::vec<n, double> result;
  bool good = value.ArrayLen() == n;
  for (int i = 0; good && i < n; ++i) {
    good = value.Get(i).IsNumber();
    result[i] = value.Get(i).GetNumberAsDouble();
  }
  if (!good) faults.fail("{}: {} is not an array of {} numbers: give that many", where, key, n);
  return result;
}

const Value* find(const tinygltf::ExtensionMap& extensions, const char* name) {
  const auto found = extensions.find(name);
  return found == extensions.end() ? nullptr : &found->second;
}

// --- The file and those beside it ---

// What tinygltf's file callbacks share.
struct ExternalFiles {
  std::string folder;  // of the glTF file
  uint64_t bytes = 0;
  std::string fault;  // the first one, as a whole line
};

// tinygltf takes + in a uri for a space, as only forms do.
fs::path withPlusForMissing(const std::string& name, const std::string& folder) {
  std::string plus = name;
  std::replace(plus.begin() + static_cast<long>(folder.size()), plus.end(), ' ', '+');
  std::error_code ignored;
  return !fs::exists(name, ignored) && fs::exists(plus, ignored) ? plus : name;
}

bool readExternalFile(std::vector<unsigned char>* out, std::string*, const std::string& name, void* data) {
  auto& files = *static_cast<ExternalFiles*>(data);
  try {
    const fs::path path = withPlusForMissing(name, files.folder);
    std::error_code error;
    if (fs::exists(path, error) && !fs::is_regular_file(path, error))
      base::fail(ExitCode::Input, "{}: is not a regular file", path.string());
    const uint64_t size = fs::file_size(path, error);
    if (!error && size > maxExternalBytes - files.bytes)
      base::fail(ExitCode::Input, "{}: brings the scene's files to more than 4 GiB", path.string());
    const std::vector<std::byte> bytes = base::readFile(path);
    files.bytes += bytes.size();
    out->resize(bytes.size());
    std::copy(bytes.begin(), bytes.end(), reinterpret_cast<std::byte*>(out->data()));
    return true;
  } catch (const std::exception& error) {
    if (files.fault.empty()) files.fault = error.what();
    return false;
  }
}

// Keeps a uri's bytes as they are. Those of a buffer view come from bounds that nobody has checked yet, so
// they are left alone; Materials finds them again.
bool keepEncoded(tinygltf::Image* image, int, std::string*, std::string*, int, int,
                 const unsigned char* bytes, int size, void*) {
  if (image->bufferView == -1) image->image.assign(bytes, bytes + std::max(size, 0));
  return true;
}

constexpr std::string_view binaryMagic = "glTF";
constexpr std::string_view openVdbMagic = " BDV";

// The JSON text: the whole file, or a .glb's first chunk once its lengths are known to hold.
std::string_view jsonOf(std::string_view file, const Faults& faults) {
  if (!file.starts_with(binaryMagic)) return file;
  constexpr size_t headerSize = 12, chunkHeaderSize = 8;
  const auto word = [&](size_t at) {
    uint32_t value = 0;
    if (at + sizeof value <= file.size()) std::memcpy(&value, file.data() + at, sizeof value);
    return size_t{value};
  };
  if (word(4) != 2) faults.fail("is a .glb of version {}: export it as glTF 2.0", word(4));
  const size_t end = word(8), json = headerSize + chunkHeaderSize, jsonSize = word(headerSize);
  if (end < json || end > file.size() || jsonSize > end - json)
    faults.fail("is damaged: the .glb is cut off or its lengths are wrong: export it again");
  const size_t binary = json + jsonSize + chunkHeaderSize;
  if (json + jsonSize < end && (binary > end || word(json + jsonSize) > end - binary))
    faults.fail("is damaged: the .glb's binary chunk is cut off: export it again");
  return file.substr(json, jsonSize);
}

Model parse(const fs::path& path, const Faults& faults) {
  const std::vector<std::byte> bytes = base::readFile(path);
  const std::string_view file(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  if (file.empty()) faults.fail("is empty: export it again");
  if (file.starts_with(openVdbMagic)) faults.fail("is OpenVDB smoke and no scene: name it after --volume");
  const std::string_view json = jsonOf(file, faults);
  if (file.size() > std::numeric_limits<uint32_t>::max() || json.size() > std::numeric_limits<int>::max())
    faults.fail("has more than 4 GiB, or 2 GiB of JSON: keep buffers in .bin files beside it");
  checkGltfJson(json, faults.path());

  ExternalFiles files;
  files.folder = path.parent_path().string();
  tinygltf::TinyGLTF loader;
  loader.SetImageLoader(keepEncoded, nullptr);
  loader.SetFsCallbacks({[](const std::string&, void*) { return true; },
                         [](const std::string& name, void*) { return name; }, readExternalFile, nullptr,
                         &files});
  Model model;
  std::string error, warning;
  const auto size = static_cast<unsigned>(file.size());
  const bool loaded =
      file.starts_with(binaryMagic)
          ? loader.LoadBinaryFromMemory(&model, &error, &warning,
                                        reinterpret_cast<const unsigned char*>(file.data()), size,
                                        files.folder)
          : loader.LoadASCIIFromString(&model, &error, &warning, file.data(), size, files.folder);
  if (!files.fault.empty()) faults.fail("{}: put it there or export again", printable(files.fault, 300));
  if (!loaded) {
    const std::string reason = printable(error.empty() ? warning : error, 300);
    faults.fail("is damaged: {}: export it again", reason.empty() ? "unknown reason" : reason);
  }
  if (!model.asset.version.starts_with("2."))
    faults.fail("is glTF {}: export it as glTF 2.0", printable(model.asset.version));
  return model;
}

void checkExtensions(const Model& model, Faults& faults) {
  for (const std::string& name : model.extensionsRequired)
    if (!supportedExtensions.contains(name))
      faults.fail("requires the extension \"{}\", which is not supported: export without it",
                  printable(name));
  for (const std::string& name : model.extensionsUsed)
    if (!supportedExtensions.contains(name))
      faults.warnOnce(fmt::format("the extension \"{}\" is not supported: ignored", printable(name)));
}

// --- Buffers and accessors ---

class Accessors {
 public:
  Accessors(const Model& model, const Faults& faults) : model_(model), faults_(faults) {}

  // The bytes of a buffer view.
  std::span<const unsigned char> view(int viewIndex, const std::string& where) const {
    const tinygltf::BufferView& view = faults_.at(model_.bufferViews, viewIndex, where, "buffer view");
    const std::vector<unsigned char>& data = faults_.at(model_.buffers, view.buffer, where, "buffer").data;
    if (view.byteOffset > data.size() || view.byteLength > data.size() - view.byteOffset)
      faults_.fail("{}: buffer view {} reaches beyond its buffer of {} bytes: export it again", where,
                   viewIndex, data.size());
    return std::span(data).subspan(view.byteOffset, view.byteLength);
  }

  // `components` numbers for each element of the accessor, normalised integers as fractions; all finite.
  std::vector<float> floats(int accessorIndex, int components, const std::string& where) {
    const std::vector<double> values = numbers(accessorIndex, components, where);
    std::vector<float> result(values.size());
    for (size_t i = 0; i < values.size(); ++i) {
      if (!std::isfinite(values[i]))
        faults_.fail("{}: element {} is not finite: export it again", where,
                     i / static_cast<size_t>(components));
      result[i] = static_cast<float>(values[i]);
    }
    return result;
  }

  // Indices, each less than `vertexCount`.
  std::vector<uint32_t> indices(int accessorIndex, size_t vertexCount, const std::string& where) {
    const tinygltf::Accessor& accessor = faults_.at(model_.accessors, accessorIndex, where, "accessor");
    if (!isIndexType(accessor.componentType) || accessor.normalized)
      faults_.fail("{}: indices are not plain unsigned integers: export it again", where);
    const std::vector<double> values = numbers(accessorIndex, 1, where);
    std::vector<uint32_t> result(values.size());
    for (size_t i = 0; i < values.size(); ++i) {
      if (values[i] >= static_cast<double>(vertexCount))
        faults_.fail("{}: index {} is {}, but there are {} vertices: export it again", where, i, values[i],
                     vertexCount);
      result[i] = static_cast<uint32_t>(values[i]);
    }
    return result;
  }

  int components(int accessorIndex, const std::string& where) const {
    const int type = faults_.at(model_.accessors, accessorIndex, where, "accessor").type;
    return tinygltf::GetNumComponentsInType(static_cast<uint32_t>(type));
  }

  // Counts elements that are about to be held.
  void spend(size_t elements, const std::string& where) {
    if (elements > maxElements - spent_)
      faults_.fail(
          "{}: brings the scene to more than {} vertices and indices (and keys of animations): split it",
          where, maxElements);
    spent_ += elements;
  }

 private:
  static bool isIndexType(int componentType) {
    return componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE ||
           componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ||
           componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
  }

  template <typename T>
  static double read(const unsigned char* bytes, bool normalised) {
    T value;
    std::memcpy(&value, bytes, sizeof value);
    if (!normalised) return static_cast<double>(value);
    return std::max(static_cast<double>(value) / static_cast<double>(std::numeric_limits<T>::max()), -1.0);
  }

  using ReadComponent = double (*)(const unsigned char*, bool);
  struct ComponentType {
    size_t size = 0;
    ReadComponent read = nullptr;
  };

  ComponentType componentType(int type, const std::string& where) const {
    switch (type) {
      case TINYGLTF_COMPONENT_TYPE_BYTE:
        return {1, read<int8_t>};
      case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
        return {1, read<uint8_t>};
      case TINYGLTF_COMPONENT_TYPE_SHORT:
        return {2, read<int16_t>};
      case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
        return {2, read<uint16_t>};
      case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
        return {4, read<uint32_t>};
      case TINYGLTF_COMPONENT_TYPE_FLOAT:
        return {4, [](const unsigned char* bytes, bool) { return read<float>(bytes, false); }};
      default:
        faults_.fail("{}: component type {} is not one of glTF's: export it again", where, type);
    }
  }

  // The bytes of `count` elements of `size` bytes, `stride` apart, from `offset` into a view.
  const unsigned char* elements(int viewIndex, uint64_t offset, size_t count, size_t stride, size_t size,
                                const std::string& where) const {
    const auto bytes = view(viewIndex, where);
    if (stride < size || offset > bytes.size() || stride * (count - 1) + size > bytes.size() - offset)
      faults_.fail("{}: {} elements of {} bytes reach beyond buffer view {}: export it again", where, count,
                   size, viewIndex);
    return bytes.data() + offset;
  }

  std::vector<double> numbers(int accessorIndex, int components, const std::string& where) {
    const tinygltf::Accessor& accessor = faults_.at(model_.accessors, accessorIndex, where, "accessor");
    if (this->components(accessorIndex, where) != components)
      faults_.fail("{}: accessor {} does not have {} component(s): export it again", where, accessorIndex,
                   components);
    if (accessor.count == 0) faults_.fail("{}: accessor {} is empty: export it again", where, accessorIndex);
    spend(accessor.count, where);

    const ComponentType type = componentType(accessor.componentType, where);
    const auto width = static_cast<size_t>(components);
    const size_t size = type.size * width;
    std::vector<double> values(accessor.count * width);
    if (accessor.bufferView != -1) {
      const size_t stated =
          faults_.at(model_.bufferViews, accessor.bufferView, where, "buffer view").byteStride;
      const size_t stride = stated == 0 ? size : stated;
      const unsigned char* from =
          elements(accessor.bufferView, accessor.byteOffset, accessor.count, stride, size, where);
      for (size_t i = 0; i < accessor.count; ++i)
        for (size_t c = 0; c < width; ++c)
          values[i * width + c] = type.read(from + i * stride + c * type.size, accessor.normalized);
    }
    if (accessor.sparse.isSparse) overwriteSparse(accessor, type, width, values, where);
    return values;
  }

  void overwriteSparse(const tinygltf::Accessor& accessor, const ComponentType& type, size_t width,
                       std::vector<double>& values, const std::string& where) const {
    const auto& sparse = accessor.sparse;
    const size_t size = type.size * width;
    if (sparse.count < 1 || static_cast<size_t>(sparse.count) > accessor.count ||
        sparse.indices.byteOffset < 0 || sparse.values.byteOffset < 0 ||
        !isIndexType(sparse.indices.componentType))
      faults_.fail("{}: its sparse accessor is damaged: export it again", where);
    const auto count = static_cast<size_t>(sparse.count);
    const ComponentType indexType = componentType(sparse.indices.componentType, where);
    const unsigned char* indices =
        elements(sparse.indices.bufferView, static_cast<uint64_t>(sparse.indices.byteOffset), count,
                 indexType.size, indexType.size, where);
    const unsigned char* replacements = elements(
        sparse.values.bufferView, static_cast<uint64_t>(sparse.values.byteOffset), count, size, size, where);
    for (size_t i = 0; i < count; ++i) {
      const auto element = static_cast<size_t>(indexType.read(indices + i * indexType.size, false));
      if (element >= accessor.count)
        faults_.fail("{}: sparse index {} is beyond its {} elements: export it again", where, element,
                     accessor.count);
      for (size_t c = 0; c < width; ++c)
        values[element * width + c] = type.read(replacements + i * size + c * type.size, accessor.normalized);
    }
  }

  const Model& model_;
  const Faults& faults_;
  size_t spent_ = 0;
};

// --- Materials and textures ---

class Materials {
 public:
  Materials(const Model& model, const Faults& faults, const Accessors& accessors, Scene& scene)
      : model_(model), faults_(faults), accessors_(accessors), scene_(scene) {}

  void readAll() {
    for (size_t i = 0; i < model_.materials.size(); ++i) scene_.materials.push_back(read(i));
  }

  // Index of a primitive's material; the one that glTF has for primitives without comes last.
  int indexOf(int gltfIndex, const std::string& where) {
    if (gltfIndex != -1) {
      faults_.at(model_.materials, gltfIndex, where, "material");
      return gltfIndex;
    }
    if (scene_.materials.size() == model_.materials.size()) scene_.materials.emplace_back().name = "default";
    return static_cast<int>(model_.materials.size());
  }

 private:
  Material read(size_t index) {
    const tinygltf::Material& from = model_.materials[index];
    const tinygltf::PbrMetallicRoughness& pbr = from.pbrMetallicRoughness;
    const std::string where = label("material", index, from.name);
    Material to;
    to.name = printable(from.name);
    for (int c = 0; c < 4; ++c)
      to.baseColour[c] =
          faults_.fraction(pbr.baseColorFactor[static_cast<size_t>(c)], where, "baseColorFactor");
    to.baseColourTexture = use(pbr.baseColorTexture, where);
    to.metallic = faults_.fraction(pbr.metallicFactor, where, "metallicFactor");
    to.roughness = faults_.fraction(pbr.roughnessFactor, where, "roughnessFactor");
    to.metallicRoughnessTexture = use(pbr.metallicRoughnessTexture, where);
    to.normalTexture = use(from.normalTexture, where);
    to.normalScale = static_cast<float>(faults_.finite(from.normalTexture.scale, where, "normal scale"));
    to.emissiveTexture = use(from.emissiveTexture, where);
    to.alphaMode = alphaMode(from.alphaMode, where);
    to.alphaCutoff = static_cast<float>(faults_.notNegative(from.alphaCutoff, where, "alphaCutoff"));
    to.doubleSided = from.doubleSided;

    double strength = 1;
    if (const Value* emissive = find(from.extensions, "KHR_materials_emissive_strength"))
      strength = faults_.notNegative(number(faults_, *emissive, "emissiveStrength", 1, where), where,
                                     "emissiveStrength");
    for (int c = 0; c < 3; ++c) {
      const double factor =
          faults_.notNegative(from.emissiveFactor[static_cast<size_t>(c)], where, "emissiveFactor");
      to.emissive[c] = static_cast<float>(faults_.notNegative(factor * strength, where, "the emission"));
    }
    to.unlit = find(from.extensions, "KHR_materials_unlit") != nullptr;
    if (!to.unlit) readTransmission(from, to, where);
    readSpecular(from, to, where);
    readShadows(from.extras, to, where);
    return to;
  }

  AlphaMode alphaMode(const std::string& name, const std::string& where) const {
    if (name == "OPAQUE") return AlphaMode::Opaque;
    if (name == "MASK") return AlphaMode::Mask;
    if (name == "BLEND") return AlphaMode::Blend;
    faults_.fail("{}: alphaMode \"{}\" is unknown: use OPAQUE, MASK or BLEND", where, printable(name));
  }

  void readTransmission(const tinygltf::Material& from, Material& to, const std::string& where) {
    const Value* extension = find(from.extensions, "KHR_materials_transmission");
    if (!extension) return;
    to.transmission = faults_.fraction(number(faults_, *extension, "transmissionFactor", 0, where), where,
                                       "transmissionFactor");
    to.transmissionTexture = use(*extension, "transmissionTexture", where);
  }

  void readSpecular(const tinygltf::Material& from, Material& to, const std::string& where) {
    if (const Value* extension = find(from.extensions, "KHR_materials_specular")) {
      to.specular =
          faults_.fraction(number(faults_, *extension, "specularFactor", 1, where), where, "specularFactor");
      to.specularTexture = use(*extension, "specularTexture", where);
      const glm::dvec3 colour = numbers(faults_, *extension, "specularColorFactor", glm::dvec3(1), where);
      for (int c = 0; c < 3; ++c)
        to.specularColour[c] =
            static_cast<float>(faults_.notNegative(colour[c], where, "specularColorFactor"));
      to.specularColourTexture = use(*extension, "specularColorTexture", where);
    }
    if (const Value* extension = find(from.extensions, "KHR_materials_ior")) {
      // The specular colour scales the 0.04 that an index of 1.5 reflects; 0 stands for an infinite index.
      const double ior = number(faults_, *extension, "ior", 1.5, where);
      if (ior != 0 && !(ior >= 1)) faults_.fail("{}: ior is {}: give 1 or more, or 0", where, ior);
      const double f0 = ior == 0 ? 1 : std::pow((ior - 1) / (ior + 1), 2);
      to.specularColour *= static_cast<float>(f0 / 0.04);
    }
  }

  void readShadows(const Value& extras, Material& to, const std::string& where) {
    to.shadowSelf = truth(faults_, extras, "shadow_self", to.shadowSelf, where);
    to.shadowOnce = truth(faults_, extras, "shadow_once", to.shadowOnce, where);
    to.shadowRim = static_cast<float>(
        faults_.notNegative(number(faults_, extras, "shadow_rim", to.shadowRim, where), where, "shadow_rim"));
  }

  TextureUse use(const Value& extension, const char* key, const std::string& where) {
    if (!extension.Has(key)) return {};
    const Value& info = extension.Get(key);
    const Value none;
    const Value& extensions = info.Has("extensions") ? info.Get("extensions") : none;
    const Value& transform = extensions.Has(textureTransform) ? extensions.Get(textureTransform) : none;
    return use(index(faults_, info, "index", -1, where), index(faults_, info, "texCoord", 0, where),
               transform, where);
  }

  template <typename TextureInfo>
  TextureUse use(const TextureInfo& info, const std::string& where) {
    if (info.index == -1) return {};
    const Value* transform = find(info.extensions, textureTransform);
    return use(info.index, info.texCoord, transform ? *transform : Value(), where);
  }

  // `transform`: the texture info's KHR_texture_transform, an object or nothing.
  TextureUse use(int textureIndex, int uvSet, const Value& transform, const std::string& where) {
    TextureUse use;
    use.uvSet = index(faults_, transform, "texCoord", uvSet, where);
    if (use.uvSet != 0 && use.uvSet != 1)
      faults_.fail("{}: uses TEXCOORD_{}: only 0 and 1 are supported", where, use.uvSet);
    use.textureFromUv = textureFromUv(transform, where);
    use.texture = textureOf(textureIndex, where);
    return use;
  }

  // Scaled, then turned counter-clockwise on the picture (where v falls), then moved.
  glm::mat3x2 textureFromUv(const Value& transform, const std::string& where) const {
    const glm::dvec2 offset = numbers(faults_, transform, "offset", glm::dvec2(0), where);
    const glm::dvec2 scale = numbers(faults_, transform, "scale", glm::dvec2(1), where);
    const double angle =
        faults_.finite(number(faults_, transform, "rotation", 0, where), where, "texture rotation");
    for (int i = 0; i < 2; ++i) {
      faults_.finite(offset[i], where, "texture offset");
      faults_.finite(scale[i], where, "texture scale");
    }
    const double cosine = std::cos(angle), sine = std::sin(angle);
    return glm::dmat3x2(scale.x * glm::dvec2(cosine, -sine), scale.y * glm::dvec2(sine, cosine), offset);
  }

  // The scene's texture for one of the file, decoded when first asked for.
  int textureOf(int textureIndex, const std::string& where) {
    const auto known = textures_.find(textureIndex);
    if (known != textures_.end()) return known->second;
    const tinygltf::Texture& from = faults_.at(model_.textures, textureIndex, where, "texture");
    scene_.textures.push_back(read(from, label("texture", static_cast<size_t>(textureIndex), from.name)));
    return textures_[textureIndex] = static_cast<int>(scene_.textures.size()) - 1;
  }

  Texture read(const tinygltf::Texture& from, const std::string& where) {
    const tinygltf::Image& image = faults_.at(model_.images, from.source, where, "image");
    const std::string imageName = label("image", static_cast<size_t>(from.source), image.name);
    std::span<const unsigned char> encoded = image.image;
    if (image.bufferView != -1) encoded = accessors_.view(image.bufferView, imageName);
    image::Picture picture =
        image::decodePicture(std::as_bytes(encoded), fmt::format("{}: {}", faults_.path(), imageName));
    textureBytes_ += picture.rgba.size();
    if (textureBytes_ > maxTextureBytes)
      faults_.fail("{}: brings the textures to more than 4 GiB: make them smaller", where);

    Texture to;
    to.name = printable(from.name.empty() ? image.name : from.name);
    to.width = picture.width;
    to.height = picture.height;
    to.rgba = std::move(picture.rgba);
    if (from.sampler != -1) {
      const tinygltf::Sampler& sampler = faults_.at(model_.samplers, from.sampler, where, "sampler");
      to.wrapS = wrap(sampler.wrapS, where);
      to.wrapT = wrap(sampler.wrapT, where);
      to.nearest = isNearest(sampler.magFilter, where);
      to.minify = minify(sampler.minFilter, where);
    }
    return to;
  }

  static constexpr int noFilter = -1;  // tinygltf's: the choice is ours

  bool isNearest(int filter, const std::string& where) const {
    if (filter == TINYGLTF_TEXTURE_FILTER_NEAREST) return true;
    if (filter == TINYGLTF_TEXTURE_FILTER_LINEAR || filter == noFilter) return false;
    faults_.fail("{}: magFilter {} is unknown: export it again", where, filter);
  }

  Minify minify(int filter, const std::string& where) const {
    switch (filter) {
      case TINYGLTF_TEXTURE_FILTER_NEAREST:
        return Minify::Nearest;
      case TINYGLTF_TEXTURE_FILTER_LINEAR:
        return Minify::Linear;
      case TINYGLTF_TEXTURE_FILTER_NEAREST_MIPMAP_NEAREST:
        return Minify::NearestMipmapNearest;
      case TINYGLTF_TEXTURE_FILTER_LINEAR_MIPMAP_NEAREST:
        return Minify::LinearMipmapNearest;
      case TINYGLTF_TEXTURE_FILTER_NEAREST_MIPMAP_LINEAR:
        return Minify::NearestMipmapLinear;
      case TINYGLTF_TEXTURE_FILTER_LINEAR_MIPMAP_LINEAR:
      case noFilter:
        return Minify::LinearMipmapLinear;
      default:
        faults_.fail("{}: minFilter {} is unknown: export it again", where, filter);
    }
  }

  Wrap wrap(int mode, const std::string& where) const {
    switch (mode) {
      case TINYGLTF_TEXTURE_WRAP_REPEAT:
        return Wrap::Repeat;
      case TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE:
        return Wrap::ClampToEdge;
      case TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT:
        return Wrap::MirroredRepeat;
      default:
        faults_.fail("{}: wrap mode {} is unknown: export it again", where, mode);
    }
  }

  const Model& model_;
  const Faults& faults_;
  const Accessors& accessors_;
  Scene& scene_;
  std::map<int, int> textures_;  // index in the file -> index in the scene
  uint64_t textureBytes_ = 0;
};

// --- Nodes ---

std::string nodeLabel(const Model& model, size_t node) {
  return label("node", node, model.nodes[node].name);
}

void checkLength(const Faults& faults, const std::vector<double>& list, size_t length,
                 const std::string& where, const char* what) {
  if (!list.empty() && list.size() != length)
    faults.fail("{}: {} does not have {} numbers: export it again", where, what, length);
}

glm::dmat4 localTransform(const Faults& faults, const tinygltf::Node& node, const std::string& where) {
  checkLength(faults, node.matrix, 16, where, "matrix");
  checkLength(faults, node.translation, 3, where, "translation");
  checkLength(faults, node.rotation, 4, where, "rotation");
  checkLength(faults, node.scale, 3, where, "scale");
  glm::dmat4 local(1.0);
  if (!node.matrix.empty()) {
    constexpr double rounding = 1e-5;
    for (int column = 0; column < 4; ++column) {
      for (int row = 0; row < 3; ++row)
        local[column][row] = node.matrix[static_cast<size_t>(4 * column + row)];
      const double last = node.matrix[static_cast<size_t>(4 * column + 3)];
      if (std::abs(last - (column == 3 ? 1.0 : 0.0)) > rounding)
        faults.fail("{}: its matrix is not affine: export it again", where);
    }
    return local;
  }
  const auto vector = [](const std::vector<double>& v, double otherwise) {
    return v.empty() ? glm::dvec3(otherwise) : glm::dvec3(v[0], v[1], v[2]);
  };
  if (!node.rotation.empty()) {
    const std::vector<double>& r = node.rotation;
    const glm::dquat rotation(r[3], r[0], r[1], r[2]);
    const double length = glm::length(rotation);
    if (!(length > 0) || !std::isfinite(length))
      faults.fail("{}: its rotation is not a quaternion: export it again", where);
    local = glm::mat4_cast(rotation / length);
  }
  const glm::dvec3 scale = vector(node.scale, 1);
  for (int axis = 0; axis < 3; ++axis) local[axis] *= scale[axis];
  local[3] = glm::dvec4(vector(node.translation, 0), 1);
  return local;
}

// The GPU will hold it in single precision.
bool fitsFloat(const glm::dmat4& matrix) {
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 4; ++row)
      if (!(std::abs(matrix[column][row]) <= std::numeric_limits<float>::max())) return false;
  return true;
}

// Of the scene that is read, where there is any.
int sceneNumber(const Model& model) {
  return model.defaultScene == -1 ? 0 : model.defaultScene;
}

std::string sceneLabel(const Model& model) {
  const auto number = static_cast<size_t>(sceneNumber(model));
  return label("scene", number, model.scenes[number].name);
}

// Which nodes are drawn, parents before children, and where they stand.
class NodeGraph {
 public:
  struct Placed {
    size_t node = 0;
    glm::dmat4 worldFromNode{1.0};
  };

  NodeGraph(const Model& model, const Faults& faults) : model_(model), faults_(faults) {
    findParents();
    rejectCycles();
  }

  std::vector<Placed> place() const {
    std::vector<Placed> placed;
    std::vector<Placed> waiting;  // a stack of nodes with their parents' transforms
    for (const size_t root : roots()) waiting.push_back({root, glm::dmat4(1.0)});
    std::reverse(waiting.begin(), waiting.end());
    while (!waiting.empty()) {
      Placed next = waiting.back();
      waiting.pop_back();
      const tinygltf::Node& node = model_.nodes[next.node];
      next.worldFromNode = next.worldFromNode * localTransform(faults_, node, nodeLabel(model_, next.node));
      placed.push_back(next);
      for (size_t i = node.children.size(); i-- > 0;)
        waiting.push_back({static_cast<size_t>(node.children[i]), next.worldFromNode});
    }
    return placed;
  }

 private:
  static constexpr int none = -1;

  void findParents() {
    parents_.assign(model_.nodes.size(), none);
    for (size_t i = 0; i < model_.nodes.size(); ++i)
      for (const int child : model_.nodes[i].children) {
        faults_.at(model_.nodes, child, nodeLabel(model_, i), "node");
        int& parent = parents_[static_cast<size_t>(child)];
        if (parent != none)
          faults_.fail("{}: is a child of both node {} and node {}: export it again",
                       nodeLabel(model_, static_cast<size_t>(child)), parent, i);
        parent = static_cast<int>(i);
      }
  }

  // Climbs from each node until a root, or until a node that an earlier climb has passed.
  void rejectCycles() const {
    std::vector<size_t> climb(model_.nodes.size(), 0);  // number of the climb that passed, from 1
    for (size_t start = 0; start < climb.size(); ++start)
      for (int at = static_cast<int>(start); at != none; at = parents_[static_cast<size_t>(at)]) {
        size_t& passed = climb[static_cast<size_t>(at)];
        if (passed == start + 1)
          faults_.fail("{}: is its own ancestor: export it again",
                       nodeLabel(model_, static_cast<size_t>(at)));
        if (passed != 0) break;
        passed = start + 1;
      }
  }

  std::vector<size_t> roots() const {
    std::vector<size_t> roots;
    if (model_.scenes.empty()) {
      for (size_t i = 0; i < parents_.size(); ++i)
        if (parents_[i] == none) roots.push_back(i);
      return roots;
    }
    const tinygltf::Scene& scene = faults_.at(model_.scenes, sceneNumber(model_), "scene", "scene");
    const std::string where = sceneLabel(model_);
    for (const int node : scene.nodes) {
      faults_.at(model_.nodes, node, where, "node");
      const auto root = static_cast<size_t>(node);
      if (parents_[root] != none)
        faults_.fail("{}: {} is no root, but a child of node {}: export it again", where,
                     nodeLabel(model_, root), parents_[root]);
      roots.push_back(root);
    }
    std::vector<size_t> sorted = roots;
    std::sort(sorted.begin(), sorted.end());
    const auto twice = std::adjacent_find(sorted.begin(), sorted.end());
    if (twice != sorted.end())
      faults_.fail("{}: {} is there twice: export it again", where, nodeLabel(model_, *twice));
    return roots;
  }

  const Model& model_;
  const Faults& faults_;
  std::vector<int> parents_;
};

// --- Animations ---

size_t morphTargets(const tinygltf::Mesh& mesh) {
  return mesh.primitives.empty() ? 0 : mesh.primitives.front().targets.size();
}

// Gives the nodes of a model the transforms and weights that its animations have at a time.
class Animations {
 public:
  Animations(Model& model, Faults& faults, Accessors& accessors)
      : model_(model), faults_(faults), accessors_(accessors) {}

  // Of two that animate the same property, the later one counts.
  void pose(double seconds) {
    for (size_t i = 0; i < model_.animations.size(); ++i) {
      const tinygltf::Animation& animation = model_.animations[i];
      const std::string where = label("animation", i, animation.name);
      for (size_t c = 0; c < animation.channels.size(); ++c)
        pose(animation, animation.channels[c], seconds, fmt::format("{} channel {}", where, c));
    }
  }

 private:
  void pose(const tinygltf::Animation& animation, const tinygltf::AnimationChannel& channel, double seconds,
            const std::string& where) {
    if (channel.target_node == -1) return;
    faults_.at(model_.nodes, channel.target_node, where, "node");
    const auto target = static_cast<size_t>(channel.target_node);
    tinygltf::Node& node = model_.nodes[target];
    const bool weights = channel.target_path == "weights";
    std::vector<double>* property = weights                                ? &node.weights
                                    : channel.target_path == "translation" ? &node.translation
                                    : channel.target_path == "rotation"    ? &node.rotation
                                    : channel.target_path == "scale"       ? &node.scale
                                                                           : nullptr;
    if (property == nullptr) {
      faults_.warnOnce(
          fmt::format("animations of \"{}\" are not supported: ignored", printable(channel.target_path)));
      return;
    }
    if (!weights && !node.matrix.empty())
      faults_.fail("{}: {} has a matrix, which cannot be animated: export it again", where,
                   nodeLabel(model_, target));

    const auto& sampler = faults_.at(animation.samplers, channel.sampler, where, "sampler");
    Keyframes keyframes;
    keyframes.rotation = property == &node.rotation;
    keyframes.width = weights ? weightsOf(node, where) : keyframes.rotation ? 4 : 3;
    readKeys(sampler, weights ? 1 : static_cast<int>(keyframes.width), keyframes, where);
    *property = valueAt(keyframes, seconds);
  }

  // How many morph targets a node's mesh has.
  size_t weightsOf(const tinygltf::Node& node, const std::string& where) const {
    const size_t count = morphTargets(faults_.at(model_.meshes, node.mesh, where, "mesh"));
    if (count == 0)
      faults_.fail("{}: mesh {} has no morph targets to weigh: export it again", where, node.mesh);
    return count;
  }

  void readKeys(const tinygltf::AnimationSampler& sampler, int components, Keyframes& keyframes,
                const std::string& where) {
    keyframes.interpolation = interpolation(sampler.interpolation, where);
    keyframes.times = accessors_.floats(sampler.input, 1, where + " input");
    keyframes.values = accessors_.floats(sampler.output, components, where + " output");
    const auto descent = std::adjacent_find(keyframes.times.begin(), keyframes.times.end(),
                                            [](float a, float b) { return !(a < b); });
    if (descent != keyframes.times.end())
      faults_.fail("{} input: key {} is not later than the one before it: export it again", where,
                   descent - keyframes.times.begin() + 1);
    const size_t perKey = keyframes.interpolation == Interpolation::CubicSpline ? 3 : 1;
    const size_t expected = keyframes.times.size() * keyframes.width * perKey;
    if (keyframes.values.size() != expected)
      faults_.fail("{} output: has {} numbers, but {} keys need {}: export it again", where,
                   keyframes.values.size(), keyframes.times.size(), expected);
  }

  Interpolation interpolation(const std::string& name, const std::string& where) const {
    if (name == "STEP") return Interpolation::Step;
    if (name == "LINEAR") return Interpolation::Linear;
    if (name == "CUBICSPLINE") return Interpolation::CubicSpline;
    faults_.fail("{}: interpolation \"{}\" is unknown: use STEP, LINEAR or CUBICSPLINE", where,
                 printable(name));
  }

  Model& model_;
  Faults& faults_;
  Accessors& accessors_;
};

// --- Skins ---

class Skins {
 public:
  Skins(const Model& model, const Faults& faults, Accessors& accessors,
        std::span<const NodeGraph::Placed> placed)
      : model_(model), faults_(faults), accessors_(accessors), worldFromNode_(model.nodes.size()) {
    for (const NodeGraph::Placed& node : placed) worldFromNode_[node.node] = &node.worldFromNode;
  }

  // For each joint of a skin: what takes a vertex at rest to the world. Read when first asked for.
  std::span<const glm::dmat4> worldFromRest(int skin, const std::string& where) {
    const auto known = matrices_.find(skin);
    if (known != matrices_.end()) return known->second;
    const tinygltf::Skin& from = faults_.at(model_.skins, skin, where, "skin");
    return matrices_[skin] = read(from, label("skin", static_cast<size_t>(skin), from.name));
  }

 private:
  std::vector<glm::dmat4> read(const tinygltf::Skin& skin, const std::string& where) {
    if (skin.joints.empty()) faults_.fail("{}: has no joints: export it again", where);
    std::vector<glm::dmat4> matrices;
    for (const int joint : skin.joints) {
      faults_.at(model_.nodes, joint, where, "node");
      const auto node = static_cast<size_t>(joint);
      if (worldFromNode_[node] == nullptr)
        faults_.fail("{}: its joint, {}, is not in the scene: export it again", where,
                     nodeLabel(model_, node));
      matrices.push_back(*worldFromNode_[node]);
    }
    if (skin.inverseBindMatrices != -1) multiplyInverseBinds(skin.inverseBindMatrices, matrices, where);
    for (const glm::dmat4& matrix : matrices)
      if (!fitsFloat(matrix)) faults_.fail("{}: a joint's transform is not finite: export it again", where);
    return matrices;
  }

  void multiplyInverseBinds(int accessor, std::vector<glm::dmat4>& matrices, const std::string& where) {
    constexpr float rounding = 1e-5f;
    const std::vector<float> values = accessors_.floats(accessor, 16, where + " inverseBindMatrices");
    if (values.size() < 16 * matrices.size())
      faults_.fail("{}: has {} inverse bind matrices for {} joints: export it again", where,
                   values.size() / 16, matrices.size());
    for (size_t joint = 0; joint < matrices.size(); ++joint) {
      const float* v = &values[16 * joint];
      if (std::abs(v[3]) > rounding || std::abs(v[7]) > rounding || std::abs(v[11]) > rounding ||
          std::abs(v[15] - 1) > rounding)
        faults_.fail("{}: inverse bind matrix {} is not affine: export it again", where, joint);
      glm::dmat4 jointFromRest(1.0);
      for (int column = 0; column < 4; ++column)
        jointFromRest[column] = {v[4 * column], v[4 * column + 1], v[4 * column + 2], column == 3 ? 1 : 0};
      matrices[joint] = matrices[joint] * jointFromRest;
    }
  }

  const Model& model_;
  const Faults& faults_;
  Accessors& accessors_;
  std::vector<const glm::dmat4*> worldFromNode_;  // null where a node is not in the scene
  std::map<int, std::vector<glm::dmat4>> matrices_;
};

// --- Meshes ---

class Meshes {
 public:
  Meshes(const Model& model, Faults& faults, Accessors& accessors, Materials& materials, Skins& skins,
         Scene& scene)
      : model_(model),
        faults_(faults),
        accessors_(accessors),
        materials_(materials),
        skins_(skins),
        scene_(scene) {}

  // Adds an instance of each primitive of a node's mesh.
  void place(const tinygltf::Node& node, const glm::dmat4& worldFromNode, const std::string& where) {
    const Shape shape{node.mesh, node.skin, weightsOf(node, where)};
    // A skin takes vertices to the world whatever node they hang from.
    const glm::dmat4 worldFromObject = node.skin == -1 ? worldFromNode : glm::dmat4(1.0);
    for (const int mesh : primitives(shape, Side::AsStored)) {
      if (scene_.instances.size() >= maxInstances)
        faults_.fail("{}: draws more than {} primitives: merge them", where, maxInstances);
      scene_.instances.push_back({mesh, worldFromObject});
    }
    const size_t count = primitives(shape, Side::AsStored).size();
    const auto placed = std::span(scene_.instances).last(count);
    if (isSingular(worldFromObject)) {
      for (Instance& instance : placed) flatten(instance, where);
    } else if (glm::determinant(glm::dmat3(worldFromObject)) < 0) {
      const std::vector<int>& others = primitives(shape, Side::Mirrored);
      for (size_t i = 0; i < count; ++i) placed[i].mesh = others[i];
    }
  }

 private:
  enum class Side { AsStored, Mirrored };

  // A mesh of the file, bent.
  struct Shape {
    int mesh = -1;
    int skin = -1;
    std::vector<double> weights;  // of the morph targets; empty: all 0
    auto operator<=>(const Shape&) const = default;
  };

  // The node's weights, else its mesh's.
  std::vector<double> weightsOf(const tinygltf::Node& node, const std::string& where) const {
    const tinygltf::Mesh& mesh = faults_.at(model_.meshes, node.mesh, where, "mesh");
    const std::vector<double>& weights = node.weights.empty() ? mesh.weights : node.weights;
    if (!weights.empty() && weights.size() != morphTargets(mesh))
      faults_.fail("{}: has {} weights for {} morph targets: export it again", where, weights.size(),
                   morphTargets(mesh));
    bool any = false;
    for (const double weight : weights) any = faults_.finite(weight, where, "a morph weight") != 0 || any;
    return any ? weights : std::vector<double>();
  }

  // The scene's meshes for the primitives of a mesh, made when first asked for.
  const std::vector<int>& primitives(const Shape& shape, Side side) {
    const auto known = meshes_.find({shape, side});
    if (known != meshes_.end()) return known->second;
    std::vector<int> made;
    if (side == Side::AsStored) {
      const tinygltf::Mesh& mesh = model_.meshes[static_cast<size_t>(shape.mesh)];
      const std::string where = label("mesh", static_cast<size_t>(shape.mesh), mesh.name);
      for (size_t i = 0; i < mesh.primitives.size(); ++i)
        if (const auto primitive = read(mesh.primitives[i], shape, fmt::format("{} primitive {}", where, i)))
          made.push_back(add(*primitive, mesh.name));
    } else {
      for (const int mesh : std::vector<int>(primitives(shape, Side::AsStored))) {
        const Mesh& original = scene_.meshes[static_cast<size_t>(mesh)];
        accessors_.spend(original.vertices.size() + original.indices.size(), original.name);
        made.push_back(add(mirrored(original), original.name));
      }
    }
    return meshes_[{shape, side}] = std::move(made);
  }

  int add(Mesh mesh, const std::string& name) {
    mesh.name = printable(name);
    scene_.meshes.push_back(std::move(mesh));
    return static_cast<int>(scene_.meshes.size()) - 1;
  }

  static bool isSingular(const glm::dmat4& matrix) {
    const glm::dmat3 linear(matrix);
    const double lengths = glm::length(linear[0]) * glm::length(linear[1]) * glm::length(linear[2]);
    return std::abs(glm::determinant(linear)) <= 1e-12 * lengths;
  }

  // Puts a transform that no inverse exists for into a mesh of its own.
  void flatten(Instance& instance, const std::string& where) {
    const Mesh& original = scene_.meshes[static_cast<size_t>(instance.mesh)];
    accessors_.spend(original.vertices.size() + original.indices.size(), where);
    instance.mesh = add(transformed(original, instance.worldFromObject), original.name);
    instance.worldFromObject = glm::dmat4(1.0);
  }

  std::optional<Mesh> read(const tinygltf::Primitive& primitive, const Shape& shape,
                           const std::string& where) {
    if (primitive.mode < TINYGLTF_MODE_POINTS || primitive.mode > TINYGLTF_MODE_TRIANGLE_FAN)
      faults_.fail("{}: mode {} is unknown: export it again", where, primitive.mode);
    if (primitive.mode < TINYGLTF_MODE_TRIANGLES) {
      faults_.warnOnce("points and lines are not drawn");
      return std::nullopt;
    }

    Mesh mesh;
    mesh.material = materials_.indexOf(primitive.material, where);
    readPositions(primitive, mesh, where);
    readTriangles(primitive, mesh, where);
    if (mesh.indices.empty()) return std::nullopt;
    const auto assign = [&](const char* name, int components, auto set) {
      return readAttribute(
          primitive.attributes, name, components, mesh.vertices.size(),
          [&](size_t vertex, const float* f) { set(mesh.vertices[vertex], f); }, where);
    };
    assign("TEXCOORD_0", 2, [](Vertex& v, const float* f) { v.uv0 = {f[0], f[1]}; });
    assign("TEXCOORD_1", 2, [](Vertex& v, const float* f) { v.uv1 = {f[0], f[1]}; });
    readColours(primitive, mesh, where);
    const bool hasNormals = assign("NORMAL", 3, [](Vertex& v, const float* f) {
      v.normal = {f[0], f[1], f[2]};
    });
    // Tangents mean nothing without the normals that they were made for.
    const bool hasTangents = hasNormals && assign("TANGENT", 4, [](Vertex& v, const float* f) {
                               v.tangent = {f[0], f[1], f[2], f[3]};
                             });
    deform(primitive, shape, mesh, where);
    // What the file leaves out comes from the shape that is drawn.
    if (hasNormals) {
      normaliseNormals(mesh);
    } else {
      accessors_.spend(mesh.indices.size(), where);
      makeFlat(mesh);
    }
    const TextureUse& normalTexture = scene_.materials[static_cast<size_t>(mesh.material)].normalTexture;
    if (hasTangents)
      normaliseTangents(mesh);
    else if (normalTexture.texture != -1)
      computeTangents(mesh, normalTexture);
    return mesh;
  }

  void readPositions(const tinygltf::Primitive& primitive, Mesh& mesh, const std::string& where) {
    const auto found = primitive.attributes.find("POSITION");
    if (found == primitive.attributes.end()) faults_.fail("{}: has no POSITION: export it again", where);
    const std::vector<float> positions = accessors_.floats(found->second, 3, where + " POSITION");
    mesh.vertices.resize(positions.size() / 3);
    for (size_t i = 0; i < mesh.vertices.size(); ++i)
      mesh.vertices[i].position = {positions[3 * i], positions[3 * i + 1], positions[3 * i + 2]};
  }

  void readTriangles(const tinygltf::Primitive& primitive, Mesh& mesh, const std::string& where) {
    std::vector<uint32_t> indices;
    if (primitive.indices == -1) {
      accessors_.spend(mesh.vertices.size(), where);
      indices.resize(mesh.vertices.size());
      for (size_t i = 0; i < indices.size(); ++i) indices[i] = static_cast<uint32_t>(i);
    } else {
      indices = accessors_.indices(primitive.indices, mesh.vertices.size(), where + " indices");
    }
    if (primitive.mode == TINYGLTF_MODE_TRIANGLE_STRIP)
      mesh.indices = trianglesOfStrip(indices);
    else if (primitive.mode == TINYGLTF_MODE_TRIANGLE_FAN)
      mesh.indices = trianglesOfFan(indices);
    else if (indices.size() % 3 == 0)
      mesh.indices = std::move(indices);
    else
      faults_.fail("{}: {} indices are not whole triangles: export it again", where, indices.size());
  }

  // Calls set(vertex, components) for each vertex; false when there is no such attribute.
  template <typename Set>
  bool readAttribute(const std::map<std::string, int>& attributes, const char* name, int components,
                     size_t vertices, Set set, const std::string& where) {
    const auto found = attributes.find(name);
    if (found == attributes.end()) return false;
    const auto width = static_cast<size_t>(components);
    const std::vector<float> values =
        accessors_.floats(found->second, components, fmt::format("{} {}", where, name));
    if (values.size() != vertices * width)
      faults_.fail("{} {}: has {} elements for {} vertices: export it again", where, name,
                   values.size() / width, vertices);
    for (size_t i = 0; i < vertices; ++i) set(i, &values[i * width]);
    return true;
  }

  void readColours(const tinygltf::Primitive& primitive, Mesh& mesh, const std::string& where) {
    const auto found = primitive.attributes.find("COLOR_0");
    if (found == primitive.attributes.end()) return;
    const bool hasAlpha = accessors_.components(found->second, where) == 4;
    readAttribute(
        primitive.attributes, "COLOR_0", hasAlpha ? 4 : 3, mesh.vertices.size(),
        [&](size_t vertex, const float* f) {
          mesh.vertices[vertex].colour = {f[0], f[1], f[2], hasAlpha ? f[3] : 1.f};
        },
        where);
  }

  void deform(const tinygltf::Primitive& primitive, const Shape& shape, Mesh& mesh,
              const std::string& where) {
    if (!shape.weights.empty()) morph(mesh, readMorph(primitive, shape.weights, mesh.vertices.size(), where));
    if (shape.skin != -1) {
      const auto worldFromRest = skins_.worldFromRest(shape.skin, where);
      skin(mesh, readInfluences(primitive, mesh.vertices.size(), worldFromRest.size(), where), worldFromRest);
    }
    for (size_t i = 0; i < mesh.vertices.size(); ++i)
      for (int axis = 0; axis < 3; ++axis)
        if (!std::isfinite(mesh.vertices[i].position[axis]))
          faults_.fail("{}: vertex {} is moved to where it is not finite: export it again", where, i);
  }

  std::vector<MorphOffset> readMorph(const tinygltf::Primitive& primitive, const std::vector<double>& weights,
                                     size_t vertices, const std::string& where) {
    if (primitive.targets.size() != weights.size())
      faults_.fail("{}: has {} morph targets for {} weights: export it again", where,
                   primitive.targets.size(), weights.size());
    std::vector<MorphOffset> offsets(vertices);
    for (size_t target = 0; target < weights.size(); ++target) {
      if (weights[target] == 0) continue;
      const auto add = [&](const char* name, glm::dvec3 MorphOffset::*part) {
        readAttribute(
            primitive.targets[target], name, 3, vertices,
            [&](size_t vertex, const float* f) {
              offsets[vertex].*part += weights[target] * glm::dvec3(f[0], f[1], f[2]);
            },
            fmt::format("{} morph target {}", where, target));
      };
      add("POSITION", &MorphOffset::position);
      add("NORMAL", &MorphOffset::normal);
      add("TANGENT", &MorphOffset::tangent);
    }
    return offsets;
  }

  std::vector<Influences> readInfluences(const tinygltf::Primitive& primitive, size_t vertices, size_t joints,
                                         const std::string& where) {
    std::vector<std::array<float, 8>> numbers(vertices, std::array<float, 8>{}), weights = numbers;
    const auto read = [&](const char* name, size_t first, auto& into) {
      return readAttribute(
          primitive.attributes, name, 4, vertices,
          [&](size_t vertex, const float* f) { std::copy_n(f, 4, into[vertex].begin() + first); }, where);
    };
    if (!read("JOINTS_0", 0, numbers) || !read("WEIGHTS_0", 0, weights))
      faults_.fail("{}: has a skin, but no JOINTS_0 and WEIGHTS_0: export it again", where);
    if (read("JOINTS_1", 4, numbers) != read("WEIGHTS_1", 4, weights))
      faults_.fail("{}: has only one of JOINTS_1 and WEIGHTS_1: export it again", where);

    std::vector<Influences> influences(vertices);
    for (size_t vertex = 0; vertex < vertices; ++vertex) {
      double sum = 0;
      for (size_t i = 0; i < numbers[vertex].size(); ++i) {
        const float joint = numbers[vertex][i], weight = weights[vertex][i];
        if (weight < 0)
          faults_.fail("{}: a weight of vertex {} is {}: give 0 or more", where, vertex, weight);
        if (weight == 0) continue;
        if (!(joint >= 0 && joint < static_cast<float>(joints)))
          faults_.fail("{}: vertex {} follows joint {}, but the skin has {}: export it again", where, vertex,
                       joint, joints);
        influences[vertex].joints[i] = static_cast<uint32_t>(joint);
        sum += weight;
      }
      if (!(sum > 0)) faults_.fail("{}: vertex {} follows no joint: give it weights", where, vertex);
      for (size_t i = 0; i < numbers[vertex].size(); ++i)
        influences[vertex].weights[i] = static_cast<float>(weights[vertex][i] / sum);
    }
    return influences;
  }

  const Model& model_;
  Faults& faults_;
  Accessors& accessors_;
  Materials& materials_;
  Skins& skins_;
  Scene& scene_;
  std::map<std::pair<Shape, Side>, std::vector<int>> meshes_;
};

// --- What stands at a node ---

// An axis of the node in the world, unit, whatever its scale.
glm::dvec3 worldAxis(const Faults& faults, const glm::dmat4& worldFromNode, int axis,
                     const std::string& where) {
  const glm::dvec3 direction(worldFromNode[axis]);
  const double length = glm::length(direction);
  if (!(length > 0) || !std::isfinite(length))
    faults.fail("{}: its scale leaves no direction to face: give it a scale other than 0", where);
  return direction / length;
}

glm::dmat4 withoutScale(const Faults& faults, const glm::dmat4& worldFromNode, const std::string& where) {
  const glm::dvec3 back = worldAxis(faults, worldFromNode, 2, where);
  const glm::dvec3 upish = worldAxis(faults, worldFromNode, 1, where);
  const glm::dvec3 side = glm::cross(upish, back);
  if (!(glm::length(side) > 1e-9))
    faults.fail("{}: its transform has no up direction: export it again", where);
  const glm::dvec3 right = glm::normalize(side);
  return {glm::dvec4(right, 0), glm::dvec4(glm::cross(back, right), 0), glm::dvec4(back, 0),
          worldFromNode[3]};
}

std::string nameOf(const std::string& nodeName, const std::string& ownName) {
  return printable(nodeName.empty() ? ownName : nodeName);
}

Camera readCamera(const Faults& faults, const tinygltf::Camera& from, const NodeGraph::Placed& placed,
                  const std::string& nodeName, const std::string& where) {
  Camera camera;
  camera.name = nameOf(nodeName, from.name);
  camera.worldFromView = withoutScale(faults, placed.worldFromNode, where);
  camera.orthographic = from.type == "orthographic";
  double farDistance;
  if (camera.orthographic) {
    camera.yMagnitude = from.orthographic.ymag;
    camera.nearDistance = from.orthographic.znear;
    farDistance = from.orthographic.zfar;
    if (!(camera.yMagnitude >= smallestView && camera.yMagnitude <= farthest))
      faults.fail("{}: camera ymag is {}: give {} to {}", where, camera.yMagnitude, smallestView, farthest);
    faults.notNegative(camera.nearDistance, where, "camera znear");
  } else {
    camera.yfov = from.perspective.yfov;
    camera.nearDistance = from.perspective.znear;
    farDistance = from.perspective.zfar == 0 ? infinity : from.perspective.zfar;
    if (!(camera.yfov >= smallestView && camera.yfov < std::numbers::pi))
      faults.fail("{}: camera yfov is {}: give radians from {} to below pi", where, camera.yfov,
                  smallestView);
    if (!(camera.nearDistance > 0))
      faults.fail("{}: camera znear is {}: give more than 0", where, camera.nearDistance);
  }
  if (!(farDistance > camera.nearDistance))
    faults.fail("{}: camera zfar {} is not beyond znear {}: move it out", where, farDistance,
                camera.nearDistance);
  camera.farDistance = farDistance;
  return camera;
}

void checkExtent(const Faults& faults, const Scene& scene) {
  for (const glm::dvec3& p : boundingPoints(scene, {})) {
    const double reach = std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)});
    if (!(reach <= farthest))
      faults.fail("reaches {:.3g} m from the world's origin, and at most {} m can be drawn: scale it down",
                  reach, farthest);
  }
}

void readCone(const Faults& faults, const tinygltf::SpotLight& spot, Light& light, const std::string& where) {
  constexpr double rounding = 1e-6;  // exporters write pi/2 in single precision
  const double largest = std::numbers::pi / 2;
  light.innerCone = spot.innerConeAngle;
  light.outerCone = spot.outerConeAngle;
  if (!(light.innerCone >= 0 && light.innerCone < light.outerCone && light.outerCone <= largest + rounding))
    faults.fail("{}: spot light's cones are {} and {}: give 0 <= innerConeAngle < outerConeAngle <= pi/2",
                where, light.innerCone, light.outerCone);
  light.outerCone = std::min(light.outerCone, largest);
}

// Extras "shadow" of the light, and before them of its node.
Light readLight(const Faults& faults, const tinygltf::Light& from, const NodeGraph::Placed& placed,
                const tinygltf::Node& node, const std::string& where) {
  Light light;
  light.name = nameOf(node.name, from.name);
  light.castsShadow = truth(faults, from.extras, "shadow", light.castsShadow, where);
  light.castsShadow = truth(faults, node.extras, "shadow", light.castsShadow, where);
  light.position = glm::dvec3(placed.worldFromNode[3]);
  checkLength(faults, from.color, 3, where, "light colour");
  for (int c = 0; c < 3; ++c) {
    const double colour = from.color.empty() ? 1 : from.color[static_cast<size_t>(c)];
    faults.notNegative(colour, where, "light colour");
    light.intensity[c] = faults.notNegative(
        colour * faults.notNegative(from.intensity, where, "light intensity"), where, "light intensity");
  }
  if (from.type == "directional")
    light.type = LightType::Directional;
  else if (from.type == "point")
    light.type = LightType::Point;
  else if (from.type == "spot")
    light.type = LightType::Spot;
  else
    faults.fail("{}: light type \"{}\" is unknown: use directional, point or spot", where,
                printable(from.type));

  if (light.type != LightType::Point) light.direction = -worldAxis(faults, placed.worldFromNode, 2, where);
  if (light.type == LightType::Spot) readCone(faults, from.spot, light, where);
  if (light.type != LightType::Directional && from.range != 0)  // tinygltf's 0: none given
    light.range = faults.notNegative(from.range, where, "light range");
  return light;
}

// Colours one after the other.
std::vector<glm::dvec3> colourRamp(const Faults& faults, const Value& extras, const char* key,
                                   const std::string& where) {
  const Value& list = extras.Get(key);
  const size_t count = list.ArrayLen();
  if (count < 2 || count > 256)
    faults.fail("{}: {} is not an array of 2 to 256 colours: give that many", where, key);
  std::vector<glm::dvec3> ramp;
  for (size_t i = 0; i < count; ++i) {
    const Value& colour = list.Get(static_cast<int>(i));
    for (int c = 0; c < 3; ++c) {
      if (colour.ArrayLen() != 3 || !colour.Get(c).IsNumber())
        faults.fail("{}: {} has a colour that is not three numbers: give red, green and blue", where, key);
      if (c == 0) ramp.emplace_back(0);
      ramp.back()[c] = faults.inRange(colour.Get(c).GetNumberAsDouble(), 0, 1e6, where, key);
    }
  }
  return ramp;
}

// Extras "volume_fire" and its companions.
FirePlacement readFire(const Faults& faults, const Value& extras, const std::string& where) {
  FirePlacement fire;
  fire.gridName = text(faults, extras, "volume_fire", where);
  if (fire.gridName.empty()) {
    for (const std::string& key : extras.Keys())
      if (key.starts_with("volume_fire"))
        faults.fail("{}: {} without a grid that glows: name one as volume_fire", where, printable(key));
    return fire;
  }
  fire.look = volumes::usualLook(fire.gridName);
  const bool hasRamp = extras.Has("volume_fire_ramp");
  if (hasRamp && extras.Has("volume_fire_kelvin"))
    faults.fail("{}: volume_fire_ramp and volume_fire_kelvin: give one of them", where);
  if (hasRamp) fire.look = {.ramp = colourRamp(faults, extras, "volume_fire_ramp", where)};
  if (extras.Has("volume_fire_kelvin"))
    fire.look = {.kelvin = faults.inRange(number(faults, extras, "volume_fire_kelvin", 1, where), 1e-6, 1e6,
                                          where, "volume_fire_kelvin")};
  fire.look.strength = faults.inRange(number(faults, extras, "volume_fire_strength", 1, where), 0, 1e6, where,
                                      "volume_fire_strength");
  fire.lights = static_cast<int>(faults.inRange(index(faults, extras, "volume_fire_lights", 0, where), 0, 64,
                                                where, "volume_fire_lights"));
  return fire;
}

// Extras "volume" and its companions.
VolumePlacement readVolume(const Faults& faults, const Value& extras, const glm::dmat4& worldFromNode,
                           const fs::path& folder, const std::string& where) {
  VolumePlacement volume;
  const std::string file = text(faults, extras, "volume", where);
  if (file.empty()) faults.fail("{}: volume is empty: name a .vdb file", where);
  volume.file = (folder / file).string();
  volume.gridName = text(faults, extras, "volume_grid", where);
  volume.scale =
      faults.notNegative(number(faults, extras, "volume_scale", volume.scale, where), where, "volume_scale");
  volume.extinctionColour = numbers(faults, extras, "volume_extinction", volume.extinctionColour, where);
  for (int c = 0; c < 3; ++c) faults.inRange(volume.extinctionColour[c], 0, 1e6, where, "volume_extinction");
  volume.albedo = numbers(faults, extras, "volume_albedo", volume.albedo, where);
  for (int c = 0; c < 3; ++c) faults.inRange(volume.albedo[c], 0, 1, where, "volume_albedo");
  volume.g = number(faults, extras, "volume_g", volume.g, where);
  if (!(std::abs(volume.g) < 1)) faults.fail("{}: volume_g is {}: give a value in (-1, 1)", where, volume.g);
  volume.fire = readFire(faults, extras, where);
  const double volumeScale = std::abs(glm::determinant(glm::dmat3(worldFromNode)));
  if (!(volumeScale > 0) || !std::isfinite(volumeScale))
    faults.fail("{}: its volume has no extent: give it a scale other than 0", where);
  volume.worldFromGridWorld = worldFromNode;
  return volume;
}

// Extras "ambient" of the scene.
glm::dvec3 readAmbient(const Faults& faults, const Model& model) {
  if (model.scenes.empty()) return glm::dvec3(0);
  const Value& extras = model.scenes[static_cast<size_t>(sceneNumber(model))].extras;
  const std::string where = sceneLabel(model);
  const glm::dvec3 ambient = numbers(faults, extras, "ambient", glm::dvec3(0), where);
  for (int c = 0; c < 3; ++c) faults.inRange(ambient[c], 0, 1e6, where, "ambient");
  return ambient;
}

Scene convert(Model model, const fs::path& path, std::optional<double> seconds, Faults& faults) {
  checkExtensions(model, faults);
  Scene scene;
  Accessors accessors(model, faults);
  if (seconds) Animations(model, faults, accessors).pose(*seconds);
  if (seconds && model.animations.empty()) faults.warnOnce("has no animations: it is at rest at any time");
  const std::vector<NodeGraph::Placed> nodes = NodeGraph(model, faults).place();
  Materials materials(model, faults, accessors, scene);
  materials.readAll();
  Skins skins(model, faults, accessors, nodes);
  Meshes meshes(model, faults, accessors, materials, skins, scene);

  for (const NodeGraph::Placed& placed : nodes) {
    const tinygltf::Node& node = model.nodes[placed.node];
    const std::string where = nodeLabel(model, placed.node);
    if (!fitsFloat(placed.worldFromNode))
      faults.fail("{}: its transform is not finite: export it again", where);
    if (node.mesh != -1) meshes.place(node, placed.worldFromNode, where);
    if (node.camera != -1)
      scene.cameras.push_back(readCamera(faults, faults.at(model.cameras, node.camera, where, "camera"),
                                         placed, node.name, where));
    if (const Value* lights = find(node.extensions, "KHR_lights_punctual")) {
      const int light = index(faults, *lights, "light", -1, where);
      scene.lights.push_back(
          readLight(faults, faults.at(model.lights, light, where, "light"), placed, node, where));
    }
    if (node.extras.Has("volume"))
      scene.volumes.push_back(
          readVolume(faults, node.extras, placed.worldFromNode, path.parent_path(), where));
  }
  scene.ambient = readAmbient(faults, model);  // the scene is one that exists: its nodes were read
  checkExtent(faults, scene);
  return scene;
}

}  // namespace

Scene readGltf(const fs::path& path, std::optional<double> seconds) {
  Faults faults(path);
  try {
    return convert(parse(path, faults), path, seconds, faults);
  } catch (const base::Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    base::fail(ExitCode::Memory, "{}: needs more memory than there is: make the scene smaller",
               faults.path());
  } catch (const std::exception& error) {  // from within tinygltf
    faults.fail("is damaged: {}: export it again", printable(error.what(), 300));
  }
}

}  // namespace sfumato::scene
