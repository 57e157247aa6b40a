#include "base/interruption.h"

#include <gtest/gtest.h>
#include <poll.h>

#include <thread>

namespace sfumato::base {
namespace {

TEST(Interruption, IsNotedWhicheverThreadItComesTo) {
  for (const int signal : {SIGINT, SIGTERM}) {
    const Interruption interruption({SIGINT, SIGTERM});
    EXPECT_FALSE(interruption.happened());
    std::thread([&] { pthread_kill(pthread_self(), signal); }).join();
    EXPECT_TRUE(interruption.happened());
    pollfd polled{interruption.stream(), POLLIN, 0};
    EXPECT_EQ(poll(&polled, 1, 0), 1);
  }
}

TEST(InterruptionDeathTest, EndsTheProgramTheSecondTimeAndAfterwards) {
  EXPECT_EXIT(
      {
        const Interruption interruption({SIGINT});
        std::raise(SIGINT);
        std::raise(SIGINT);
      },
      testing::KilledBySignal(SIGINT), "");
  EXPECT_EXIT(
      {
        { const Interruption interruption({SIGINT}); }
        std::raise(SIGINT);
      },
      testing::KilledBySignal(SIGINT), "");
  EXPECT_EXIT(
      {
        const Interruption interruption({SIGINT});
        std::raise(SIGTERM);
      },
      testing::KilledBySignal(SIGTERM), "");
}

}  // namespace
}  // namespace sfumato::base
