// A GL 4.3 core context without a window, through EGL, and what must be known about the device behind it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "gl/memory_ledger.h"
#include "gl/profiler.h"

namespace sfumato::gl {

class Program;
using ShaderDefines = std::vector<std::pair<std::string, std::string>>;
inline ShaderDefines joined(ShaderDefines defines, const ShaderDefines& more) {
  defines.insert(defines.end(), more.begin(), more.end());
  return defines;
}

// What the driver says of itself.
struct DeviceNames {
  std::string vendor;
  std::string renderer;
  std::string version;
  std::string platform;  // how EGL reached it: "device 0", "surfaceless" or "default"
  bool software = false;
};

// What our passes need at once; a device with less is refused.
constexpr int storageBindingsUsed = 25;  // shaders/shared/bindings.h counts them
constexpr int storageBlocksUsed = 12;    // in one compute program, the resolve

// The limits that matter here.
struct Limits {
  int64_t storageBlockBytes = 0;  // one SSBO block
  int storageBindings = 0;
  int computeStorageBlocks = 0;
  int fragmentStorageBlocks = 0;
  int vertexStorageBlocks = 0;
  int geometryStorageBlocks = 0;
  int vertexImages = 0;
  int geometryImages = 0;
  int vertexCounters = 0;
  int geometryCounters = 0;
  int texture2dSize = 0;
  int texture3dSize = 0;
  int framebufferSize = 0;
  int framebufferLayers = 0;
  int viewportSize = 0;
  int64_t textureBufferTexels = 0;
  int samples = 0;  // that every texture format can have
  int timerBits = 0;
};

// One EGL device (or platform display) and what it answered when it was asked for a 4.3 core context.
struct DeviceEntry {
  int index = 0;
  DeviceNames names;    // filled when usable
  std::string problem;  // empty when usable
};

struct DeviceOptions {
  std::string
      choice;  // "": the first that works; "N": by index; "software"; else part of its renderer's name
  bool debug = false;               // a debug context: the driver's messages are kept
  std::filesystem::path shaderDir;  // files there stand in for the built-in shaders of the same name
  bool examine = false;  // for the validation: takes devices with less than our passes need as well, and asks
                         // for a context that says when it was reset
};

// Whether the driver gave the context up: after that, nothing that it answers means anything.
enum class Reset { None, Guilty, Innocent, Unknown };  // who is to blame, this context or another

// Every device that EGL shows, in the order of the indices that DeviceOptions::choice takes.
// Throws NoGl when there is no EGL at all.
std::vector<DeviceEntry> listDevices();

// The context, current on the thread that made it; all GPU objects must die before it.
class Device {
 public:
  // Throws NoGl in one line that says what was tried and what each answered.
  explicit Device(const DeviceOptions& options);
  ~Device();
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

  const DeviceNames& names() const { return names_; }
  const Limits& limits() const { return limits_; }
  const std::filesystem::path& shaderDir() const { return shaderDir_; }

  // Whether the driver has this extension, "GL_…".
  bool has(std::string_view extension) const;
  // Whether resetStatus() can be anything but None.
  bool tellsResets() const { return tellsResets_; }
  Reset resetStatus() const;

  MemoryLedger& memory() { return memory_; }
  Profiler& profiler() { return profiler_; }

  // Messages of medium severity or above that the driver sent so far (debug contexts only).
  const std::vector<std::string>& debugMessages() const { return *debugMessages_; }

  // The program of these shader files and defines (gl/program.h), built when it is first asked for.
  const Program& program(const std::vector<std::string>& names, const ShaderDefines& defines = {});

  // The bytes of all of them: gl/program.h. Asking takes the driver a while.
  std::map<std::string, size_t> programBytes() const;

  // For draws without attributes: a core profile draws nothing without a vertex array.
  unsigned emptyVertexArray() const { return emptyVertexArray_; }

 private:
  friend std::vector<DeviceEntry> listDevices();
  struct Egl;
  std::unique_ptr<Egl> egl_;
  DeviceNames names_;
  Limits limits_;
  std::filesystem::path shaderDir_;
  bool tellsResets_ = false;
  std::unique_ptr<std::vector<std::string>> debugMessages_;
  unsigned emptyVertexArray_ = 0;
  std::map<std::string, std::unique_ptr<Program>> programs_;
  MemoryLedger memory_;
  Profiler profiler_;
};

}  // namespace sfumato::gl
