#include "gl/device.h"

#include <dlfcn.h>
#include <epoxy/egl.h>
#include <epoxy/gl.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <optional>
#include <string_view>

#include "base/error.h"
#include "gl/program.h"

namespace sfumato::gl {

using base::ExitCode;
using base::fail;

namespace {

// A display that a context may be made on.
struct Candidate {
  std::string platform;
  EGLenum eglPlatform = 0;  // 0: eglGetDisplay
  void* native = nullptr;
};

bool hasWord(const char* list, std::string_view word) {
  if (list == nullptr) return false;
  const std::string_view text(list);
  for (size_t at = text.find(word); at != std::string_view::npos; at = text.find(word, at + 1)) {
    const bool starts = at == 0 || text[at - 1] == ' ';
    const size_t end = at + word.size();
    if (starts && (end == text.size() || text[end] == ' ')) return true;
  }
  return false;
}

std::string eglProblem(const char* call) {
  return fmt::format("{} failed (EGL error 0x{:04x})", call, static_cast<unsigned>(eglGetError()));
}

// libepoxy ends the program when these libraries are missing, so they are asked for first.
void requireLibraries() {
  if (dlopen("libEGL.so.1", RTLD_LAZY | RTLD_GLOBAL) == nullptr)
    fail(ExitCode::NoGl,
         "no OpenGL: libEGL.so.1 cannot be loaded: install libegl1 and a driver (libgl1-mesa-dri)");
  if (dlopen("libOpenGL.so.0", RTLD_LAZY | RTLD_GLOBAL) == nullptr &&
      dlopen("libGL.so.1", RTLD_LAZY | RTLD_GLOBAL) == nullptr)
    fail(ExitCode::NoGl,
         "no OpenGL: neither libOpenGL.so.0 nor libGL.so.1 can be loaded: install libopengl0");
}

std::vector<Candidate> candidates() {
  requireLibraries();
  setenv("EGL_LOG_LEVEL", "fatal", 0);  // our line says what failed, without Mesa's before it
  const char* extensions = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
  std::vector<Candidate> found;
  if (hasWord(extensions, "EGL_EXT_platform_device") &&
      (hasWord(extensions, "EGL_EXT_device_enumeration") || hasWord(extensions, "EGL_EXT_device_base"))) {
    EGLint count = 0;
    if (eglQueryDevicesEXT(0, nullptr, &count) && count > 0) {
      std::vector<EGLDeviceEXT> devices(static_cast<size_t>(count));
      eglQueryDevicesEXT(count, devices.data(), &count);
      for (int i = 0; i < count; ++i)
        found.push_back(
            {fmt::format("device {}", i), EGL_PLATFORM_DEVICE_EXT, devices[static_cast<size_t>(i)]});
    }
  }
  if (hasWord(extensions, "EGL_MESA_platform_surfaceless"))
    found.push_back({"surfaceless", EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY});
  found.push_back({"default", 0, EGL_DEFAULT_DISPLAY});
  return found;
}

bool isSoftware(const std::string& renderer) {
  for (const char* name : {"llvmpipe", "softpipe", "lavapipe", "swrast", "SwiftShader"})
    if (renderer.find(name) != std::string::npos) return true;
  return false;
}

std::string glString(GLenum name) {
  const GLubyte* text = glGetString(name);
  return text == nullptr ? std::string() : reinterpret_cast<const char*>(text);
}

template <typename T = int>
T glInteger(GLenum name) {
  GLint64 value = 0;
  glGetInteger64v(name, &value);
  return static_cast<T>(value);
}

Limits readLimits() {
  Limits limits;
  limits.storageBlockBytes = glInteger<int64_t>(GL_MAX_SHADER_STORAGE_BLOCK_SIZE);
  limits.storageBindings = glInteger(GL_MAX_SHADER_STORAGE_BUFFER_BINDINGS);
  limits.computeStorageBlocks = glInteger(GL_MAX_COMPUTE_SHADER_STORAGE_BLOCKS);
  limits.fragmentStorageBlocks = glInteger(GL_MAX_FRAGMENT_SHADER_STORAGE_BLOCKS);
  limits.vertexStorageBlocks = glInteger(GL_MAX_VERTEX_SHADER_STORAGE_BLOCKS);
  limits.geometryStorageBlocks = glInteger(GL_MAX_GEOMETRY_SHADER_STORAGE_BLOCKS);
  limits.vertexImages = glInteger(GL_MAX_VERTEX_IMAGE_UNIFORMS);
  limits.geometryImages = glInteger(GL_MAX_GEOMETRY_IMAGE_UNIFORMS);
  limits.vertexCounters = glInteger(GL_MAX_VERTEX_ATOMIC_COUNTERS);
  limits.geometryCounters = glInteger(GL_MAX_GEOMETRY_ATOMIC_COUNTERS);
  limits.texture2dSize = glInteger(GL_MAX_TEXTURE_SIZE);
  limits.texture3dSize = glInteger(GL_MAX_3D_TEXTURE_SIZE);
  limits.textureBufferTexels = glInteger<int64_t>(GL_MAX_TEXTURE_BUFFER_SIZE);
  limits.framebufferSize =
      std::min(glInteger(GL_MAX_FRAMEBUFFER_WIDTH), glInteger(GL_MAX_FRAMEBUFFER_HEIGHT));
  limits.framebufferLayers = glInteger(GL_MAX_FRAMEBUFFER_LAYERS);
  GLint viewport[2] = {0, 0};
  glGetIntegerv(GL_MAX_VIEWPORT_DIMS, viewport);
  limits.viewportSize = std::min(viewport[0], viewport[1]);
  limits.samples =
      std::min({glInteger(GL_MAX_SAMPLES), glInteger(GL_MAX_INTEGER_SAMPLES),
                glInteger(GL_MAX_COLOR_TEXTURE_SAMPLES), glInteger(GL_MAX_DEPTH_TEXTURE_SAMPLES)});
  glGetQueryiv(GL_TIMESTAMP, GL_QUERY_COUNTER_BITS, &limits.timerBits);
  return limits;
}

void APIENTRY keepMessage(GLenum, GLenum, GLuint, GLenum severity, GLsizei length, const GLchar* text,
                          const void* user) {
  if (severity != GL_DEBUG_SEVERITY_HIGH && severity != GL_DEBUG_SEVERITY_MEDIUM) return;
  auto* messages = static_cast<std::vector<std::string>*>(const_cast<void*>(user));
  messages->emplace_back(text, length < 0 ? std::string_view(text).size() : static_cast<size_t>(length));
}

bool equalNoCase(std::string_view haystack, std::string_view needle) {
  const auto same = [](char a, char b) {
    return std::tolower(static_cast<unsigned char>(a)) == std::tolower(static_cast<unsigned char>(b));
  };
  return std::search(haystack.begin(), haystack.end(), needle.begin(), needle.end(), same) != haystack.end();
}

bool matches(const std::string& choice, size_t index, const DeviceNames& names) {
  if (choice.empty()) return true;
  if (choice == "software") return names.software;
  if (std::all_of(choice.begin(), choice.end(), [](unsigned char c) { return std::isdigit(c); }))
    return choice == std::to_string(index);
  return equalNoCase(names.renderer, choice);
}

}  // namespace

// What OpenGL has had since 4.0 to 4.3, by the names of the extensions that it was before.
constexpr const char* partsOf43[] = {"compute_shader",
                                     "shader_storage_buffer_object",
                                     "shader_image_load_store",
                                     "shader_atomic_counters",
                                     "framebuffer_no_attachments",
                                     "program_interface_query",
                                     "gpu_shader5",
                                     "gpu_shader_fp64",
                                     "vertex_attrib_64bit",
                                     "tessellation_shader",
                                     "sample_shading",
                                     "shader_subroutine",
                                     "texture_cube_map_array",
                                     "texture_buffer_range",
                                     "texture_view",
                                     "viewport_array",
                                     "transform_feedback3"};

// A current context, ended and released with it.
struct Device::Egl {
  EGLDisplay display = EGL_NO_DISPLAY;
  EGLContext context = EGL_NO_CONTEXT;
  bool tellsResets = false;

  ~Egl() {
    if (display == EGL_NO_DISPLAY) return;
    eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    if (context != EGL_NO_CONTEXT) eglDestroyContext(display, context);
    eglTerminate(display);
  }

  // Makes a context on the candidate current. Returns the problem, empty when there is none.
  std::string open(const Candidate& candidate, bool debug, bool robust = false) {
    // The EXT entry: libepoxy ends the program when the core one is called before an EGL 1.5 display exists.
    display = candidate.eglPlatform == 0
                  ? eglGetDisplay(EGL_DEFAULT_DISPLAY)
                  : eglGetPlatformDisplayEXT(candidate.eglPlatform, candidate.native, nullptr);
    if (display == EGL_NO_DISPLAY) return eglProblem("eglGetPlatformDisplay");
    if (!eglInitialize(display, nullptr, nullptr)) {
      const std::string problem = eglProblem("eglInitialize");
      display = EGL_NO_DISPLAY;
      return problem;
    }
    if (!hasWord(eglQueryString(display, EGL_EXTENSIONS), "EGL_KHR_surfaceless_context"))
      return "no EGL_KHR_surfaceless_context";
    if (!eglBindAPI(EGL_OPENGL_API)) return eglProblem("eglBindAPI(OpenGL)");
    const EGLint configAttributes[] = {EGL_SURFACE_TYPE, EGL_DONT_CARE, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT,
                                       EGL_NONE};
    EGLConfig config = nullptr;
    EGLint configs = 0;
    if (!eglChooseConfig(display, configAttributes, &config, 1, &configs) || configs == 0)
      return eglProblem("eglChooseConfig");
    std::vector<EGLint> attributes;
    if (debug) attributes.insert(attributes.end(), {EGL_CONTEXT_OPENGL_DEBUG, EGL_TRUE});
    if (robust) {  // drivers that cannot tell of resets refuse it
      std::vector<EGLint> robustly = attributes;
      robustly.insert(robustly.end(),
                      {EGL_CONTEXT_OPENGL_RESET_NOTIFICATION_STRATEGY_KHR, EGL_LOSE_CONTEXT_ON_RESET_KHR});
      context = createContext(config, 4, 3, robustly);
      tellsResets = context != EGL_NO_CONTEXT;
    }
    if (context == EGL_NO_CONTEXT) context = createContext(config, 4, 3, attributes);
    if (context == EGL_NO_CONTEXT) return "no OpenGL 4.3 core context" + whatThereIs(config);
    if (!eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context))
      return eglProblem("eglMakeCurrent");
    if (epoxy_gl_version() < 43)
      return fmt::format("only OpenGL {}.{}", epoxy_gl_version() / 10, epoxy_gl_version() % 10);
    return {};
  }

  EGLContext createContext(EGLConfig config, int major, int minor, std::vector<EGLint> attributes) const {
    attributes.insert(attributes.end(),
                      {EGL_CONTEXT_MAJOR_VERSION, major, EGL_CONTEXT_MINOR_VERSION, minor,
                       EGL_CONTEXT_OPENGL_PROFILE_MASK, EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT, EGL_NONE});
    return eglCreateContext(display, config, EGL_NO_CONTEXT, attributes.data());
  }

  // What a driver without 4.3 has instead, and which parts of 4.3 that we need are absent.
  std::string whatThereIs(EGLConfig config) {
    context = createContext(config, 3, 1, {});
    if (context == EGL_NO_CONTEXT || !eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context))
      return {};
    std::string answer = fmt::format(" ({} has {}.{}", glString(GL_RENDERER), epoxy_gl_version() / 10,
                                     epoxy_gl_version() % 10);
    const char* separator = ", without ";
    for (const char* part : partsOf43)
      if (!epoxy_has_gl_extension((std::string("GL_ARB_") + part).c_str())) {
        answer += separator + std::string(part);
        separator = ", ";
      }
    return answer + ")";
  }

  static DeviceNames names(const Candidate& candidate) {
    DeviceNames names{glString(GL_VENDOR), glString(GL_RENDERER), glString(GL_VERSION), candidate.platform};
    names.software = isSoftware(names.renderer);
    return names;
  }
};

std::vector<DeviceEntry> listDevices() {
  std::vector<DeviceEntry> entries;
  for (const Candidate& candidate : candidates()) {
    DeviceEntry entry;
    entry.index = static_cast<int>(entries.size());
    Device::Egl egl;
    entry.problem = egl.open(candidate, false);
    entry.names =
        entry.problem.empty() ? Device::Egl::names(candidate) : DeviceNames{.platform = candidate.platform};
    entries.push_back(std::move(entry));
  }
  return entries;
}

Device::Device(const DeviceOptions& options)
    : shaderDir_(options.shaderDir), debugMessages_(std::make_unique<std::vector<std::string>>()) {
  if (options.choice == "software") setenv("LIBGL_ALWAYS_SOFTWARE", "1", 0);
  std::string answers;
  size_t index = 0;
  for (const Candidate& candidate : candidates()) {
    auto egl = std::make_unique<Egl>();
    const std::string problem = egl->open(candidate, options.debug, options.examine);
    if (problem.empty()) {
      const DeviceNames names = Egl::names(candidate);
      if (matches(options.choice, index, names)) {
        tellsResets_ = egl->tellsResets && epoxy_has_gl_extension("GL_KHR_robustness");
        egl_ = std::move(egl);
        names_ = names;
        break;
      }
      answers += fmt::format("; {}: {}", candidate.platform, names.renderer);
    } else {
      answers += fmt::format("; {}: {}", candidate.platform, problem);
    }
    ++index;
  }
  if (!egl_) {
    if (options.choice.empty())
      fail(ExitCode::NoGl, "no usable OpenGL 4.3 (tried{}): install a driver, e.g. libgl1-mesa-dri",
           answers.substr(1));
    fail(ExitCode::NoGl, "no device \"{}\" (there are{}): see `sfumato info`", options.choice,
         answers.substr(1));
  }
  limits_ = readLimits();
  if (!options.examine &&
      (limits_.storageBindings < storageBindingsUsed || limits_.computeStorageBlocks < storageBlocksUsed))
    fail(ExitCode::NoGl,
         "{}: {} storage bindings and {} storage blocks in a compute shader, {} and {} are needed: use "
         "--device",
         names_.renderer, limits_.storageBindings, limits_.computeStorageBlocks, storageBindingsUsed,
         storageBlocksUsed);
  if (options.debug) {
    glEnable(GL_DEBUG_OUTPUT);
    glEnable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
    glDebugMessageCallback(keepMessage, debugMessages_.get());
  }
  glGenVertexArrays(1, &emptyVertexArray_);
}

Device::~Device() = default;

bool Device::has(std::string_view extension) const {
  return epoxy_has_gl_extension(std::string(extension).c_str());
}

Reset Device::resetStatus() const {
  if (!tellsResets_) return Reset::None;
  switch (glGetGraphicsResetStatusKHR()) {
    case GL_NO_ERROR:
      return Reset::None;
    case GL_GUILTY_CONTEXT_RESET:
      return Reset::Guilty;
    case GL_INNOCENT_CONTEXT_RESET:
      return Reset::Innocent;
    default:
      return Reset::Unknown;
  }
}

std::map<std::string, size_t> Device::programBytes() const {
  std::map<std::string, size_t> bytes;
  for (const auto& [key, program] : programs_) {
    // Files and defines, a line each.
    std::string label = key.substr(0, key.size() - 1);
    std::replace(label.begin(), label.end(), '\n', ' ');
    bytes[label] = program->bytes();
  }
  return bytes;
}

const Program& Device::program(const std::vector<std::string>& names, const ShaderDefines& defines) {
  std::string key;
  for (const std::string& name : names) key += name + '\n';
  for (const auto& [name, value] : defines) key += name + '=' + value + '\n';
  std::unique_ptr<Program>& entry = programs_[key];
  if (!entry) entry = std::make_unique<Program>(*this, names, defines);
  return *entry;
}

}  // namespace sfumato::gl
