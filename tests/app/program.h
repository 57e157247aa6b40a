// Runs the program as a shell does, in a folder of its own.
#pragma once

#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <pty.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <map>
#include <string>
#include <vector>

#include "tests/scene/gltf_builder.h"

namespace sfumato::test {

using Arguments = std::vector<std::string>;

struct Surroundings {
  std::vector<std::string> environment;  // "NAME=value", over what is inherited
  // Called in the child when its streams are set up; only system calls are safe there.
  std::function<void()> inChild = [] {};
  bool terminal = false;  // stderr is a terminal
  int seconds = 60;       // then it is killed
};

struct Outcome {
  int exitCode = -1;  // -1: it was killed by a signal, or for its time
  std::string out;
  std::string err;
};

inline std::vector<char*> pointers(std::vector<std::string>& texts) {
  std::vector<char*> result;
  for (std::string& text : texts) result.push_back(text.data());
  result.push_back(nullptr);
  return result;
}

// Variables by which the program finds nothing that it kept for the user, as what `validate` found out, but
// drivers the shaders that they did.
inline std::vector<std::string> withoutTheUsersCache(std::vector<std::string> environment) {
  static const TemporaryFolder cache("cache");
  const char* home = std::getenv("HOME");
  const char* users = std::getenv("XDG_CACHE_HOME");
  const std::filesystem::path shaders = users != nullptr
                                            ? std::filesystem::path(users)
                                            : std::filesystem::path(home != nullptr ? home : "") / ".cache";
  if (std::getenv("MESA_SHADER_CACHE_DIR") == nullptr)
    environment.push_back("MESA_SHADER_CACHE_DIR=" + shaders.string());
  const auto names = [](const std::string& variable) { return variable.starts_with("XDG_CACHE_HOME="); };
  if (std::none_of(environment.begin(), environment.end(), names))
    environment.push_back("XDG_CACHE_HOME=" + cache.path().string());
  return environment;
}

inline std::vector<std::string> environmentWith(const std::vector<std::string>& changes) {
  std::vector<std::string> result = changes;  // the first of a name counts
  for (char** variable = environ; *variable != nullptr; ++variable) {
    const std::string text = *variable;
    const std::string name = text.substr(0, text.find('=') + 1);
    if (std::none_of(changes.begin(), changes.end(), [&](const auto& c) { return c.starts_with(name); }))
      result.push_back(text);
  }
  return result;
}

// Reads both streams until the program closes them or its time is over; false for the latter.
inline bool readStreams(int outStream, int errStream, int seconds, Outcome& outcome) {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point end = Clock::now() + std::chrono::seconds(seconds);
  pollfd streams[] = {{outStream, POLLIN, 0}, {errStream, POLLIN, 0}};
  std::string* texts[] = {&outcome.out, &outcome.err};
  while (streams[0].fd >= 0 || streams[1].fd >= 0) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(end - Clock::now()).count();
    if (left <= 0) return false;
    poll(streams, 2, static_cast<int>(left));
    for (int i = 0; i < 2; ++i) {
      if (streams[i].revents == 0) continue;
      char bytes[4096];
      const ssize_t count = read(streams[i].fd, bytes, sizeof bytes);
      if (count > 0)
        texts[i]->append(bytes, static_cast<size_t>(count));
      else if (count == 0 || errno != EINTR)
        streams[i].fd = -1;  // a terminal says EIO when its last writer is gone
    }
  }
  return true;
}

inline Outcome runProgram(const std::filesystem::path& folder, const Arguments& arguments,
                          const Surroundings& surroundings = {}) {
  std::vector<std::string> words = {SFUMATO_PROGRAM};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<std::string> variables = environmentWith(withoutTheUsersCache(surroundings.environment));
  const std::vector<char*> argv = pointers(words);
  const std::vector<char*> envp = pointers(variables);
  int out[2];
  int err[2];
  EXPECT_EQ(pipe(out), 0);
  EXPECT_EQ(surroundings.terminal ? openpty(&err[0], &err[1], nullptr, nullptr, nullptr) : pipe(err), 0);
  for (const int stream : {out[0], err[0]}) fcntl(stream, F_SETFD, FD_CLOEXEC);

  const pid_t child = fork();
  if (child == 0) {
    dup2(out[1], STDOUT_FILENO);
    dup2(err[1], STDERR_FILENO);
    close(out[1]);
    close(err[1]);
    surroundings.inChild();
    if (chdir(folder.c_str()) == 0) execve(argv[0], argv.data(), envp.data());
    _exit(127);
  }
  close(out[1]);
  close(err[1]);
  Outcome outcome;
  const bool ended = readStreams(out[0], err[0], surroundings.seconds, outcome);
  EXPECT_TRUE(ended) << "ran for more than " << surroundings.seconds << " s";
  if (!ended) kill(child, SIGKILL);
  int status = 0;
  waitpid(child, &status, 0);
  close(out[0]);
  close(err[0]);
  if (WIFSIGNALED(status)) ADD_FAILURE() << "killed by signal " << WTERMSIG(status) << "\n" << outcome.err;
  if (WIFEXITED(status)) outcome.exitCode = WEXITSTATUS(status);
  return outcome;
}

inline std::string contentOf(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

// Every name below a folder, with what the files hold.
inline std::map<std::string, std::string> listing(const std::filesystem::path& folder) {
  std::map<std::string, std::string> names;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
    names[entry.path().lexically_relative(folder)] =
        entry.is_regular_file() ? contentOf(entry.path()) : std::string();
  return names;
}

inline std::vector<std::string> lines(const std::string& text) {
  std::vector<std::string> result;
  for (size_t at = 0; at < text.size();) {
    const size_t end = std::min(text.find('\n', at), text.size());
    result.push_back(text.substr(at, end - at));
    at = end + 1;
  }
  return result;
}

// One line on stderr, with `says` in it, an exit code, and nothing on stdout.
inline void expectError(const Outcome& outcome, int exitCode, const std::string& says) {
  EXPECT_EQ(outcome.exitCode, exitCode) << outcome.err;
  EXPECT_EQ(outcome.out, "");
  EXPECT_TRUE(outcome.err.starts_with("sfumato: error: ")) << outcome.err;
  EXPECT_EQ(lines(outcome.err).size(), 1u) << outcome.err;
  EXPECT_TRUE(outcome.err.ends_with('\n'));
  EXPECT_NE(outcome.err.find(says), std::string::npos) << "\"" << says << "\" is not in: " << outcome.err;
}

// A triangle that glows, seen by a camera 2 m before it, and a lamp; vertices may be bent.
inline GltfBuilder glowingScene(const std::vector<float>& positions = {0, 0, 0, 1, 0, 0, 0, 1, 0},
                                const std::vector<uint16_t>& indices = {0, 1, 2}) {
  GltfBuilder gltf;
  const int position = gltf.accessor<float>("VEC3", positions);
  const int index = gltf.accessor<uint16_t>("SCALAR", indices);
  gltf.meshNode({{"attributes", {{"POSITION", position}}}, {"indices", index}, {"material", 0}});
  gltf.add("materials", {{"emissiveFactor", {1, 1, 1}}, {"doubleSided", true}});
  gltf.add("cameras", {{"type", "perspective"}, {"perspective", {{"yfov", 0.7}, {"znear", 0.1}}}});
  gltf.add("nodes", {{"camera", 0}, {"translation", {0.3, 0.3, 2}}});
  gltf.light({{"type", "point"}, {"intensity", 5}})["translation"] = {0.5, 0.5, 2};
  return gltf;
}

struct BadCall {
  Arguments arguments;
  int exitCode;
  std::string says;
};

// Each call fails as it should, and the folder is as it was.
inline void expectErrors(const std::filesystem::path& folder, const std::vector<BadCall>& calls) {
  const auto before = listing(folder);
  for (const BadCall& call : calls) {
    std::string commandLine;
    for (const std::string& argument : call.arguments) commandLine += " '" + argument + "'";
    SCOPED_TRACE("sfumato" + commandLine);
    expectError(runProgram(folder, call.arguments), call.exitCode, call.says);
    EXPECT_EQ(listing(folder), before);
  }
}

}  // namespace sfumato::test
