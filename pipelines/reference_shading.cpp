#include "pipelines/reference_shading.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace sfumato::pipelines {

namespace {

using scene::AlphaMode;
using scene::Light;
using scene::LightType;
using scene::Material;
using scene::Scene;
using scene::Texture;
using scene::TextureUse;
using scene::Wrap;

constexpr double smallestRoughness = 0.03;

double linearFromSrgb(double value) {
  return value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4);
}

glm::dvec4 texel(const Texture& texture, long x, long y, bool srgb) {
  static const auto decoded = [] {
    std::array<double, 256> table;
    for (size_t code = 0; code < table.size(); ++code) table[code] = linearFromSrgb(code / 255.0);
    return table;
  }();
  const uint8_t* code = texture.rgba.data() + 4 * (static_cast<size_t>(y) * texture.width + x);
  const auto rgb = [&](int channel) { return srgb ? decoded[code[channel]] : code[channel] / 255.0; };
  return {rgb(0), rgb(1), rgb(2), code[3] / 255.0};
}

// The coordinate brought to where its texels can be counted: within one period, or the border.
double reduce(double coordinate, Wrap wrap) {
  if (!std::isfinite(coordinate)) return 0;
  if (wrap == Wrap::ClampToEdge) return std::clamp(coordinate, 0.0, 1.0);
  const double period = wrap == Wrap::Repeat ? 1 : 2;
  return coordinate - period * std::floor(coordinate / period);
}

long wrapTexel(long index, long size, Wrap wrap) {
  if (wrap == Wrap::ClampToEdge) return std::clamp(index, 0L, size - 1);
  const long period = wrap == Wrap::Repeat ? size : 2 * size;
  const long inPeriod = (index % period + period) % period;
  return inPeriod < size ? inPeriod : period - 1 - inPeriod;
}

glm::dvec4 sample(const Scene& scene, const TextureUse& use, const SurfacePoint& point, bool srgb) {
  if (use.texture < 0) return glm::dvec4(1.0);
  const glm::dvec2 uv = glm::dmat3x2(use.textureFromUv) * glm::dvec3(point.uv[use.uvSet == 1], 1);
  return sampleTexture(scene.textures[static_cast<size_t>(use.texture)], uv, srgb);
}

glm::dvec3 mappedNormal(const Scene& scene, const Material& material, const SurfacePoint& point) {
  if (material.normalTexture.texture < 0) return point.normal;
  const glm::dvec3 n = point.normal;
  const glm::dvec3 along = glm::dvec3(point.tangent) - n * glm::dot(n, glm::dvec3(point.tangent));
  if (!(glm::length(along) > 0)) return n;
  const glm::dvec3 t = glm::normalize(along);
  const glm::dvec3 b = glm::cross(n, t) * point.tangent.w;
  glm::dvec3 m = glm::dvec3(sample(scene, material.normalTexture, point, false)) * 2.0 - 1.0;
  m *= glm::dvec3(material.normalScale, material.normalScale, 1);
  const glm::dvec3 mapped = m.x * t + m.y * b + m.z * n;
  return glm::length(mapped) > 0 ? glm::normalize(mapped) : n;
}

double largest(const glm::dvec3& v) {
  return std::max({v.x, v.y, v.z});
}

double spotFactor(const Light& light, const glm::dvec3& toLight) {
  const double outer = std::cos(light.outerCone);
  const double scale = 1 / std::max(0.001, std::cos(light.innerCone) - outer);
  const double cosine = glm::dot(light.direction, -toLight);
  const double linear = std::clamp((cosine - outer) * scale, 0.0, 1.0);
  return linear * linear;
}

double rangeFactor(double distance, double range) {
  if (!std::isfinite(range)) return 1;
  return std::clamp(1 - std::pow(distance / range, 4), 0.0, 1.0);
}

}  // namespace

glm::dvec4 sampleTexture(const Texture& texture, const glm::dvec2& uv, bool srgb) {
  const double x = reduce(uv.x, texture.wrapS) * texture.width;
  const double y = reduce(uv.y, texture.wrapT) * texture.height;
  const auto at = [&](double column, double row) {
    return texel(texture, wrapTexel(static_cast<long>(column), texture.width, texture.wrapS),
                 wrapTexel(static_cast<long>(row), texture.height, texture.wrapT), srgb);
  };
  if (texture.nearest) return at(std::floor(x), std::floor(y));
  const double left = std::floor(x - 0.5);
  const double top = std::floor(y - 0.5);
  const glm::dvec4 upper = glm::mix(at(left, top), at(left + 1, top), x - 0.5 - left);
  const glm::dvec4 lower = glm::mix(at(left, top + 1), at(left + 1, top + 1), x - 0.5 - left);
  return glm::mix(upper, lower, y - 0.5 - top);
}

Coverage coverageAt(const Scene& scene, const Material& material, const SurfacePoint& point) {
  const glm::dvec4 base =
      glm::dvec4(material.baseColour) * sample(scene, material.baseColourTexture, point, true) * point.colour;
  Coverage coverage;
  coverage.baseColour = glm::dvec3(base);
  if (material.alphaMode == AlphaMode::Blend) coverage.alpha = base.a;
  if (material.alphaMode == AlphaMode::Mask) coverage.alpha = base.a < material.alphaCutoff ? 0 : 1;
  coverage.transmission = material.transmission * sample(scene, material.transmissionTexture, point, false).r;
  return coverage;
}

Reflector reflectorAt(const Scene& scene, const Material& material, const SurfacePoint& point,
                      const Coverage& coverage) {
  const glm::dvec4 metallicRoughness = sample(scene, material.metallicRoughnessTexture, point, false);
  const double metallic = material.metallic * metallicRoughness.b;
  const double specular = material.specular * sample(scene, material.specularTexture, point, false).a;
  const glm::dvec3 specularColour = glm::dvec3(material.specularColour) *
                                    glm::dvec3(sample(scene, material.specularColourTexture, point, true));
  const glm::dvec3 dielectric0 = glm::min(0.04 * specularColour, 1.0) * specular;

  Reflector reflector;
  reflector.alpha = coverage.alpha;
  const bool fromBehind = glm::dot(point.normal, point.geometricNormal) < 0;
  reflector.normal = mappedNormal(scene, material, point) * (fromBehind ? -1.0 : 1.0);
  if (material.unlit) {
    reflector.emitted = coverage.alpha * coverage.baseColour;
    reflector.specular90 = 0;
    return reflector;
  }
  reflector.diffuse = coverage.baseColour * (1 - metallic) * coverage.alpha * (1 - coverage.transmission);
  reflector.roughness = std::clamp(material.roughness * metallicRoughness.g, smallestRoughness, 1.0);
  reflector.specular0 = glm::mix(dielectric0, coverage.baseColour, metallic);
  reflector.specular90 = glm::mix(specular, 1.0, metallic);
  reflector.emitted = coverage.alpha * glm::dvec3(material.emissive) *
                      glm::dvec3(sample(scene, material.emissiveTexture, point, true));
  return reflector;
}

glm::dvec3 brdf(const Reflector& reflector, const glm::dvec3& toViewer, const glm::dvec3& toLight) {
  const double nDotL = glm::dot(reflector.normal, toLight);
  if (!(nDotL > 0)) return glm::dvec3(0);
  const glm::dvec3 half = glm::normalize(toViewer + toLight);
  const double nDotV = std::max(glm::dot(reflector.normal, toViewer), 0.0);
  const double nDotH = std::clamp(glm::dot(reflector.normal, half), 0.0, 1.0);
  const double vDotH = std::clamp(glm::dot(toViewer, half), 0.0, 1.0);

  const glm::dvec3 f =
      reflector.specular0 + (reflector.specular90 - reflector.specular0) * std::pow(1 - vDotH, 5);
  const double width2 = std::pow(reflector.roughness, 4);
  const double spread = nDotH * nDotH * (width2 - 1) + 1;
  const double d = width2 / (std::numbers::pi * spread * spread);
  const auto shadowing = [&](double cosine) { return std::sqrt(cosine * cosine * (1 - width2) + width2); };
  const double v = 0.5 / (nDotL * shadowing(nDotV) + nDotV * shadowing(nDotL));
  return reflector.diffuse / std::numbers::pi * (1 - largest(f)) + reflector.alpha * d * v * f;
}

glm::dvec3 ambientAlbedo(const Reflector& reflector) {
  return reflector.diffuse * (1 - largest(reflector.specular0)) + reflector.alpha * reflector.specular0;
}

Illumination illuminate(const Light& light, const glm::dvec3& pWorld) {
  if (light.type == LightType::Directional) return {-light.direction, scene::infinity, light.intensity};
  const glm::dvec3 path = light.position - pWorld;
  const double distance = glm::length(path);
  if (!(distance > 0)) return {};
  const glm::dvec3 toLight = path / distance;
  double factor = rangeFactor(distance, light.range) / (distance * distance);
  if (light.type == LightType::Spot) factor *= spotFactor(light, toLight);
  return {toLight, distance, light.intensity * factor};
}

}  // namespace sfumato::pipelines
