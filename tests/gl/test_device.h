// The GL device that GPU tests share, with the shaders of tests/shaders beside the built-in ones.
#pragma once

#include <gtest/gtest.h>

#include "gl/device.h"

namespace sfumato::tests {

// A debug context, so that driver messages are seen. Null when there is no usable GL; `whyNoDevice` then says
// why.
gl::Device* testDevice();
const std::string& whyNoDevice();

// For SetUp(): skips the test without a device, and says why; fails it when CI=true.
void needDevice();

// A fixture whose tests skip without GL (and fail without it when CI=true), and fail on any driver message of
// medium severity or above.
class GpuTest : public testing::Test {
 protected:
  void SetUp() override;
  void TearDown() override;
  gl::Device& device() { return *testDevice(); }

 private:
  size_t messagesBefore_ = 0;
};

}  // namespace sfumato::tests
