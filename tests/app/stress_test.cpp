// What `sfumato stress` says before it needs OpenGL.
#include <gtest/gtest.h>

#include "tests/app/program.h"

namespace sfumato::test {
namespace {

TEST(StressCommandLine, NamesTheOptionThatIsWrong) {
  const TemporaryFolder folder("stress_command_line");
  folder.write("file", "");
  expectErrors(
      folder.path(),
      {
          {{"stress", "--frob"}, 2, "--frob: no such option: see `sfumato stress --help`"},
          {{"stress", "--lists", "mutex"},
           2,
           "--lists: \"mutex\" is none of spinlock, lockfree, append, count"},
          {{"stress", "--lists", "append,mutex"}, 2, "--lists: \"mutex\" is none of"},
          {{"stress", "--distribution", "gaussian"}, 2, "--distribution: \"gaussian\" is none of uniform, "},
          {{"stress", "--on-overflow", "drop"}, 2, "--on-overflow: \"drop\" is none of grow, window, error"},
          {{"stress", "--cells", "0x8"}, 2, "--cells: \"0x8\" is not WIDTHxHEIGHT"},
          {{"stress", "--cells", "8x8,-8x8"}, 2, "--cells: \"-8x8\" is not WIDTHxHEIGHT"},
          {{"stress", "--cells", "99999x9"}, 2, "--cells: \"99999x9\" is not WIDTHxHEIGHT"},
          {{"stress", "--layers", "0"}, 2, "--layers: \"0\" is not a whole number"},
          {{"stress", "--layers", "-3"}, 2, "--layers: \"-3\" is not a whole number"},
          {{"stress", "--layers", "8,99999999"}, 2, "--layers: \"99999999\" is not a whole number"},
          {{"stress", "--layers", "nan"}, 2, "--layers: \"nan\" is not a whole number"},
          {{"stress", "--node-bytes", "5"}, 2, "--node-bytes: \"5\" is none of 0, 4, "},
          {{"stress", "--node-bytes", "-4"}, 2, "--node-bytes: \"-4\" is none of 0, 4, "},
          {{"stress", "--list-memory", "lots"}, 2, "--list-memory: \"lots\" is no budget"},
          {{"stress", "--list-memory", "0"}, 2, "--list-memory: \"0\" is no budget"},
          {{"stress", "--list-memory", "-1M"}, 2, "--list-memory: \"-1M\" is no budget"},
          {{"stress", "--list-memory", "0%"}, 2, "--list-memory: \"0%\" is no budget"},
          {{"stress", "--list-memory", "nan%"}, 2, "--list-memory: \"nan%\" is no budget"},
          {{"stress", "--list-memory", "99999999999999G"}, 2, "--list-memory: "},
          {{"stress", "--seed", "-1"}, 2, "--seed: \"-1\" is not a whole number"},
          {{"stress", "--repeat", "0"}, 2, "--repeat: \"0\" is not a whole number"},
          {{"stress", "--minutes", "0"}, 2, "--minutes: \"0\" is not a number"},
          {{"stress", "--minutes", "nan"}, 2, "--minutes: \"nan\" is not a number"},
          {{"stress", "--report", ""}, 2, "--report: \"\" is no file"},
          {{"stress", "--lights", "4..1", "a.gltf"}, 2, "--lights: \"4..1\" is not a range"},
          {{"stress", "--lights", "0..8", "a.gltf"}, 2, "--lights: \"0..8\" is not a range"},
          {{"stress", "--lights", "1..", "a.gltf"}, 2, "--lights: \"1..\" is not a range"},
      });
}

TEST(StressCommandLine, TakesOnlyWhatGoesTogether) {
#ifdef SFUMATO_GL
  const TemporaryFolder folder("stress_command_line");
  expectErrors(folder.path(), {{{"stress", "--lights", "1..8"}, 2, "--lights: is for a scene"},
                               {{"stress", "--camera", "front"}, 2, "--camera: is for a scene"},
                               {{"stress", "a.gltf", "--cells", "8x8"}, 2, "SCENE excludes --cells"},
                               {{"stress", "a.gltf", "--list-memory", "10%"},
                                2,
                                "--list-memory: \"10%\" is of what a synthetic load takes"},
                               {{"stress", "--cells", "16384x16384", "--layers", "2"},
                                2,
                                "536870912 nodes are more than 268435456"}});
#endif
}

}  // namespace
}  // namespace sfumato::test
