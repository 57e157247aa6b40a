#include "tests/gl/test_device.h"

#include <cstdlib>
#include <memory>

#include "base/error.h"

namespace sfumato::tests {
namespace {

struct Attempt {
  std::unique_ptr<gl::Device> device;
  std::string problem;

  Attempt() {
    try {
      device = std::make_unique<gl::Device>(
          gl::DeviceOptions{.debug = true, .shaderDir = std::string(SFUMATO_SOURCE_DIR) + "/tests/shaders"});
    } catch (const base::Error& error) {
      problem = error.what();
    }
  }
};

Attempt& attempt() {
  static Attempt instance;
  return instance;
}

}  // namespace

gl::Device* testDevice() {
  return attempt().device.get();
}

const std::string& whyNoDevice() {
  return attempt().problem;
}

void needDevice() {
  if (testDevice() != nullptr) return;
  const char* ci = std::getenv("CI");
  if (ci != nullptr && std::string(ci) == "true") FAIL() << whyNoDevice();
  GTEST_SKIP() << whyNoDevice();
}

void GpuTest::SetUp() {
  needDevice();
  if (testDevice() == nullptr) return;
  messagesBefore_ = device().debugMessages().size();
}

void GpuTest::TearDown() {
  if (testDevice() == nullptr) return;
  const auto& messages = device().debugMessages();
  for (size_t i = messagesBefore_; i < messages.size(); ++i) ADD_FAILURE() << "driver: " << messages[i];
}

}  // namespace sfumato::tests
